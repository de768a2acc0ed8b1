#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "control/control_law.h"

namespace contour {

/// By how much a drive that closes its own position loop is inside where the motion bends, learnt on line.
///
/// Interpolating between targets cuts curves by T^2 a / 8 (a uniform quadratic B-spline); a velocity loop
/// that takes its velocity from differences of the position sees it late by some t and, with position gain k,
/// is off by t a / k. What is missing to the wanted position is c a in both cases, with c < 0, and the target
/// gets it in advance. Along with it a constant delay d is fitted, d v - d^2 a / 2, which is not made up for:
/// it is the same for axes that draw a contour together.
class BendCorrection {
 public:
  BendCorrection() noexcept = default;
  explicit BendCorrection(double period_s) noexcept;

  void Reset() noexcept { delay_s_ = share_s2_ = 0.0; }
  /// `error_m`: by how much the motor was short of where it was to be, with the correction in use.
  void Learn(double error_m, double velocity_m_s, double acceleration_m_s2) noexcept;
  [[nodiscard]] double share_s2() const noexcept { return share_s2_; }

 private:
  double rate_ = 0.0;
  double period_s_ = 0.0;
  double delay_s_ = 0.0;
  double share_s2_ = 0.0;
};

/// `full` on a drive that closes its own position loop (CSP): where the motor has to be for the table to be
/// on the path, and the friction it will meet on the way as torque offset (0x60B2).
///
/// Drives that interpolate between targets run half a period behind them: at t(k) the motor is where it was
/// told to be at t(k-1/2), and the offset is the friction for that time. The drive feeds forward the whole
/// mass times the acceleration of its target; of that, what belongs to the table's share of the wind-up's
/// motion is taken back.
///
/// While no axis moves the offset stays what it is, and from then on that of each axis until it moves itself:
/// the drive's integral has made up for the rest, and would have to for every change of it; with the gains
/// that some drives have for an axis at rest it does so in seconds, and until then the axis is pushed away.
class CascadeLaw final : public ControlLaw {
 public:
  CascadeLaw(const PerAxis<ControlledAxis>& axes, double period_s);
  void Reset() noexcept override;
  void Release(std::size_t) noexcept override {}  // the drive's own cascade goes on holding
  void Soften(Softness softness) noexcept override { share_ = OffsetShare(softness); }
  void Step(const ControlInput& input, ControlOutput& output) noexcept override;
  [[nodiscard]] int horizon_points() const noexcept override { return 4; }
  void Keep(StateKeeper& keep) noexcept override;

 private:
  /// Where the motor was to be, without corrections, with the motion of the table there.
  struct Told {
    double position_m = 0.0;
    double velocity_m_s = 0.0;
    double acceleration_m_s2 = 0.0;
  };
  struct Axis {
    BendCorrection bend;
    std::array<Told, 3> told{};  // newest first: for t(k+1), t(k), ...
    std::size_t known = 0;
    double offset_N = 0.0;  ///< sent, but for limits
    double beyond_N = 0.0;  ///< of it, beyond what is foreseen
    bool rests = false;     ///< has stood since no axis moved

    void Keep(StateKeeper& keep) noexcept;
  };

  void Learn(Axis& axis, double position_m) noexcept;
  /// Whether an axis's offset stays: it has stood since no axis moved, in the cycle before, too.
  [[nodiscard]] bool Stays(Axis& axis, const AxisHorizon& reference, bool all_stand) noexcept;
  [[nodiscard]] double Offset_N(Axis& axis, double foreseen_N, bool stays) const noexcept;

  PerAxis<ControlledAxis> axes_;
  double period_s_;
  double fading_;           ///< per period, of what an offset was kept beyond what is foreseen
  double share_ = 1.0;      ///< of the torque offset
  bool some_rest_ = false;  ///< axes that have stood since no axis moved
  std::vector<Axis> states_;
};

}  // namespace contour
