#include "tools/contour/daemon_machine.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <thread>
#include <utility>

#include "analysis/recording/record_axis.h"
#include "analysis/text/format_text.h"
#include "config/config_error.h"
#include "config/load_machine.h"
#include "config/yaml_reader.h"
#include "config/yaml_writer.h"
#include "core/exit_status.h"
#include "daemon/control_socket/base64.h"
#include "drivers/cia402/mode_for.h"
#include "drivers/lcm/cycle_messages.h"
#include "tools/contour/daemon_link.h"
#include "tools/contour/new_daemon.h"

namespace contour {
namespace {

using nlohmann::json;

constexpr std::chrono::milliseconds kLookEvery{50};
constexpr std::chrono::seconds kStateLimit{60};
constexpr std::chrono::seconds kLastRows{5};
/// A daemon that begins anew closes its log, and finds and configures its drives.
constexpr std::chrono::seconds kBeginAnew{60};
constexpr double kRounding = 1.001;

const bool kTerminal = ::isatty(STDERR_FILENO) != 0;

ModelConfig ModelOf(const std::string& yaml) {
  ModelConfig model;
  std::vector<std::string> errors;
  ReadYaml(ParseYamlText(yaml, "the model"), model, "model", errors);
  if (!errors.empty()) throw ConfigError(errors);
  return model;
}

/// The daemon's errors begin with the model that it was given.
std::string WhyRefused(std::string error, const std::string& model) {
  const std::size_t at = error.find(model);
  if (!model.empty() && at != std::string::npos) error.erase(0, at + model.size());
  error.erase(0, error.find_first_not_of(": \n"));
  return "contourd does not take it: " + error;
}

void ClearLine() {
  if (kTerminal) std::fputs("\r\x1b[K", stderr);
}

}  // namespace

/// What the daemon sends of one program, and whether the axes keep to what the operator allowed.
class DaemonMachine::Recording {
 public:
  Recording(ControlClient& client, const improve::WorkingSpace& space, const MachineConfig& machine)
      : client_(client), space_(space), recorder_(MakeRecorder(space, machine)) {
    client_.OnMessage([this](const json& message) { OnMessage(message); });
    AskOrThrow(client_, {{"request", "rows"}, {"on", true}});
  }
  ~Recording() {
    client_.OnMessage([](const json&) {});
  }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  void SetProgram(std::uint32_t id) { program_id_ = id; }
  [[nodiscard]] const std::string& offence() const { return offence_; }

  /// Everything up to this cycle.
  improve::Drawing Finish(std::uint64_t last_cycle) {
    const auto deadline = std::chrono::steady_clock::now() + kLastRows;
    while (newest_cycle_ < last_cycle && std::chrono::steady_clock::now() < deadline)
      client_.Listen(kLookEvery);
    AskOrThrow(client_, {{"request", "rows"}, {"on", false}});
    drawing_.log = recorder_.Take();
    return std::move(drawing_);
  }

