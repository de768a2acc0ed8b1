#include "control/contour_controller.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "control/cascade_law.h"
#include "control/cnc_law.h"
#include "control/csp_law.h"
#include "control/loop_bandwidth.h"
#include "control/mpc_law.h"
#include "control/pid_law.h"
#include "control/reference_planner.h"
#include "control/spring_law.h"
#include "control/two_inertia_law.h"
#include "core/state_keeper.h"

namespace contour {
namespace {

std::unique_ptr<ControlLaw> MakeLaw(ControllerName name, const ControllerConfig& config,
                                    const PerAxis<ControlledAxis>& axes, double period_s, bool cascade) {
  ControllerOptions options = OptionsFor(name);
  options.softer = config.supervision.softer;
  switch (options.kind) {
    case ControllerKind::kPid:
      return std::make_unique<PidLaw>(config.pid, options, axes, period_s);
    case ControllerKind::kCsp:
      return std::make_unique<CspLaw>(config.csp, options, axes, period_s);
    case ControllerKind::kCnc:
      return std::make_unique<CncLaw>(config.cnc, axes, period_s);
    case ControllerKind::kMpc:
      break;
  }
  if (name == ControllerName::kFull && cascade) return std::make_unique<CascadeLaw>(axes, period_s);
  if (KnowsTwoInertias(name, config.friction))
    return std::make_unique<TwoInertiaLaw>(axes, options, period_s);
  return std::make_unique<MpcLaw>(MpcConfigFor(config, name), options, axes, period_s);
}

double Loop_Hz(ControllerName name, const ControllerConfig& config, const PerAxis<ControlledAxis>& axes,
               bool cascade) noexcept {
  double least_Hz = std::numeric_limits<double>::infinity();
  for (const ControlledAxis& axis : axes)
    if (axis.loop) least_Hz = std::min(least_Hz, axis.regulator_Hz);
  return StiffnessInUse_Hz(config, name, cascade, least_Hz);
}

}  // namespace

const MpcConfig& MpcConfigFor(const ControllerConfig& config, ControllerName name) noexcept {
  switch (name) {
    case ControllerName::kMpc:
      return config.mpc;
    case ControllerName::kMpcObserver:
      return config.mpc_observer;
    case ControllerName::kMpcSrukf4:
      return config.mpc_srukf4;
    case ControllerName::kMpcEkf7:
      return config.mpc_ekf7;
    case ControllerName::kMpcSrukf7:
      return config.mpc_srukf7;
    case ControllerName::kPid:
    case ControllerName::kCsp:
    case ControllerName::kFull:
    case ControllerName::kCnc:
      break;
  }
  return config.full;
}

ContourController::ContourController(ControllerName name, const ControllerConfig& config,
                                     const PerAxis<ControlledAxis>& axes, double period_s, bool cascade)
    : options_(OptionsFor(name)),
      loop_Hz_(Loop_Hz(name, config, axes, cascade)),
      // A drive's own loop is not ours to soften.
      soft_loop_Hz_(cascade ? loop_Hz_ : config.supervision.softer * loop_Hz_) {
  if (axes.empty()) throw std::invalid_argument("controller: there is no axis");
  if (!(period_s > 0.0)) throw std::invalid_argument("controller: the period must be positive");
  law_ = MakeLaw(name, config, axes, period_s, cascade);
  if (!cascade) springs_ = std::make_unique<SpringLaw>(axes);
  if (name == ControllerName::kFull && config.planner.enabled) {
    planner_ = std::make_unique<ReferencePlanner>(config.planner, axes, period_s);
  }
}

ContourController::~ContourController() = default;
ContourController::ContourController(ContourController&&) noexcept = default;
ContourController& ContourController::operator=(ContourController&&) noexcept = default;

void ContourController::Reset() noexcept {
  law_->Reset();
  if (planner_) planner_->Reset();
}

bool ContourController::HoldsBySpring(const ControlInput& input, std::size_t axis) const noexcept {
  return springs_ != nullptr && SpringLaw::Holds(input, axis);
}

void ContourController::Soften(Softness softness) noexcept { law_->Soften(softness); }

void ContourController::Plan(ControlInput& input, bool follow) noexcept {
  if (!planner_) {
    input.planned.clear();
    return;
  }
  if (!follow) planner_->Reset();
  planner_->Plan(input.reference, input.planned);
}

void ContourController::Step(const ControlInput& input, ControlOutput& output) noexcept {
  const std::size_t axes = input.estimate.size();
  output.force_N.resize(axes);
  output.feedforward_N.resize(axes);
  output.target_position_m.resize(axes);
  output.limit.resize(axes);
  law_->Step(input, output);
  for (std::size_t axis = 0; axis < axes; ++axis) {
    if (!HoldsBySpring(input, axis) || law_->holds_springs()) continue;
    springs_->Step(axis, input, output);
    law_->Release(axis);
  }
}

void ContourController::Keep(StateKeeper& keep) noexcept { keep(law_, planner_); }

void ContourController::Rest(ControlOutput& output) noexcept {
  law_->Reset();
  for (double& force : output.force_N) force = 0.0;
  for (double& force : output.feedforward_N) force = 0.0;
  for (Reason& limit : output.limit) limit = Reason::kNone;
  output.iterations = 0;
}

std::size_t ContourController::horizon_points() const noexcept {
  const std::size_t planned = planner_ ? static_cast<std::size_t>(planner_->horizon_points()) : 0;
  // Friction is a mean over the period up to the point after.
  return std::max(friction_points() + 1, planned);
}

std::size_t ContourController::friction_points() const noexcept {
  return static_cast<std::size_t>(law_->horizon_points());
}

}  // namespace contour
