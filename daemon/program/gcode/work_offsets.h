#pragma once

#include <array>

#include "daemon/program/gcode/block.h"

namespace contour {

/// G54 to G59.3, G92 and the length of the tool, in metres. A position of the program is a position from
/// program zero less all three.
class WorkOffsets {
 public:
  [[nodiscard]] double Of(std::size_t axis) const {
    return systems_m_[active_][axis] + g92_m_[axis] + tool_m_[axis];
  }
  [[nodiscard]] double G92(std::size_t axis) const { return g92_m_[axis]; }
  [[nodiscard]] double tool_m(std::size_t axis) const { return tool_m_[axis]; }
  void SetTool(const AxisValues& tool_m) { tool_m_ = tool_m; }
  [[nodiscard]] bool HasTool() const { return tool_m_ != AxisValues{}; }

  /// Tenfold: 540 to 590, 591, 592, 593.
  void Select(int g) { active_ = static_cast<std::size_t>(g < 590 ? (g - 540) / 10 : 5 + g - 590); }

  /// What has been selected, tenfold.
  [[nodiscard]] int selected() const {
    return active_ < 6 ? 540 + 10 * static_cast<int>(active_) : 585 + static_cast<int>(active_);
  }

  /// Number 1 is G54; 0 the one in force.
  void SetSystem(int number, std::size_t axis, double offset_m) {
    systems_m_[number == 0 ? active_ : static_cast<std::size_t>(number - 1)][axis] = offset_m;
  }
  [[nodiscard]] double system_m(std::size_t axis) const { return systems_m_[active_][axis]; }

  void SetG92(std::size_t axis, double offset_m) { g92_m_[axis] = offset_m; }
  void KeepG92() { kept_m_ = g92_m_; }
  void SuspendG92() { g92_m_ = {}; }           ///< G92.2
  void RestoreG92() { g92_m_ = kept_m_; }      ///< G92.3
  void ForgetG92() { g92_m_ = kept_m_ = {}; }  ///< G92.1

 private:
  std::array<AxisValues, 9> systems_m_{};
  std::size_t active_ = 0;
  AxisValues g92_m_{};
  AxisValues kept_m_{};
  AxisValues tool_m_{};  ///< G43
};

}  // namespace contour
