#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "control/control_law.h"
#include "control/flat_feedforward.h"
#include "control/standstill.h"
#include "core/spring_loop.h"
#include "core/two_inertia_loop.h"

namespace contour {

/// `full` with a loop that knows two inertias: the flat feed-forward of motor and table, and the regulator of
/// TwoInertiaLoop on what the axis is off by from where it leads. The regulator acts on deviations, so
/// friction along the reference is no part of it; what the observer finds beyond is answered at once. An
/// experiment's spring is this loop, weaker (core/spring_loop.h).
/// Each axis on its own.
class TwoInertiaLaw final : public ControlLaw {
 public:
  /// Throws std::invalid_argument when an axis has no loop.
  TwoInertiaLaw(const PerAxis<ControlledAxis>& axes, const ControllerOptions& options, double period_s);
  void Reset() noexcept override;
  void Release(std::size_t axis) noexcept override { axes_[axis].Forget(); }
  void Soften(Softness softness) noexcept override { softer_ = softness != Softness::kNone; }
  void Step(const ControlInput& input, ControlOutput& output) noexcept override;
  [[nodiscard]] bool holds_springs() const noexcept override { return true; }
  [[nodiscard]] int horizon_points() const noexcept override { return horizon_points_; }
  void Keep(StateKeeper& keep) noexcept override { keep(axes_, softer_, lasts_periods_); }

 private:
  using Commands = std::array<double, kLoopQueue + 1>;  ///< newest first

  struct Axis {
    Axis(const ControlledAxis& axis, const ControllerOptions& options, double period_s);
    void Forget() noexcept;
    void Keep(StateKeeper& keep) noexcept {
      keep(planned_N, grid_N, sent_N, led_N, wound_m, lead_m, slow_N, filter, standstill, steps, by_scale,
           left_N, sprung);
    }

    /// What the regulator makes of where motion and commands under way are off what was planned.
    [[nodiscard]] double Deviation_N(const TwoInertiaLoop& loop, const LoopMotion& motion,
                                     const LoopMotion& wanted, const SpringShares& share) const noexcept;

    [[nodiscard]] const TwoInertiaLoop& Loop(bool scaled, bool soft) const noexcept {
      if (scaled && scale) return soft ? *softer_scale : *scale;
      return soft ? softer : own;
    }

    TwoInertiaLoop own, softer;
    std::optional<TwoInertiaLoop> scale, softer_scale;
    FlatFeedforward feedforward;
    Mechanics mechanics;
    double force_limit_N;
    double left_kept;      ///< of left_N, per cycle
    double lag_kept;       ///< of the drive's lag over a period, or what of it is left of a dead time
    double lag_kept_late;  ///< over the part of a period that is dead time
    double slow_share;     ///< of the disturbance that a softened loop answers

    Commands planned_N{};  ///< feed-forward
    Commands grid_N{};     ///< the same before a dead time of part of a period was allowed for
    Commands sent_N{};     ///< what became of it
    double led_N = 0.0;    ///< what the motor gives by the feed-forward at the sample
    double wound_m = 0.0;  ///< wind-up that was planned at the sample before
    double lead_m = 0.0;   ///< lead beside it, there
    double slow_N = 0.0;
    std::array<double, 4> filter{};  ///< x(j-1), x(j-2), y(j-1), y(j-2)
    Standstill standstill;
    int steps = 0;          ///< since it was forgotten, as far as they matter
    bool by_scale = false;  ///< at the sample before
    double left_N = 0.0;    ///< what leaving the scale must not make of the force, fading away
    bool sprung = false;    ///< held by a spring at the sample before
  };

  void Advance(Axis& axis, double sent_N) const noexcept;
  void CatchUp(const ControlInput& input) noexcept;
  double Feedforward_N(Axis& axis, const AxisHorizon& reference, const FrictionPreview& friction,
                       double& target_m) const noexcept;
  LoopMotion Wanted(Axis& axis, const AxisHorizon& reference, const FrictionPreview& friction,
                    bool by_scale) const noexcept;
  /// The loop without the scale takes over, from the force that acts.
  void LeaveScale(Axis& axis, double force_N) const noexcept;
  double Feedback_N(Axis& axis, const LoopMotion& wanted, const AxisEstimate& estimate,
                    bool begins) const noexcept;
  /// An axis that an experiment's spring holds: against what it is off by, and what is put on is no
  /// deviation.
  void Spring(std::size_t axis, const ControlInput& input, ControlOutput& output) noexcept;

  std::vector<Axis> axes_;
  double period_s_;
  double lasts_kept_;           ///< per cycle
  double lasts_periods_ = 1.0;  ///< that commands lately had to last for
  int horizon_points_ = 0;
  bool softer_ = false;
};

}  // namespace contour
