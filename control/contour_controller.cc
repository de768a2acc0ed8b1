#include "control/contour_controller.h"

#include <stdexcept>

#include "control/csp_law.h"
#include "control/mpc_law.h"
#include "control/pid_law.h"

namespace contour {
namespace {

std::unique_ptr<ControlLaw> MakeLaw(ControllerName name, const ControllerConfig& config,
                                    const PerAxis<ControlledAxis>& axes, double period_s) {
  const ControllerOptions options = OptionsFor(name);
  switch (options.kind) {
    case ControllerKind::kPid:
      return std::make_unique<PidLaw>(config.pid, options, axes, period_s);
    case ControllerKind::kCsp:
      return std::make_unique<CspLaw>(config.csp, options, axes, period_s);
    case ControllerKind::kMpc:
      break;
  }
  return std::make_unique<MpcLaw>(MpcConfigFor(config, name), options, axes, period_s);
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
      break;
  }
  return config.full;
}

ContourController::ContourController(ControllerName name, const ControllerConfig& config,
                                     const PerAxis<ControlledAxis>& axes, double period_s)
    : options_(OptionsFor(name)) {
  if (axes.empty()) throw std::invalid_argument("controller: there is no axis");
  if (!(period_s > 0.0)) throw std::invalid_argument("controller: the period must be positive");
  law_ = MakeLaw(name, config, axes, period_s);
}

ContourController::~ContourController() = default;
ContourController::ContourController(ContourController&&) noexcept = default;
ContourController& ContourController::operator=(ContourController&&) noexcept = default;

void ContourController::Reset() noexcept { law_->Reset(); }

void ContourController::Step(const ControlInput& input, ControlOutput& output) noexcept {
  const std::size_t axes = input.estimate.size();
  output.force_N.resize(axes);
  output.feedforward_N.resize(axes);
  output.target_position_m.resize(axes);
  output.limit.resize(axes);
  law_->Step(input, output);
}

int ContourController::horizon_points() const noexcept { return law_->horizon_points(); }

}  // namespace contour
