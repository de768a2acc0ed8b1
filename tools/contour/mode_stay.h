#pragma once

#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "config/machine_config.h"
#include "daemon/control_socket/control_client.h"

namespace contour {

/// A daemon in another mode for as long as an axis is recorded, whatever its machine file says. It is
/// attended: should this program die, it takes the torque off and goes back by itself.
class ModeStay {
 public:
  ModeStay(std::unique_ptr<ControlClient>& client, std::string socket)
      : client_(client), socket_(std::move(socket)) {}

  /// Has it begin anew in torque mode with the loops of all axes, and the models that they were found for
  /// where those are others. False where the drives did not come up so; contourd then runs as its machine
  /// file has it. Throws BeginRefused, with the daemon as it was.
  [[nodiscard]] bool EnterTorqueMode(const std::map<std::string, LoopTuning>& loops,
                                     const std::map<std::string, ModelConfig>& models);
  /// The same in csp, held by the drives' own loops.
  [[nodiscard]] bool EnterCsp();
  /// Has it begin anew in its own mode, once the machine is Idle, and attends it no more. Throws
  /// std::runtime_error where it is Faulted.
  void Leave();
  /// After a failure: tells rather than throws, so that the failure itself is told.
  void LeaveOrSay();

 private:
  [[nodiscard]] bool Enter(const nlohmann::json& request,
                           const std::function<bool(const MachineConfig&)>& is_so);
  void Begin(const nlohmann::json& request);

  std::unique_ptr<ControlClient>& client_;
  std::string socket_;
  bool entered_ = false;
};

/// Whether all axes are in torque mode with these loops: a machine file may have torque mode with others.
[[nodiscard]] bool HasLoops(const MachineConfig& machine, const std::map<std::string, LoopTuning>& loops);

/// The daemon's machine as it runs now, overrides and defaults in it.
MachineConfig AskForMachine(ControlClient& client);

}  // namespace contour
