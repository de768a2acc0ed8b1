#include "tools/plant_emulator/emulated_machine.h"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/cycle_input.h"
#include "tools/plant_emulator/emulated_axis.h"

namespace contour {
namespace {

constexpr std::uint16_t kSyncCobId = 0x080;
constexpr std::int64_t kFreeStep_ns = 1'000'000;
/// Silence is listened to in so many parts. A part that took longer counts as one: the host held us up, and
/// what was sent meanwhile, or by a master that was held up too, is not silence.
constexpr std::int64_t kLooksPerSilence = 8;
/// Streams of random numbers an axis uses: parameters, encoder, scale.
constexpr std::uint64_t kStreamsPerAxis = 4;

}  // namespace

/// One bus: its drives, and the time of their plants.
class EmulatedMachine::Impl {
 public:
  Impl(const EmulatorConfig& config, std::span<const EmulatedAxisPlacement> placements,
       std::uint32_t cycle_us, EmulatedClock clock);

  class Node final : public BusNode {
   public:
    Node(Impl& machine, std::size_t bus) noexcept : machine_(machine), bus_(bus) {}
    void OnFrame(const CanFrame& frame, std::int64_t time_ns, PendingFrames& out) noexcept override {
      machine_.OnFrame(bus_, frame, time_ns, out);
    }
    void OnTimer(std::int64_t time_ns, PendingFrames& out) noexcept override {
      machine_.OnTimer(bus_, time_ns, out);
    }
    [[nodiscard]] std::int64_t NextTimer() const noexcept override { return machine_.NextTimer(bus_); }

   private:
    Impl& machine_;
    std::size_t bus_;
  };

  struct Bus {
    std::vector<std::size_t> axes;
    std::uint64_t syncs = 0;
    std::int64_t silent_ns = 0;     ///< listened to since the last frame
    std::int64_t looked_ns = 0;     ///< the last time handed in
    std::int64_t followed_ns = 0;   ///< the time handed in up to which the plant has followed
    std::int64_t next_step_ns = 0;  ///< when it follows again while it runs free
    bool running_free = false;
    bool seen_time = false;
  };

  void OnFrame(std::size_t bus, const CanFrame& frame, std::int64_t time_ns, PendingFrames& out) noexcept;
  void OnTimer(std::size_t bus, std::int64_t time_ns, PendingFrames& out) noexcept;
  [[nodiscard]] std::int64_t NextTimer(std::size_t bus) const noexcept;

  std::uint32_t cycle_us_;
  EmulatedClock clock_;
  std::int64_t silence_ns_;
  std::vector<std::unique_ptr<plant::EmulatedAxis>> axes_;
  std::vector<Bus> buses_;
  std::vector<std::unique_ptr<Node>> nodes_;
  TruthRow truth_;
  TruthSink* sink_ = nullptr;

