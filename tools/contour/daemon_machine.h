#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "daemon/control_socket/control_client.h"
#include "tools/improve/improve_machine.h"

namespace contour {

/// A running contourd and the operator at the terminal, for `contour improve`.
class DaemonMachine final : public improve::ImproveMachine {
 public:
  struct Setup {
    std::string socket;
    std::string axis;
    bool yes = false;                   ///< the operator has granted everything beforehand
    std::atomic<bool>* stop = nullptr;  ///< set by an interrupt
  };
  /// Throws EnvironmentError when nobody listens.
  explicit DaemonMachine(Setup setup);

  /// Every cycle of a program is watched for these; without them nothing runs.
  void Watch(const improve::WorkingSpace& space) { space_ = space; }
  [[nodiscard]] nlohmann::json StatusNow();
  [[nodiscard]] nlohmann::json StatusOnceStarted();

  MachineConfig Machine() override;
  PerAxis<double> Position_m() override;
  void Ask(const std::string& what) override;
  void Enable() override;
  void Disable() override;
  bool AwaitIdle(const std::string& what_for) override;
  improve::Drawing Run(const improve::ProgramText& program) override;
  void LoadModel(const std::string& yaml) override;
  void Say(const std::string& line) override;

 private:
  class Recording;
  void CheckStop() const;
  void Follow(std::uint32_t program_id, const std::string& name, Recording& recording);

  Setup setup_;
  std::optional<improve::WorkingSpace> space_;
  std::unique_ptr<ControlClient> client_;
};

}  // namespace contour
