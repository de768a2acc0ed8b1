#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace contour {

/// The controllers a machine can run with, by the names users know.
enum class ControllerName : std::uint8_t {
  kPid,          ///< PID with velocity and acceleration feed-forward
  kCsp,          ///< the drive's own position cascade
  kMpc,          ///< MPC without compensation
  kMpcObserver,  ///< MPC with disturbance observer
  kMpcSrukf4,    ///< MPC with the paper's 4-state friction filter, corrected
  kMpcEkf7,      ///< MPC with the 7-state EKF
  kMpcSrukf7,    ///< MPC with the 7-state SRUKF
  kFull,         ///< the best there is: preview, wind-up and ripple besides
  kCnc,          ///< a numerical control as sold: drive cascade, lost motion and reversals by fixed numbers
};

inline constexpr std::array<std::string_view, 9> kControllerNames{
    "pid", "csp", "mpc", "mpc_observer", "mpc_srukf4", "mpc_ekf7", "mpc_srukf7", "full", "cnc"};

constexpr std::string_view Name(ControllerName c) noexcept {
  return kControllerNames[static_cast<std::size_t>(c)];
}
constexpr std::string_view Choices(ControllerName) noexcept {
  return "pid, csp, mpc, mpc_observer, mpc_srukf4, mpc_ekf7, mpc_srukf7, full or cnc";
}
constexpr bool FromName(std::string_view name, ControllerName& out) noexcept {
  for (std::size_t i = 0; i < kControllerNames.size(); ++i) {
    if (kControllerNames[i] != name) continue;
    out = static_cast<ControllerName>(i);
    return true;
  }
  return false;
}

}  // namespace contour
