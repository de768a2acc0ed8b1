#include "daemon/daemon.h"

#include <pthread.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "config/config_error.h"
#include "config/idle_keys.h"
#include "config/load_machine.h"
#include "config/mode_advice.h"
#include "config/push_advice.h"
#include "core/exit_status.h"
#include "core/version.h"
#include "daemon/bus_health.h"
#include "daemon/control_socket/control_server.h"
#include "daemon/control_socket/socket_path.h"
#include "daemon/io_adapter.h"
#include "daemon/lanes/slow_lane.h"
#include "daemon/last_resort.h"
#include "daemon/learning/program_learning.h"
#include "daemon/loaded_model.h"
#include "daemon/logging/logging.h"
#include "daemon/machine_buses.h"
#include "daemon/make_cycle_config.h"
#include "daemon/make_log_header.h"
#include "daemon/memory/friction_memory.h"
#include "daemon/modbus_outputs.h"
#include "daemon/program/gcode/tool_table.h"
#include "daemon/pump.h"
#include "daemon/realtime_thread.h"
#include "daemon/recording_mode.h"
#include "daemon/rest_swing.h"
#include "daemon/rt/loop.h"
#include "daemon/service_notifier.h"
#include "daemon/start_again.h"
#include "daemon/start_file.h"
#include "daemon/supervisor.h"
#include "daemon/telemetry/telemetry_hub.h"
#include "design/path_following.h"
#include "drivers/cia301/messages.h"
#include "tools/machine/load_emulated_machine.h"