 private:
  static AxisRecorder MakeRecorder(const improve::WorkingSpace& space, const MachineConfig& machine) {
    const AxisConfig& axis = machine.axes.at(space.names[space.axis]);
    const bool by_drive = ModeFor(machine.machine.controller, axis.drive) == DriveMode::kCsp;
    return {space.axis,
            machine.machine.cycle_us * 1e-6,
            {by_drive, static_cast<std::size_t>(axis.drive.delay_cycles), 1e-3 * axis.drive.lag_ms}};
  }
  void OnMessage(const json& message) {
    if (!message.contains("rows")) return;
    drawing_.lost = message.at("lost");
    for (const json& text : message.at("rows")) {
      const auto row = FromBase64(text.get<std::string>());
      contour_lcm::cycle_entry raw{};
      if (!row || !Decode(*row, raw) || !FromMessage(raw, entry_))
        throw std::runtime_error(
            "contourd sends rows that this program cannot read; are they of one version?");
      const CycleRecord& record = entry_.output.record;
      newest_cycle_ = record.cycle;
      if (record.state != MachineState::kRunning) continue;
      // Rows may come before the answer that says which program it is: nothing else runs meanwhile.
      if (program_id_ && record.program_id != *program_id_) continue;
      recorder_.Add(record);
      improve::AddCycle(record, drawing_);
      for (std::size_t i = 0; i < record.axes.size() && offence_.empty(); ++i) Look(record.axes[i], i);
    }
  }
  void Look(const AxisRecord& a, std::size_t i) {
    const improve::AxisSpace& s = space_.axes[i];
    const std::string axis = "axis " + space_.names[i] + ": ";
    if (std::abs(a.torque_Nm) > s.max_torque_Nm)
      offence_ =
          axis + FormatText("torque of %.3f Nm is beyond the %.3f Nm allowed", a.torque_Nm, s.max_torque_Nm);
    if (a.position_m < s.low_m || a.position_m > s.high_m)
      offence_ = axis + FormatText("position %.3f mm is beyond --travel_mm", 1e3 * a.position_m);
    if (std::abs(a.reference.velocity_m_s) > kRounding * s.max_speed_m_s)
      offence_ = axis + FormatText("speed of %.3f mm/s is beyond the %.3f mm/s allowed",
                                   1e3 * a.reference.velocity_m_s, 1e3 * s.max_speed_m_s);
  }

  ControlClient& client_;
  const improve::WorkingSpace& space_;
  AxisRecorder recorder_;
  improve::Drawing drawing_;
  CycleEntry entry_;
  std::optional<std::uint32_t> program_id_;
  std::string offence_;
  std::uint64_t newest_cycle_ = 0;
};

DaemonMachine::DaemonMachine(Setup setup)
    : setup_(std::move(setup)), client_(std::make_unique<ControlClient>(ConnectToDaemon(setup_.socket))) {}

nlohmann::json DaemonMachine::StatusNow() { return Status(*client_); }

nlohmann::json DaemonMachine::StatusOnceStarted() { return contour::StatusOnceStarted(*client_); }

void DaemonMachine::CheckStop() const {
  if (setup_.stop != nullptr && *setup_.stop) throw improve::Refused("interrupted");
}

MachineConfig DaemonMachine::Machine() {
  const json reply = AskOrThrow(*client_, {{"request", "machine_file"}});
  std::vector<std::string> errors;
  MachineConfig machine =
      ReadMachine(ParseYamlText(reply.at("yaml").get<std::string>(), "the daemon's machine file"), errors);
  if (!errors.empty()) throw ConfigError(errors);
  const std::string controller = Status(*client_).at("controller");
  if (!FromName(controller, machine.machine.controller))
    throw std::runtime_error("the daemon runs a controller that this program does not know: " + controller);
  return machine;
}

PerAxis<double> DaemonMachine::Position_m() {
  PerAxis<double> out;
  const json status = Status(*client_);
  for (const json& axis : status.at("axes")) out.push_back(axis.at("position_m").get<double>());
  return out;
}

void DaemonMachine::Ask(const std::string& what) {
  CheckStop();
  std::cout << what << "\n" << std::flush;
  if (setup_.yes) return;
  if (::isatty(STDIN_FILENO) == 0)
    throw ConfigError({"improve moves the machine: grant it with --yes (there is no terminal to ask on)"});
  std::cout << "Go on? [yes/no] " << std::flush;
  std::string answer;
  std::getline(std::cin, answer);
  CheckStop();
  if (answer != "yes") throw improve::Refused("refused by the operator");
}

void DaemonMachine::Enable() {
  CheckStop();
  Attend(*client_, true);
  AskOrThrow(*client_, {{"request", "enable"}});
  const json status = WaitForStatus(
      *client_, [](const json& s) { return s.at("state") != "Enabling" && s.at("state") != "Idle"; },
      kStateLimit);
  if (status.at("state") != "Ready")
    throw std::runtime_error("could not be enabled: " + StateSentence(status));
}

void DaemonMachine::Disable() {
  AskOrThrow(*client_, {{"request", "disable"}});
  WaitForStatus(
      *client_, [](const json& s) { return s.at("state") == "Idle" || s.at("state") == "Faulted"; },
      kStateLimit);
  Attend(*client_, false);
}

bool DaemonMachine::AwaitIdle(const std::string& what_for) {
  // An interrupt may have led here; another one ends the waiting.
  if (setup_.stop != nullptr) setup_.stop->store(false);
  std::string told;
  for (;;) {
    const json status = Status(*client_);
    if (status.at("state") == "Idle") return !told.empty();
    const std::string now = StateSentence(status);
    if (now != told) Say("waits for Idle (" + what_for + "; Ctrl-C ends the waiting): " + now);
    told = now;
    if (setup_.stop != nullptr && *setup_.stop)
      throw improve::Refused("interrupted, and the machine is " + now);
    client_->Listen(kLookEvery);
  }
}

void DaemonMachine::Follow(std::uint32_t program_id, const std::string& name, Recording& recording) {
  bool stopping = false;
  for (;;) {
    const json status = Status(*client_);
    const std::string state = status.at("state");
    const json& program = status.at("program");
    const bool ours = program.at("id") == program_id;
    if (!ours || (state == "Ready" && status.at("reason") != "none") ||
        (state != "Ready" && state != "Running" && state != "Stopping")) {
      ClearLine();
      if (!recording.offence().empty()) throw std::runtime_error("stopped: " + recording.offence());
      CheckStop();
      if (ours && status.at("reason") == "program_end") return;
      throw std::runtime_error(name + " did not end by itself: " + StateSentence(status));
    }
    if (kTerminal && program.at("time_s").is_number() && program.at("duration_s").is_number())
      std::fprintf(stderr, "\r\x1b[K%s  %.1f of %.1f s", name.c_str(), program.at("time_s").get<double>(),
                   program.at("duration_s").get<double>());
    const bool interrupted = setup_.stop != nullptr && *setup_.stop;
    if ((interrupted || !recording.offence().empty()) && !stopping) {
      stopping = true;
      client_->Ask({{"request", "stop"}});
      // A second one is the shortest stop there is.
      if (!recording.offence().empty()) client_->Ask({{"request", "stop"}});
    }
    const auto until = std::chrono::steady_clock::now() + kLookEvery;
    while (std::chrono::steady_clock::now() < until)
      client_->Listen(std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now()));
  }
}

