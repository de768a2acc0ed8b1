#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "config/load_machine.h"
#include "config/machine_config.h"
#include "control/contour_controller.h"
#include "daemon/control_socket/operator_desk.h"
#include "daemon/learning/program_learning.h"
#include "daemon/new_start.h"
#include "daemon/pace_control.h"
#include "daemon/program/motion_plan.h"
#include "daemon/program_zero.h"
#include "daemon/pump.h"
#include "daemon/rest_swing.h"
#include "daemon/rt/command_mailbox.h"
#include "daemon/rt/loop.h"
#include "daemon/telemetry/cycle_answers.h"
#include "daemon/telemetry/telemetry_hub.h"
#include "drivers/modbus/io_client.h"

namespace contour {

/// What a start of contourd asks beyond what a machine file can say wrong; each throws ConfigError.
struct StartChecks {
  std::function<void()> reload;                     ///< of the machine file as it is now
  std::function<void(const NewStart&)> begin_anew;  ///< of it with what is asked for
};

/// What the supervisor watches and speaks to; all of it outlives the supervisor.
struct SupervisedParts {
  CommandMailbox& mailbox;
  TelemetryQueue& queue;
  TelemetryHub& hub;
  Pump& pump;
  Loop& loop;
  ProgramLearning& learning;
  const IoClient* io = nullptr;                  ///< null without auxiliary I/O
  std::optional<std::uint64_t> emulator_seed{};  ///< of an emulated machine in this process
  StartChecks checks{};                          ///< those that are empty find nothing
  RecordingMode recording_mode{};                ///< that it runs in
  const RestSwing* rest_swing = nullptr;         ///< null: nobody watches for swings at rest
};

/// Carries an operator's requests to the cycle and its answers back. It asks through the mailbox and decides
/// nothing: whether a request is right in the present state is for the cycle to say. Stop(), Disable(),
/// Status() and the feeds may be called while another call waits. Answers and the newest record come from the
/// cycle's board, past the pump: no disk and no network is on that way.
class Supervisor final : public OperatorDesk {
 public:
  Supervisor(const MachineConfig& machine, ControllerName controller, std::string clock,
             std::vector<std::string> warnings, const SupervisedParts& parts, MachineSource source);

  Answer Enable(const std::stop_token& unwanted) override;
  Answer Disable() override;
  Answer Stop() override;
  Answer Reset(const std::stop_token& unwanted) override;
  Answer Reference(const std::map<std::string, double>& position_mm,
                   const std::stop_token& unwanted) override;
  Answer Reload() override;
  Answer LoadModel(const std::string& axis, const std::string& yaml) override;
  Answer ChangeMode(const std::map<std::string, std::string>& loops,
                    const std::map<std::string, std::string>& models) override;
  Answer LeaveToDrives() override;
  void Abandoned() override;
  Answer Run(const ProgramUpload& program, const std::stop_token& unwanted) override;
  Answer Zero() override;
  Answer Pace(const PaceRequest& request) override {
    return pace_.Change(request, [this] { return answers_.record(); });
  }
  MachineStatus Status() override;
  std::string MachineFile() override;
  void Attach(std::shared_ptr<RowFeed> feed) override;
  void Detach(const std::shared_ptr<RowFeed>& feed) override;

  /// Asked by LoadModel(), ChangeMode() or LeaveToDrives() and not yet carried out. Waits for no file and for
  /// no check.
  [[nodiscard]] std::optional<NewStart> wanted();

  /// The newest record.
  [[nodiscard]] CycleRecord record() { return answers_.record(); }
  /// The loop has ended: whoever waits for its answer is told so.
  void LoopEnded() { loop_ended_ = true; }

 private:
  Answer Ask(RequestKind kind, const std::stop_token& unwanted, std::uint32_t program_id = 0);
  Answer Await(RequestKind kind, std::uint32_t sequence, const std::stop_token& unwanted);
  [[nodiscard]] std::optional<Answer> Look(RequestKind kind, std::uint32_t sequence);
  std::uint32_t Post(RequestKind kind, std::uint32_t program_id = 0);
  void TakeBack(RequestKind kind);
  [[nodiscard]] Answer BeginAnewIn(RecordingMode mode);
  [[nodiscard]] Answer BeginAnew(const std::vector<std::string>& overrides, NewStart start);
  [[nodiscard]] LearningReport Learn(const ProgramUpload& upload, const Placement& place,
                                     PathGenerator& generator);

  MachineConfig machine_;  ///< as it runs now
  MachineSource source_;   ///< where it came from
  std::uint32_t changes_ = 0;
  std::vector<std::unique_ptr<ContourController>> controllers_;  ///< that the cycle may still hold
  std::mutex reload_;   ///< SIGHUP and the socket may both ask; held while files are read and checked
  std::mutex wanting_;  ///< never held for long: the main thread asks by it, and has signals to take
  std::optional<NewStart> wanted_;  ///< guarded by wanting_
  std::string machine_name_;
  ControllerName controller_;
  std::string clock_;
  int cycle_us_;
  std::vector<std::string> warnings_;
  std::vector<std::string> axis_names_;
  std::vector<std::string> bus_names_;
  std::vector<std::string> interfaces_;
  PerAxis<PlanLimits> limits_;
  PerAxis<double> encoder_counts_m_;  ///< way of the table per encoder count
  SupervisedParts parts_;
  CycleAnswers answers_;
  PaceControl pace_;
  EventUse events_;
  ProgramDefaults program_defaults_;
  ProgramZero zero_;
  std::atomic<bool> loop_ended_{false};
  std::mutex
      posting_;  ///< requests come from two threads of the socket's and from SIGHUP, a stop from anywhere
  std::uint32_t program_id_ = 0;
  std::mutex program_;  ///< guards the name
  std::string program_name_;
};

}  // namespace contour