namespace contour {
namespace {

constexpr std::size_t kTelemetryEntries = 2048;
constexpr std::size_t kRequests = 16;
constexpr std::size_t kPathPoints = 4096;
constexpr std::chrono::milliseconds kWatchPeriod{50};
/// How often the cycle's state is copied: a flight record is longer than asked for by this at most.
constexpr double kSnapshotPeriod_s = 2.0;
/// In lock-step time waits for a disk, a network or clients that have fallen behind, but not for dead ones.
constexpr std::chrono::milliseconds kLockstepPatience{1000};
/// Of the time after which outputs go off: disk, network and, twice as long, clients may hold one cycle up.
constexpr double kPatienceOfSilence = 0.2;

// How long the end may take once the axes have stopped; systemd/contourd.service allows for all of it.
constexpr std::chrono::seconds kClosingTime{3};  ///< for the disk to take the rest of the log
constexpr std::chrono::seconds kEndingTime{8};   ///< for everything
constexpr std::chrono::seconds kLastLines{1};    ///< for the last messages
constexpr std::chrono::seconds kLoopHangs{5};    ///< after which a loop without cycles is not waited for

std::int64_t UnixTime_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::vector<FeedbackSource> FeedbackSources(const MachineConfig& machine) {
  std::vector<FeedbackSource> sources;
  for (const auto& [name, axis] : machine.axes)
    sources.push_back({static_cast<std::uint8_t>(BusIndex(machine, axis.drive.bus)),
                       static_cast<std::uint16_t>(cob::kTpdo1 + axis.drive.node_id)});
  return sources;
}

std::vector<BusParties> Parties(const MachineConfig& machine) {
  std::vector<BusParties> parties;
  for (const auto& [name, bus] : machine.buses) {
    parties.push_back({name, static_cast<std::uint8_t>(bus.master_node_id), {}});
    for (const auto& [axis_name, axis] : machine.axes)
      if (axis.drive.bus == name)
        parties.back().nodes.push_back(static_cast<std::uint8_t>(axis.drive.node_id));
  }
  return parties;
}

std::chrono::milliseconds PatienceFor(const std::string& clock, const MachineConfig& machine) {
  if (clock != "lockstep") return std::chrono::milliseconds(0);
  if (!machine.io.modbus || !machine.io.modbus->outputs.program) return kLockstepPatience;
  const double silence_ms = 1e3 * machine.io.modbus->outputs.program->silence_s;
  return std::min(kLockstepPatience, std::chrono::milliseconds(std::lround(kPatienceOfSilence * silence_ms)));
}

/// SIGTERM, SIGINT and SIGHUP are taken by the main thread alone.
sigset_t BlockSignals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  return set;
}

/// Its number, or 0 or less.
int SignalCame(const sigset_t& set) {
  const timespec wait{0, std::chrono::nanoseconds(kWatchPeriod).count()};
  return sigtimedwait(&set, nullptr, &wait);
}

std::vector<BusHealth::Named> InterfaceNames(const MachineConfig& machine) {
  std::vector<BusHealth::Named> names;
  for (const auto& [name, bus] : machine.buses) names.push_back({name, bus.interface});
  return names;
}

/// Everything of a running daemon, in the order in which it is taken down again.
class Daemon {
 public:
  Daemon(const DaemonOptions& options, const MaybeEmulatedMachineFile& file, const MachineSource& source,
         std::vector<std::string> warnings, FrictionMemory& memory)
      : options_(options),
        warnings_(std::move(warnings)),
        source_(source),
        memory_(memory),
        seed_(file.has_emulator ? std::optional(file.emulator.seed) : std::nullopt),
        machine_(file.machine),
        buses_(machine_, file.has_emulator ? std::optional(file.emulator) : std::nullopt, options.truth),
        mailbox_(kRequests, kPathPoints),
        queue_(kTelemetryEntries),
        hub_(machine_.telemetry, machine_.machine.cycle_us, AxisNames(machine_), LogTarget(),
             PatienceFor(options.clock, machine_)),
        pump_(queue_, mailbox_, hub_, machine_.machine.cycle_us * 1e-6, AxisNames(machine_),
              BusNames(machine_)),
        learning_(machine_),
        cycle_(MakeCycleConfig(machine_, machine_.machine.controller)),
        rest_swing_(MakeCycleConfig(machine_, machine_.machine.controller)),
        bus_health_(InterfaceNames(machine_)) {
    if (machine_.io.modbus) {
      io_client_ = std::make_unique<IoClient>(*machine_.io.modbus);
      io_ = std::make_unique<IoAdapter>(*io_client_, options_.clock == "lockstep");
      if (machine_.io.modbus->outputs.program) {
        outputs_ =
            std::make_unique<ModbusOutputs>(*machine_.io.modbus->outputs.program, *io_client_->outputs());
        pump_.SwitchOutputsBy(*outputs_);
      }
      pump_.ReportMotionTo(
          [this](double travel_m, double moving_s) { io_client_->ReportMotion(travel_m, moving_s); });
    } else {
      io_ = std::make_unique<NoIo>();
    }
    pump_.ShowCyclesTo([this](const CycleRecord& record) {
      memory_.Consume(record);
      learning_.Consume(record);
      rest_swing_.Consume(record);
    });
    pump_.AlsoDrain([this] {
      buses_.DrainTruth();
      for (const std::string& swing : rest_swing_.TakeNew()) spdlog::warn(swing);
      TellOfBuses();
    });
    hub_.WatchFeedback(FeedbackSources(machine_));
    hub_.WatchForeign(Parties(machine_));
    SetUpFlightRecorder();
    const Loop::Config loop{std::int64_t{1000} * machine_.machine.cycle_us, SendDeadline_ns(machine_),
                            snapshots_.get()};
    loop_ = std::make_unique<Loop>(loop, cycle_, buses_.all(), mailbox_, *io_, queue_);
  }

  /// What an operator has asked to begin anew with.
  [[nodiscard]] const std::optional<NewStart>& wanted() const { return wanted_; }

