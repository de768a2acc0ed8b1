#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "control/control_config.h"
#include "control/standstill.h"
#include "core/axis.h"
#include "core/controller_name.h"
#include "core/horizon.h"
#include "core/mechanics.h"
#include "core/reason.h"
#include "core/two_inertia_loop.h"

namespace contour {

enum class ControllerKind : std::uint8_t { kPid, kCsp, kMpc, kCnc };

/// What a named controller is made of on the control side.
struct ControllerOptions {
  ControllerKind kind = ControllerKind::kMpc;
  bool friction_feedforward = false;  ///< add the FrictionPreview to the force
  bool windup_compensation =
      false;            ///< lead the motor by the screw's wind-up, so that the table is on the path
  double softer = 1.0;  ///< bandwidth of the softened loop, as a share of its own
};

/// How much of what it could do a controller uses; see control/supervision_ladder.h.
enum class Softness : std::uint8_t {
  kNone,
  kSofter,   ///< lower bandwidth; where the drive closes the loop, half the torque offset
  kWithout,  ///< the same; where the drive closes the loop, no torque offset
};

constexpr ControllerOptions OptionsFor(ControllerName name) noexcept {
  switch (name) {
    case ControllerName::kPid:
      return {ControllerKind::kPid, false, false};
    case ControllerName::kCsp:
      return {ControllerKind::kCsp, false, false};
    case ControllerName::kCnc:
      return {ControllerKind::kCnc, false, false};
    case ControllerName::kMpc:
      return {ControllerKind::kMpc, false, false};
    case ControllerName::kMpcObserver:
    case ControllerName::kMpcSrukf4:
    case ControllerName::kMpcEkf7:
    case ControllerName::kMpcSrukf7:
      return {ControllerKind::kMpc, true, false};
    case ControllerName::kFull:
      break;
  }
  return {ControllerKind::kMpc, true, true};
}

/// The tuning of a controller that uses the MPC; that of `full` for those that do not.
const MpcConfig& MpcConfigFor(const ControllerConfig& config, ControllerName name) noexcept;

/// What the controller knows of one axis, fixed at construction.
struct ControlledAxis {
  Mechanics mechanics;
  AxisLimitsSi limits;
  double lag_s = 0.0;         ///< first-order lag of the drive's current loop
  double viscous_Ns_m = 0.0;  ///< sigma2, for controllers without a friction preview
  // For `cnc`, which compensates reversals by fixed numbers:
  double coulomb_plus_N = 0.0;
  double coulomb_minus_N = 0.0;
  double presliding_m = 0.0;  ///< travel after which friction is sliding: Fc / sigma0
  /// The axis as two inertias and the loop around it, where it has one, and that of the softened machine.
  std::optional<TwoInertiaLoop> loop = std::nullopt, softer_loop = std::nullopt;
  double regulator_Hz = 0.0;  ///< of that loop
  /// Of the torque of acceleration, what a drive that closes the loop itself has to be given.
  double acceleration_share = 0.0;
  /// The same two with the linear scale, where it is in the loop.
  std::optional<TwoInertiaLoop> scale_loop = std::nullopt, softer_scale_loop = std::nullopt;
  StandstillBounds standstill{};  ///< how it is held at rest
};

/// Forces that act on an axis whatever it does, positive towards positive position: a weight, a cable.
struct StatedForces {
  double motor_N = 0.0;  ///< before the screw
  double table_N = 0.0;  ///< behind it, which winds it up
};

/// Everything the controller sees of one cycle; see core/horizon.h for the time indices.
struct ControlInput {
  PerAxis<AxisEstimate> estimate;
  PerAxis<AxisHorizon> reference;
  PerAxis<AxisHorizon> planned;       ///< what Plan() made of it; empty: the reference itself is followed
  PerAxis<FrictionPreview> friction;  ///< total friction along what is followed; empty: none known
  PerAxis<StatedForces> stated;       ///< as the model has them, of axes that a spring holds
  PerAxis<double> previous_force_N;   ///< u(k-1), the command that acts now, after the guard
  std::uint32_t skipped = 0;          ///< periods just before this one in which nothing was sent
};

/// Forces at the table, N = torque / R.
struct ControlOutput {
  PerAxis<double> force_N;            ///< wanted over [t(k), t(k+1)), within the limits
  PerAxis<double> feedforward_N;      ///< the part of it that comes from the reference and the friction ahead
  PerAxis<double> target_position_m;  ///< motor side, for t(k+1); what a drive in CSP is sent
  PerAxis<Reason> limit;              ///< kTorqueLimit, kTorqueRateLimit or kSolverCap; kNone
  int iterations = 0;                 ///< of the solver, all axes
};

/// What the controller follows, and along which friction is to be expected.
inline const PerAxis<AxisHorizon>& Reference(const ControlInput& input) noexcept {
  return input.planned.empty() ? input.reference : input.planned;
}

class ControlLaw;
class StateKeeper;
class ReferencePlanner;
class SpringLaw;

/// Reference and estimate in, force out. Throws std::invalid_argument at construction only.
class ContourController {
 public:
  /// `cascade`: the drives close the position loop themselves; matters to `full` only.
  ContourController(ControllerName name, const ControllerConfig& config, const PerAxis<ControlledAxis>& axes,
                    double period_s, bool cascade = false);
  ~ContourController();
  ContourController(ContourController&&) noexcept;
  ContourController& operator=(ContourController&&) noexcept;

  /// Forgets integrators, warm starts and the last command. To be called when the axes are enabled.
  void Reset() noexcept;
  /// In this cycle an experiment's spring holds the axis: SpringLaw, or the law itself where it can
  /// (ControlLaw::holds_springs). In CSP the drive itself holds it, and goes on doing so.
  [[nodiscard]] bool HoldsBySpring(const ControlInput& input, std::size_t axis) const noexcept;
  /// From the next Step on. The force may jump by what the gains differ: the caller blends it.
  void Soften(Softness softness) noexcept;
  /// Fills input.planned from input.reference: the same, or what the torque allows of it at corners. To be
  /// called once per cycle before Step, and before the friction ahead is asked for. `follow` false: nothing
  /// is moving by this controller (axes not enabled), the reference is taken as it is. Step works without it,
  /// too.
  void Plan(ControlInput& input, bool follow) noexcept;
  void Step(const ControlInput& input, ControlOutput& output) noexcept;
  /// Instead of Step while nothing may move: no force, no computing. The next Step is as after Reset.
  void Rest(ControlOutput& output) noexcept;

  [[nodiscard]] const ControllerOptions& options() const noexcept { return options_; }
  void Keep(StateKeeper& keep) noexcept;
  /// Bandwidth of a rigid axis held as stiffly as by these gains, Hz, or by the softened ones; see
  /// control/loop_bandwidth.h.
  [[nodiscard]] double loop_Hz(bool softened) const noexcept { return softened ? soft_loop_Hz_ : loop_Hz_; }

  /// Points of the reference that Plan and Step look at; what lies beyond is ignored.
  [[nodiscard]] std::size_t horizon_points() const noexcept;
  /// Points of the friction ahead that Step looks at.
  [[nodiscard]] std::size_t friction_points() const noexcept;

 private:
  ControllerOptions options_;
  double loop_Hz_;
  double soft_loop_Hz_;
  std::unique_ptr<ControlLaw> law_;
  std::unique_ptr<ReferencePlanner> planner_;  ///< none: nothing is planned
  std::unique_ptr<SpringLaw> springs_;         ///< none: the drives hold the axes
};

}  // namespace contour
