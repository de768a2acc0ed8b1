#include "tools/simulate/virtual_machine.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "daemon/make_cycle_config.h"
#include "daemon/output_words.h"
#include "daemon/program_limits.h"
#include "daemon/reason_text.h"
#include "drivers/cia301/bring_up_text.h"
#include "drivers/cia301/messages.h"
#include "tools/machine/placements.h"
#include "tools/simulate/simulated_io.h"

namespace contour {
namespace {

constexpr std::size_t kRequests = 16;
constexpr std::size_t kPathPoints = 256;
/// Bring-up, enabling and settling take a fraction of a second; a machine that takes longer hangs.
constexpr int kPatience_cycles = 60'000;

CycleConfig Configured(const EmulatedMachineFile& file, ControllerName controller,
                       const Surroundings& surroundings) {
  CycleConfig config = MakeCycleConfig(file.machine, controller);
  if (surroundings.configure) surroundings.configure(config);
  return config;
}

}  // namespace

/// The last truth rows by SYNC number: feedback is one SYNC older than the newest row.
class VirtualMachine::TruthMemory final : public TruthSink {
 public:
  void OnTruth(const TruthRow& row) noexcept override {
    if (!row.free_running) rows_[row.sync_number % rows_.size()] = row;
  }
  [[nodiscard]] const TruthRow* Find(std::uint64_t sync_number) const {
    const TruthRow& row = rows_[sync_number % rows_.size()];
    return sync_number != 0 && row.sync_number == sync_number ? &row : nullptr;
  }

