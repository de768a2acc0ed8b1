#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "config/load_machine.h"
#include "config/machine_config.h"
#include "control/contour_controller.h"
#include "daemon/control_socket/operator_desk.h"
#include "daemon/learning/program_learning.h"
#include "daemon/program/motion_plan.h"
#include "daemon/pump.h"
#include "daemon/rt/command_mailbox.h"
#include "daemon/rt/loop.h"
#include "daemon/telemetry/telemetry_hub.h"
#include "drivers/modbus/io_client.h"

namespace contour {

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
};

/// Carries an operator's requests to the cycle and its answers back. It asks through the mailbox and decides
/// nothing: whether a request is right in the present state is for the cycle to say. Stop(), Status() and the
/// feeds may be called while another call waits.
class Supervisor final : public OperatorDesk {
 public:
  Supervisor(const MachineConfig& machine, ControllerName controller, std::string clock,
             std::vector<std::string> warnings, const SupervisedParts& parts, MachineSource source);

  Answer Enable() override;
  Answer Disable() override;
  Answer Stop() override;
  Answer Reset() override;
  Answer Reload() override;
  Answer Run(const ProgramUpload& program) override;
  MachineStatus Status() override;
  std::string MachineFile() override;
  void Attach(std::shared_ptr<RowFeed> feed) override;
  void Detach(const std::shared_ptr<RowFeed>& feed) override;

 private:
  Answer Ask(RequestKind kind, std::uint32_t program_id = 0);
  Answer Await(RequestKind kind, std::uint32_t sequence);
  [[nodiscard]] LearningReport Learn(const ProgramUpload& upload, const PerAxis<double>& start_m,
                                     PathGenerator& generator);

  MachineConfig machine_;  ///< as it runs now
  MachineSource source_;   ///< where it came from
  std::uint32_t changes_ = 0;
  std::vector<std::unique_ptr<ContourController>> controllers_;  ///< that the cycle may still hold
  std::mutex reload_;                                            ///< SIGHUP and the socket may both ask
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
  std::mutex posting_;  ///< requests come from the socket's worker and from SIGHUP, a stop from anywhere
  std::uint32_t program_id_ = 0;
  std::mutex program_;  ///< guards the two below
  std::string program_name_;
  double program_duration_s_ = 0.0;
};

}  // namespace contour