  int Run(const sigset_t& signals) {
    const bool lockstep = options_.clock == "lockstep";
    if (lockstep && !buses_.all_virtual())
      throw ConfigError(
          {"--clock lockstep: found a real bus, expected loopback or vcan only: a real machine does not "
           "wait"});
    RealtimeThread thread(*loop_, machine_.realtime, lockstep);
    const std::vector<std::string> refused = thread.Start();
    for (const std::string& r : refused)
      spdlog::log(machine_.realtime.required ? spdlog::level::err : spdlog::level::warn, r);
    if (!refused.empty() && machine_.realtime.required) {
      thread.Go(false);
      throw EnvironmentError("the kernel refused real time: " + refused.front() +
                             ". realtime.required: false in the machine file goes on without");
    }
    std::vector<std::string> warnings = refused;
    for (const std::string& warning : warnings_) {
      spdlog::warn(warning);
      warnings.push_back(warning);
    }
    for (const auto& texts : {ModeAdvice(machine_), PushAdvice(machine_), LoadedModelTexts(options_.models)})
      for (const std::string& text : texts) {
        spdlog::warn(text);
        warnings.push_back(text);
      }
    const RecordingMode mode{options_.torque_loops, options_.torque_models, options_.csp_axes};
    if (const auto told = RecordingModeText(mode)) {
      spdlog::warn(*told);
      warnings.push_back(*told);
    }
    if (const std::optional<std::string> wider = WiderToleranceText(machine_)) {
      spdlog::warn(*wider);
      warnings.push_back(*wider);
    }
    Supervisor supervisor(machine_, machine_.machine.controller, options_.clock, warnings,
                          {mailbox_, queue_, hub_, pump_, *loop_, learning_, io_client_.get(), seed_,
                           Checks(), mode, &rest_swing_},
                          source_);
    ControlServer::Options socket;
    socket.socket = options_.socket.empty() ? DefaultSocketPath() : std::filesystem::path(options_.socket);
    ControlServer server(socket, supervisor);
    if (io_client_) io_client_->Start();
    memory_.Start();
    pump_.Start();
    spdlog::info("{} {}: machine {}, controller {}, cycle {} us, socket {}", "contourd", kVersion,
                 machine_.machine.name, Name(machine_.machine.controller), machine_.machine.cycle_us,
                 socket.socket.string());
    thread.Go(true);
    server.Start();
    const int status = Watch(signals, thread, supervisor);
    thread.Join();
    supervisor.LoopEnded();
    End(server, status);
    return status;
  }

 private:
  /// What a start would refuse is refused before the daemon ends for it.
  [[nodiscard]] StartChecks Checks() const {
    return {[this] { RequireLoops(options_, source_.overrides); },
            [this](const NewStart& start) {
              const DaemonOptions anew = WithNewStart(options_, start);
              LoopsOfStart(anew, OverridesOf(anew));
            }};
  }

  std::optional<TelemetryHub::LogTarget> LogTarget() const {
    if (options_.log.empty()) return std::nullopt;
    return TelemetryHub::LogTarget{options_.log,
                                   MakeLogHeader(source_, machine_, options_.clock, UnixTime_us())};
  }

  void SetUpFlightRecorder() {
    const TelemetryConfig& telemetry = machine_.telemetry;
    FlightRecorder::Config config;
    config.directory = telemetry.flight_directory.empty() ? DefaultFlightDirectory()
                                                          : std::filesystem::path(telemetry.flight_directory);
    if (telemetry.flight_recorder_s == 0.0 || config.directory.empty()) return;
    const double cycles_per_s = 1e6 / machine_.machine.cycle_us;
    config.window_cycles = static_cast<std::uint64_t>(telemetry.flight_recorder_s * cycles_per_s);
    snapshots_ = std::make_unique<StateSnapshots>(
        cycle_.StateSize(), static_cast<std::uint64_t>(kSnapshotPeriod_s * cycles_per_s));
    pump_.TakeSnapshotsFrom(*snapshots_);
    hub_.AddFlightRecorder(std::make_unique<FlightRecorder>(
        std::move(config), MakeLogHeader(source_, machine_, options_.clock, UnixTime_us())));
  }

  void TellOfBuses() {
    const auto now = std::chrono::steady_clock::now();
    for (std::size_t b = 0; b < machine_.buses.size(); ++b)
      for (const BusHealth::Line& line : bus_health_.Look(b, loop_->bus_states().Read(b), now))
        spdlog::log(line.over ? spdlog::level::info : spdlog::level::warn, line.text);
  }