 private:
  std::array<TruthRow, 8> rows_{};
};

VirtualMachine::VirtualMachine(const EmulatedMachineFile& file, ControllerName controller,
                               EmulatedClock clock, const Surroundings& surroundings)
    : axis_names_(AxisNames(file.machine)),
      bus_names_(BusNames(file.machine)),
      limits_(ProgramLimits(file.machine)),
      events_(UseOfEvents(file.machine, file.machine.machine.optional_stop)),
      block_delete_(file.machine.machine.block_delete),
      tool_table_(file.machine.machine.tool_table),
      emulated_(file.emulator, EmulatedPlacements(file.machine),
                static_cast<std::uint32_t>(file.machine.machine.cycle_us), clock),
      truths_(std::make_unique<TruthMemory>()),
      mailbox_(kRequests, kPathPoints),
      cycle_(Configured(file, controller, surroundings)),
      feeder_(mailbox_),
      learning_(file.machine),
      period_ns_(std::int64_t{1000} * file.machine.machine.cycle_us),
      prompt_(surroundings.prompt),
      entry_(std::make_unique<CycleEntry>()) {
  std::size_t b = 0;
  for (const auto& [name, bus] : file.machine.buses) {
    std::vector<BusNode*> nodes;
    if (b < emulated_.bus_count()) nodes.push_back(&emulated_.node(b));
    if (b < surroundings.nodes.size())
      nodes.insert(nodes.end(), surroundings.nodes[b].begin(), surroundings.nodes[b].end());
    buses_.push_back(std::make_unique<LoopbackBus>(bus.bitrate_bit_s, std::move(nodes)));
    // Stepped by SYNC, the plant knows no late one.
    if (clock == EmulatedClock::kWall) buses_.back()->TellOf(cob::kSync);
    bus_pointers_.push_back(surroundings.wrap ? surroundings.wrap(b, *buses_.back()) : buses_.back().get());
    ++b;
  }
  emulated_.SetTruthSink(truths_.get());
  const auto& modbus = file.machine.io.modbus;
  if (modbus && modbus->inputs.screw_temperature)
    io_ = std::make_unique<SimulatedIo>(*modbus->inputs.screw_temperature, emulated_);
  else
    io_ = std::make_unique<NoIo>();
  SetIo(*io_);
}

VirtualMachine::~VirtualMachine() { emulated_.SetTruthSink(nullptr); }

void VirtualMachine::SetIo(IoSource& io) {
  runner_ = std::make_unique<CycleRunner>(cycle_, bus_pointers_, mailbox_, io);
}

void VirtualMachine::Tick() {
  feeder_.Feed();
  ++index_;
  const GridPoint grid{index_, static_cast<std::int64_t>(index_) * period_ns_, 0};
  runner_->Tick(grid, prompt_ || !settling_, *entry_);
  settling_ = entry_->output.settling;
  learning_.Consume(record());
  if (record_) record_(*entry_);
  if (observer_) observer_(*entry_, truths_->Find(record().feedback_sync));
}

void VirtualMachine::Fail(const std::string& doing) const {
  const CycleRecord& r = record();
  std::string why = r.reason == Reason::kBringUpFailed ? BringUpText(r.bring_up, axis_names_)
                                                       : ReasonText(r, axis_names_, bus_names_);
  if (r.reason == Reason::kPathUnderrun && !feeder_.failure().empty()) why = feeder_.failure();
  throw std::runtime_error(doing + ": the machine is " + std::string(Name(r.state)) + " in cycle " +
                           std::to_string(r.cycle) + (why.empty() ? std::string() : ": " + why));
}

void VirtualMachine::TickUntilSettled(MachineState wanted, const char* doing) {
  for (int i = 0; i < kPatience_cycles; ++i) {
    Tick();
    if (record().state == wanted && entry_->output.quiescent) return;
    if (record().state == MachineState::kFaulted) break;
    // Refused: nobody asks again.
    if (record().state == MachineState::kIdle && record().reason == Reason::kAxisMoves) break;
  }
  Fail(doing);
}

void VirtualMachine::BringUp() { TickUntilSettled(MachineState::kIdle, "bringing up the drives"); }

void VirtualMachine::Enable() {
  mailbox_.Post(RequestKind::kEnable);
  TickUntilSettled(MachineState::kReady, "enabling");
}

PerAxis<double> VirtualMachine::StandsAt_m() const {
  PerAxis<double> place_m;
  for (const AxisRecord& a : record().axes) place_m.push_back(a.reference.position_m);
  return place_m;
}

void VirtualMachine::SetZero() { zero_m_ = StandsAt_m(); }

Placement VirtualMachine::PlaceNow() const {
  const PerAxis<double> start_m = StandsAt_m();
  return {start_m, zero_m_.value_or(start_m)};
}

Program VirtualMachine::ReadGcode(const std::string& text, const std::string& name,
                                  const PartOfProgram& part) const {
  const auto& axes = record().axes;
  const bool referenced = std::all_of(axes.begin(), axes.end(),
                                      [](const AxisRecord& a) { return IsReferenced(a.reference_state); });
  PartOfProgram whole = part;
  whole.block_delete = part.block_delete.value_or(block_delete_);
  whole.tool_table = tool_table_;
  EventUse events = events_;
  events.optional_stop = part.optional_stop.value_or(events.optional_stop);
  return ReadPlaced({text, name, ProgramFormat::kGcode}, PlaceNow(), LimitsNow(limits_, record()),
                    {referenced, whole, events});
}

std::shared_ptr<const MotionPlan> VirtualMachine::PlanOf(const Program& program) const {
  return PlanPlaced(program, PlaceNow(), LimitsNow(limits_, record()));
}

std::uint32_t VirtualMachine::Start(const Program& program, double feed) {
  return Start(program, PlanOf(program), feed);
}

std::uint32_t VirtualMachine::Start(const Program& program, std::shared_ptr<const MotionPlan> plan,
                                    double feed) {
  plan_ = std::move(plan);
  auto generator = std::make_unique<PathGenerator>(plan_, LimitsNow(limits_, record()),
                                                   static_cast<double>(period_ns_) * 1e-9, ++program_id_);
  learning_.Prepare([&] { return program.name; }, PlaceNow().start_m, program_id_, *generator);
  feeder_.Begin(std::move(generator), {feed, false, false});
  return mailbox_.Post(RequestKind::kRun, program_id_);
}

void VirtualMachine::Run(const Program& program, double feed) { Run(program, PlanOf(program), feed); }

void VirtualMachine::Run(const Program& program, std::shared_ptr<const MotionPlan> plan, double feed) {
  const std::uint32_t sequence = Start(program, std::move(plan), feed);
  const auto acknowledged = [&] { return record().acknowledged >= sequence; };
  bool ran = false;
  for (;;) {
    Tick();
    const MachineState state = record().state;
    ran = ran || state == MachineState::kRunning;
    if (ran && state == MachineState::kReady && record().reason == Reason::kProgramEnd) return;
    // Until the cycle has taken the request the reason is that of the program before.
    const bool waiting =
        state == MachineState::kReady && (record().reason == Reason::kNone || !acknowledged());
    if (state != MachineState::kRunning && !waiting) {
      feeder_.Abandon();
      Fail("running " + program.name);
    }
  }
}

}  // namespace contour