improve::Drawing DaemonMachine::Run(const improve::ProgramText& program) {
  CheckStop();
  if (!space_) throw std::logic_error("nobody has said where the axes may be");
  const MachineConfig machine = Machine();
  Recording recording(*client_, *space_, machine);
  const json reply =
      RunProgram(*client_, {{"request", "run"},
                            {"name", program.name},
                            {"format", program.format == ProgramFormat::kGcode ? "ngc" : "yaml"},
                            {"from_here", true},
                            {"text", program.text}});
  recording.SetProgram(reply.at("program_id"));
  Follow(reply.at("program_id"), program.name, recording);
  improve::Drawing drawing = recording.Finish(Status(*client_).at("cycle"));
  for (const json& m : reply.at("start_m")) drawing.start_m.push_back(m.get<double>());
  drawing.known = improve::KnownOf(machine);
  return drawing;
}

void DaemonMachine::LoadModel(const std::string& yaml) {
  const auto deadline = std::chrono::steady_clock::now() + kBeginAnew;
  try {
    BeginAnew(
        client_, {{"request", "load_model"}, {"axis", setup_.axis}, {"model", yaml}},
        [this] { return ConnectToDaemon(setup_.socket); }, deadline);
  } catch (const BeginRefused& e) {
    if (const json status = Status(*client_); status.at("state") != "Idle")
      throw improve::NotIdle("the new model was not loaded: " + StateSentence(status));
    throw improve::ModelRefused(WhyRefused(e.what(), yaml));
  }
  if (!yaml.empty() && WriteYaml(Machine().axes.at(setup_.axis).model) != WriteYaml(ModelOf(yaml)))
    throw std::runtime_error("contourd began anew, but not with the model that it was given");
}

void DaemonMachine::Say(const std::string& line) {
  ClearLine();
  std::cout << line << "\n" << std::flush;
}

}  // namespace contour
