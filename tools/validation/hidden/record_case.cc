#include "tools/validation/hidden/record_case.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <stdexcept>

#include "analysis/axis_model/read_stated_axis.h"
#include "analysis/recording/read_log.h"
#include "daemon/program_limits.h"
#include "daemon/telemetry/log_writer.h"
#include "drivers/lcm/telemetry_encoder.h"
#include "tools/simulate/virtual_machine.h"
#include "tools/validation/hidden/hide_effect.h"
#include "tools/validation/hidden/log_table.h"
#include "tools/validation/hidden/machine_text.h"

namespace contour::hidden {
namespace {

/// Bring-up, enabling and settling of the machine take so long before a program begins.
constexpr double kBeforeProgram_s = 1.0;
constexpr double kTimingError_us = 30.0;
constexpr double kNoiseFactor = 3.0;
constexpr const char* kLogFile = "log.lcm";
constexpr const char* kTableFile = "log.csv";
constexpr const char* kModelFile = "model.yaml";
constexpr std::size_t kSpeedOver = 20;  ///< cycles: long against the encoder's steps, short against a stroke

/// The machine's thermometer, a tenth of a degree per step; all that is asked for is permitted.
class Thermometer final : public IoSource {
 public:
  Thermometer(const EmulatedMachine& machine, bool fitted) : machine_(machine), fitted_(fitted) {}
  IoInput Read(std::int64_t) noexcept override {
    IoInput in{true, true, true, true, std::numeric_limits<double>::quiet_NaN()};
    if (fitted_ && !machine_.truth().axes.empty())
      in.screw_temperature_degC = 0.1 * std::round(10.0 * machine_.truth().axes[0].temperature_degC);
    return in;
  }

 private:
  const EmulatedMachine& machine_;
  bool fitted_;
};

void WriteText(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error("cannot write " + file.string());
}

using SeeCycle = std::function<void(const CycleEntry&, const TruthRow*)>;

/// Gives the time by the machine at which its program was planned to end.
double RunMachine(const Setting& s, const std::vector<Hidden>& hidden, const std::filesystem::path& directory,
                  const std::function<SeeCycle(const EmulatedMachineFile&)>& observer) {
  const std::filesystem::path machine_file = directory / "machine.yaml";
  WriteText(machine_file, MachineText(s));
  EmulatedMachineFile file = LoadEmulatedMachine(machine_file.string());
  const Program program = ParseProgram(s.program, "program.yaml", ProgramFormat::kYaml);
  PerAxis<double> start_m;
  for (std::size_t i = 0; i < file.machine.axes.size(); ++i) start_m.push_back(0.0);
  const double duration_s = PlanMotion(program, start_m, ProgramLimits(file.machine))->duration_s();
  EmulatedAxisConfig& axis = file.emulator.axes.at("x");
  for (const Hidden& h : hidden) HideEffect(h, s, kBeforeProgram_s, duration_s, axis);
  if (s.misfit == Misfit::kTimingError || s.misfit == Misfit::kDelayAndLag) {
    InputDelayEffect delay = axis.effects.input_delay.value_or(InputDelayEffect{});
    delay.delay_us += s.misfit == Misfit::kTimingError ? kTimingError_us : 200.0;
    axis.effects.input_delay = delay;
  }
  if (s.misfit == Misfit::kNoiseLevel) {
    axis.torque_noise_change = kNoiseFactor;
    axis.torque_noise_change_s = kBeforeProgram_s + 0.5 * duration_s;
  }
  VirtualMachine machine(file, ControllerName::kPid);
  Thermometer thermometer(machine.emulated(), s.temperature);
  machine.SetIo(thermometer);
  machine.BringUp();
  machine.Enable();
  const SeeCycle see = observer(file);
  machine.SetObserver(see);
  machine.Run(program);
  machine.SetObserver(nullptr);
  return kBeforeProgram_s + duration_s;
}

}  // namespace

LogSpan Record(const Setting& s, const std::vector<Hidden>& hidden, const std::filesystem::path& directory) {
  WriteText(directory / kModelFile, ModelText(s));
  std::unique_ptr<LogWriter> writer;
  std::unique_ptr<TelemetryEncoder> encoder;
  LogSpan span;
  span.speed_limit_rad_s = kSpeedLimit_mm_s * 1e-3 / s.truth.radius_m_rad();
  std::vector<double> position;
  span.planned_end_s = RunMachine(s, hidden, directory, [&](const EmulatedMachineFile& file) -> SeeCycle {
    LogHeader header;
    header.build = "contour_hidden";
    header.machine = file.machine.machine.name;
    header.controller = Name(ControllerName::kPid);
    header.clock = "virtual";
    header.cycle_us = file.machine.machine.cycle_us;
    for (const auto& [name, axis] : file.machine.axes) header.axis_names.push_back(name);
    writer = std::make_unique<LogWriter>(directory / kLogFile, header);
    encoder = std::make_unique<TelemetryEncoder>(TelemetryConfig{}, header.cycle_us, header.axis_names);
    return [&](const CycleEntry& entry, const TruthRow* truth) {
      TelemetrySink* sinks[] = {writer.get()};
      encoder->Add(entry, sinks);
      position.push_back(entry.output.record.axes[0].feedback.position_rad);
      if (truth == nullptr) return;
      if (position.size() == 1) span.begin_s = truth->time_s;
      span.end_s = truth->time_s;
    };
  });
  TelemetrySink* sinks[] = {writer.get()};
  encoder->Flush(sinks);
  writer->Close();
  for (std::size_t k = kSpeedOver; k < position.size(); ++k)
    span.largest_speed_rad_s =
        std::max(span.largest_speed_rad_s, std::fabs(position[k] - position[k - kSpeedOver]) /
                                               (1e-3 * static_cast<double>(kSpeedOver)));
  return span;
}

Recorded ReadRecorded(const std::filesystem::path& directory) {
  Recorded recorded;
  recorded.stated = diagnosis::ReadStatedAxis((directory / kModelFile).string(), "");
  diagnosis::ReadOptions options;
  options.axis = "x";
  options.table_per_q = recorded.stated.table_per_q;
  const std::filesystem::path log = directory / kLogFile;
  recorded.log = diagnosis::ReadLog(std::filesystem::exists(log) ? log : directory / kTableFile, options);
  return recorded;
}

void Compact(const std::filesystem::path& directory) {
  WriteLogTable(ReadRecorded(directory).log, directory / kTableFile);
  std::filesystem::remove(directory / kLogFile);
}

diagnosis::AxisLog Simulate(const Setting& s, const std::vector<Hidden>& hidden,
                            const std::filesystem::path& directory) {
  diagnosis::AxisLog log;
  RunMachine(s, hidden, directory, [&](const EmulatedMachineFile&) -> SeeCycle {
    return [&](const CycleEntry& entry, const TruthRow*) {
      const AxisRecord& a = entry.output.record.axes[0];
      log.command.push_back(a.torque_Nm);
      log.position.push_back(a.feedback.position_rad);
      if (a.feedback.has_scale) log.table_position_m.push_back(a.feedback.table_position_m);
    };
  });
  return log;
}

}  // namespace contour::hidden