  /// Takes everything down, the log first: it is what somebody will want. The axes stand still.
  void End(ControlServer& server, int status) {
    LastResort last_resort(kEndingTime, status);
    const auto closed_by = std::chrono::steady_clock::now() + kClosingTime;
    last_resort.Now("emptying the telemetry queue");
    hub_.EndFeeds();
    pump_.Finish();
    last_resort.Now("closing the log");
    const bool all = hub_.Close(closed_by);
    const bool truth = buses_.FinishTruth(closed_by);
    ReportLosses(all && truth);
    last_resort.Now("a request of an operator");
    server.Stop();
    last_resort.Now("a reload of the machine file");
    if (!reloading_.Finish(closed_by + kClosingTime)) LastResort::End("a reload of the machine file", status);
    last_resort.Now("keeping what has been learnt");
    memory_.Finish();
    last_resort.Now("the auxiliary I/O");
    if (io_client_) io_client_->Stop();
    spdlog::info("ended");
    const bool said = FinishLogging(std::chrono::steady_clock::now() + kLastLines);
    // A thread that is stuck in a write may hold what the ordinary end of a process waits for.
    if (!all || !truth || !said) ::_exit(status);
  }

  void ReportLosses(bool all) const {
    const LogStats log = hub_.log();
    if (const std::uint64_t lost = log.lost_cycles + log.waiting_cycles; lost != 0 || log.lost_notes != 0)
      spdlog::error("{} cycles and {} notes are not in the log {}: {}", lost, log.lost_notes, log.file,
                    log.last_error.empty() ? "the file does not take them" : log.last_error);
    if (const std::uint64_t dropped = queue_.dropped(); dropped != 0)
      spdlog::warn("{} cycles never reached telemetry and log", dropped);
    if (!all) spdlog::error("log, flight record, truth or LCM: not everything was taken in time; it is lost");
  }

  /// On a signal. Reading the file may take for ever, and the main thread has other things to do.
  void Reload(Supervisor& supervisor) {
    const bool taken = reloading_.Post(1, [&supervisor] {
      const Answer answer = supervisor.Reload();
      spdlog::log(answer.accepted ? spdlog::level::info : spdlog::level::err, "reload: {}", answer.reason);
    });
    if (!taken) spdlog::error("reload: the one before has not ended");
  }

  /// The main thread's work while the loop runs. A first bring-up that fails ends the daemon with status 1.
  int Watch(const sigset_t& signals, const RealtimeThread& thread, Supervisor& supervisor) {
    int status = kExitDone;
    bool up = false;
    bool ending = false;
    std::uint64_t cycles = 0;
    auto advanced = std::chrono::steady_clock::now();
    ServiceNotifier notifier;
    while (!thread.ended()) {
      const bool was_ending = ending;
      const int signal = SignalCame(signals);
      if (signal == SIGHUP) {
        Reload(supervisor);
      } else if (signal > 0) {
        mailbox_.PostTerminate();  // before anything that writes
        ending = true;
        wanted_.reset();  // whoever ends the daemon does not want it back
        spdlog::info("asked to end by a signal");
        notifier.Stopping();
      }
      if (!ending && !wanted_ && (wanted_ = supervisor.wanted())) {
        mailbox_.PostTerminate();
        ending = true;
        spdlog::info("ends and begins anew {}", Describe(*wanted_));
      }
      const auto now = std::chrono::steady_clock::now();
      if (const std::uint64_t n = loop_->counters().cycles.load(); n != cycles || !was_ending) {
        cycles = n;
        advanced = now;
      }
      if (now - advanced > kLoopHangs) LastResort::End("the cycle, which hangs", kExitFailed);
      const CycleRecord record = supervisor.record();
      notifier.Status(std::string(Name(record.state)) + (record.reason == Reason::kNone
                                                             ? std::string()
                                                             : ": " + std::string(Name(record.reason))));
      notifier.Alive(loop_->counters().cycles.load());
      const bool failed = record.reason == Reason::kBringUpFailed || record.reason == Reason::kSecondMaster;
      if (record.state == MachineState::kIdle || (record.state == MachineState::kFaulted && !failed)) {
        notifier.Ready();
        up = true;
      }
      if (!up && failed && status == kExitDone && record.state == MachineState::kFaulted) {
        status = kExitFailed;
        ending = true;
        mailbox_.PostTerminate();
      }
    }
    return status;
  }