 private:
  void OnSync(Bus& bus, std::int64_t time_ns, PendingFrames& out) noexcept;
  void Follow(Bus& bus, std::int64_t time_ns) noexcept;
  void Advance(Bus& bus, std::int64_t duration_ns) noexcept;
  void Couple(std::size_t axis) noexcept;
  [[nodiscard]] bool Alive(const Bus& bus) const noexcept;
  void SampleTruth(bool free_running) noexcept;
  [[nodiscard]] bool RoundComplete() const noexcept;
};

EmulatedMachine::Impl::Impl(const EmulatorConfig& config, std::span<const EmulatedAxisPlacement> placements,
                            std::uint32_t cycle_us, EmulatedClock clock)
    : cycle_us_(cycle_us), clock_(clock), silence_ns_(static_cast<std::int64_t>(config.silence_ms * 1e6)) {
  if (placements.empty()) throw std::invalid_argument("emulator: no axes to emulate");
  if (placements.size() > kMaxAxes)
    throw std::invalid_argument("emulator: more than " + std::to_string(kMaxAxes) + " axes");
  if (cycle_us == 0) throw std::invalid_argument("emulator: the cycle time is zero");
  for (std::size_t i = 0; i < placements.size(); ++i) {
    const EmulatedAxisPlacement& place = placements[i];
    const auto found = config.axes.find(place.name);
    if (found == config.axes.end())
      throw std::invalid_argument("emulator.axes: there is no axis \"" + place.name + "\"");
    if (place.bus >= kMaxBuses) throw std::invalid_argument("emulator: bus index out of range");
    if (place.node_id < 1 || place.node_id > 127)
      throw std::invalid_argument("emulator: node_id of axis \"" + place.name + "\" is not in 1..127");
    const std::uint64_t stream = kStreamsPerAxis * i;
    plant::AxisParameters parameters =
        plant::MakeAxisParameters(found->second, place, config.seed, config.parameter_variation_rel, stream);
    if (const auto& coupling = parameters.effects.cross_coupling) {
      const auto other =
          std::find_if(placements.begin(), placements.end(),
                       [&](const EmulatedAxisPlacement& p) { return p.name == coupling->axis; });
      if (other == placements.end() || coupling->axis == place.name)
        throw std::invalid_argument("emulator.axes." + place.name + ".effects.cross_coupling.axis: \"" +
                                    coupling->axis + "\" is not another axis");
      parameters.coupled_axis = static_cast<std::size_t>(other - placements.begin());
    }
    axes_.push_back(
        std::make_unique<plant::EmulatedAxis>(parameters, place, cycle_us, config.seed, stream + 1));
    buses_.resize(std::max(buses_.size(), place.bus + 1));
    for (const std::size_t other : buses_[place.bus].axes)
      if (axes_[other]->node_id() == place.node_id)
        throw std::invalid_argument("emulator: two drives with node_id " + std::to_string(place.node_id) +
                                    " on one bus");
    buses_[place.bus].axes.push_back(i);
  }
  for (std::size_t b = 0; b < buses_.size(); ++b) nodes_.push_back(std::make_unique<Node>(*this, b));
  truth_.axes.resize(axes_.size());
  SampleTruth(false);
}

void EmulatedMachine::Impl::OnFrame(std::size_t index, const CanFrame& frame, std::int64_t time_ns,
                                    PendingFrames& out) noexcept {
  Bus& bus = buses_[index];
  Follow(bus, time_ns);
  bus.silent_ns = 0;
  if (frame.id == kSyncCobId) {
    OnSync(bus, time_ns, out);
  } else {
    for (const std::size_t a : bus.axes) axes_[a]->OnFrame(frame, time_ns, out);
  }
  // What the drives have to say at once (emergencies, a heartbeat with a new state).
  for (const std::size_t a : bus.axes)
    if (axes_[a]->NextTimer() <= time_ns) axes_[a]->OnTimer(time_ns, out);
}

void EmulatedMachine::Impl::OnSync(Bus& bus, std::int64_t time_ns, PendingFrames& out) noexcept {
  if (clock_ == EmulatedClock::kSync) {
    Advance(bus, std::int64_t{cycle_us_} * 1000);
    bus.running_free = false;
  }
  ++bus.syncs;
  // Truth belongs to the instant itself: before the new commands, which only act from now on.
  for (const std::size_t a : bus.axes) {
    Couple(a);
    axes_[a]->OnSync(time_ns, out);
  }
  if (RoundComplete()) SampleTruth(false);
}

/// All buses have had this SYNC.
bool EmulatedMachine::Impl::RoundComplete() const noexcept {
  return std::all_of(buses_.begin(), buses_.end(),
                     [&](const Bus& b) { return b.axes.empty() || b.syncs >= buses_.front().syncs; }) &&
         std::all_of(buses_.begin(), buses_.end(),
                     [&](const Bus& b) { return b.axes.empty() || b.syncs <= buses_.front().syncs; });
}

/// The plant follows the time handed in: always with the wall clock, else while the master is silent.
void EmulatedMachine::Impl::Follow(Bus& bus, std::int64_t time_ns) noexcept {
  if (!bus.seen_time) {
    bus.seen_time = true;
    bus.followed_ns = time_ns;
    bus.looked_ns = time_ns;
    bus.next_step_ns = time_ns + kFreeStep_ns;
  }
  bus.silent_ns += std::min(time_ns - bus.looked_ns, silence_ns_ / kLooksPerSilence);
  bus.looked_ns = time_ns;
  if (clock_ == EmulatedClock::kSync && !bus.running_free) {
    if (!Alive(bus) || bus.silent_ns < silence_ns_) return;
    bus.running_free = true;
    bus.followed_ns = time_ns - (bus.silent_ns - silence_ns_);
    bus.next_step_ns = bus.followed_ns;
  }
  if (time_ns > bus.followed_ns) Advance(bus, time_ns - bus.followed_ns);
  bus.followed_ns = std::max(bus.followed_ns, time_ns);
}

void EmulatedMachine::Impl::Advance(Bus& bus, std::int64_t duration_ns) noexcept {
  for (const std::size_t a : bus.axes) axes_[a]->AdvanceTo(axes_[a]->now_ns() + duration_ns);
}

void EmulatedMachine::Impl::Couple(std::size_t axis) noexcept {
  const plant::AxisParameters& p = axes_[axis]->parameters();
  if (!p.effects.cross_coupling) return;
  const double acceleration = axes_[p.coupled_axis]->plant().table_acceleration_m_s2();
  axes_[axis]->plant().SetCouplingForce_N(p.effects.cross_coupling->torque_per_acceleration_Nms2_m *
                                          acceleration / p.radius_m_rad);
}

bool EmulatedMachine::Impl::Alive(const Bus& bus) const noexcept {
  return std::any_of(bus.axes.begin(), bus.axes.end(), [&](std::size_t a) { return axes_[a]->alive(); });
}

void EmulatedMachine::Impl::OnTimer(std::size_t index, std::int64_t time_ns, PendingFrames& out) noexcept {
  Bus& bus = buses_[index];
  Follow(bus, time_ns);
  for (const std::size_t a : bus.axes)
    if (axes_[a]->NextTimer() <= time_ns) axes_[a]->OnTimer(time_ns, out);
  const bool free = clock_ == EmulatedClock::kWall || bus.running_free;
  if (!free || time_ns < bus.next_step_ns) return;
  bus.next_step_ns = time_ns + kFreeStep_ns;
  if (Alive(bus)) SampleTruth(true);
  // Everything has come to rest: time stands still until the next SYNC.
  if (clock_ == EmulatedClock::kSync && !Alive(bus)) {
    SampleTruth(true);
    bus.running_free = false;
  }
}

std::int64_t EmulatedMachine::Impl::NextTimer(std::size_t index) const noexcept {
  const Bus& bus = buses_[index];
  std::int64_t next = kNever;
  for (const std::size_t a : bus.axes) next = std::min(next, axes_[a]->NextTimer());
  if (clock_ == EmulatedClock::kWall || bus.running_free) return std::min(next, bus.next_step_ns);
  if (bus.seen_time && Alive(bus))
    next =
        std::min(next, bus.looked_ns + std::min(silence_ns_ - bus.silent_ns, silence_ns_ / kLooksPerSilence));
  return next;
}

void EmulatedMachine::Impl::SampleTruth(bool free_running) noexcept {
  truth_.sync_number = 0;
  truth_.time_s = 0.0;
  for (const Bus& b : buses_) truth_.sync_number = std::max(truth_.sync_number, b.syncs);
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    axes_[a]->FillTruth(truth_.axes[a]);
    truth_.time_s = std::max(truth_.time_s, 1e-9 * static_cast<double>(axes_[a]->now_ns()));
  }
  truth_.free_running = free_running;
  if (sink_ != nullptr) sink_->OnTruth(truth_);
}

EmulatedMachine::EmulatedMachine(const EmulatorConfig& config,
                                 std::span<const EmulatedAxisPlacement> placements, std::uint32_t cycle_us,
                                 EmulatedClock clock)
    : impl_(std::make_unique<Impl>(config, placements, cycle_us, clock)) {}
EmulatedMachine::~EmulatedMachine() = default;
EmulatedMachine::EmulatedMachine(EmulatedMachine&&) noexcept = default;
EmulatedMachine& EmulatedMachine::operator=(EmulatedMachine&&) noexcept = default;

BusNode& EmulatedMachine::node(std::size_t bus) noexcept { return *impl_->nodes_[bus]; }
std::size_t EmulatedMachine::bus_count() const noexcept { return impl_->buses_.size(); }
const TruthRow& EmulatedMachine::truth() const noexcept { return impl_->truth_; }
void EmulatedMachine::SetTruthSink(TruthSink* sink) noexcept { impl_->sink_ = sink; }
plant::EmulatedAxis& EmulatedMachine::axis(std::size_t axis) noexcept { return *impl_->axes_[axis]; }

}  // namespace contour
