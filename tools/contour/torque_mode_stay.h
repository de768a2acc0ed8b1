#pragma once

#include <map>
#include <memory>
#include <string>

#include "config/machine_config.h"
#include "daemon/control_socket/control_client.h"

namespace contour {

/// A daemon in torque mode for as long as an axis is recorded, whatever its machine file says.
class TorqueModeStay {
 public:
  TorqueModeStay(std::unique_ptr<ControlClient>& client, std::string socket)
      : client_(client), socket_(std::move(socket)) {}

  /// Has it begin anew with the loops of all axes, and the models that they were found for where those are
  /// others. False where the drives did not come up so; contourd then runs as it did before.
  [[nodiscard]] bool Enter(const std::map<std::string, LoopTuning>& loops,
                           const std::map<std::string, ModelConfig>& models);
  /// Has it begin anew in its own mode, once the machine is Idle.
  void Leave();
  /// After a failure: tells rather than throws, so that the failure itself is told.
  void LeaveOrSay();

 private:
  void Begin(const std::map<std::string, std::string>& loops,
             const std::map<std::string, std::string>& models);

  std::unique_ptr<ControlClient>& client_;
  std::string socket_;
  bool entered_ = false;
};

/// The daemon's machine as it runs now, overrides and defaults in it.
MachineConfig AskForMachine(ControlClient& client);

}  // namespace contour