  DaemonOptions options_;
  std::vector<std::string> warnings_;  ///< of the machine file
  MachineSource source_;
  FrictionMemory& memory_;
  std::optional<std::uint64_t> seed_;  ///< of the emulated machine in this process
  MachineConfig machine_;
  MachineBuses buses_;
  CommandMailbox mailbox_;
  TelemetryQueue queue_;
  TelemetryHub hub_;
  Pump pump_;
  ProgramLearning learning_;
  Cycle cycle_;
  RestSwing rest_swing_;
  BusHealth bus_health_;
  std::unique_ptr<IoClient> io_client_;
  std::unique_ptr<ModbusOutputs> outputs_;
  std::unique_ptr<IoSource> io_;
  std::unique_ptr<StateSnapshots> snapshots_;
  std::unique_ptr<Loop> loop_;
  std::optional<NewStart> wanted_;
  SlowLane reloading_{"contour-reload", {1, {}}};
};

spdlog::level::level_enum ToSpdlog(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug:
      return spdlog::level::debug;
    case LogLevel::kInfo:
      return spdlog::level::info;
    case LogLevel::kWarning:
      return spdlog::level::warn;
    case LogLevel::kError:
      return spdlog::level::err;
  }
  return spdlog::level::info;
}

/// Until it ends; `again` is what to begin anew with.
int RunOnce(const DaemonOptions& options, std::optional<NewStart>& again) {
  std::vector<std::string> overrides = OverridesOf(options);
  const MachineConfig stated = LoadMachine(options.config, overrides);
  // Programs read it anew; what is wrong with it is said before anything begins.
  LoadToolTable(stated.machine.tool_table);
  // As stated: what has been learnt of the stroke moves no limit.
  const StartLoops loops = LoopsOfStart(options, overrides, &ServiceNotifier::StillStarting);
  ServiceNotifier::StillStarting();
  FrictionMemory memory(stated, MemoryDirectory(stated.memory));
  for (const std::string& learnt : memory.Overrides()) overrides.push_back(learnt);
  // In the log, too: a replay has the same.
  overrides.insert(overrides.end(), loops.chosen.begin(), loops.chosen.end());
  for (const std::string& following : PathFollowingIfMissing(LoadMachine(options.config, overrides)))
    overrides.push_back(following);
  const MaybeEmulatedMachineFile file = LoadFile(options, overrides);
  const MachineSource source = ReadSource(options.config, overrides);
  // Before any thread starts, so that all inherit it.
  const sigset_t signals = BlockSignals();
  LoggingOptions logging;
  logging.level = ToSpdlog(file.machine.logging.level);
  if (!file.machine.logging.file.empty()) logging.file = file.machine.logging.file;
  SetUpLogging(logging);
  for (const std::string& loop : loops.chosen)
    spdlog::info("chosen, as the machine file has none: {}; contour tune --from-model finds a better one",
                 loop);
  if (const std::size_t idle =
          IdleKeys(OpenMachineFile(options.config, OverridesOf(options)), file.machine).size();
      idle > 0)
    spdlog::info("keys of the machine file that nothing goes by: {}; contour check lists them", idle);
  for (const std::string& text : memory.used()) spdlog::info("{}", text);
  for (const std::string& text : memory.refused()) spdlog::warn("{}", text);
  // What is thrown from here on is for main to print: the signals end the process again, should that be
  // stuck.
  const struct GiveSignalsBack {
    ~GiveSignalsBack() {
      FinishLogging(std::chrono::steady_clock::now() + kLastLines);
      pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
    }
    const sigset_t& set;
  } give_back{signals};
  Daemon daemon(options, file, source, loops.warned, memory);
  const int status = daemon.Run(signals);
  again = daemon.wanted();
  return status;
}

}  // namespace

int RunDaemon(const DaemonOptions& options) {
  std::optional<NewStart> again;
  const int status = RunOnce(options, again);
  if (again && status == kExitDone) StartAgain(WithNewStart(options, *again));
  // Drives that have no such mode, say: the machine file's own did come up.
  if (status == kExitFailed && !(options.torque_loops.empty() && options.csp_axes.empty()))
    StartAgain(WithNewStart(options, {{}, RecordingMode{}}));
  return status;
}

}  // namespace contour
