#include "analysis/diagnosis/quantification/widen.h"

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "analysis/diagnosis/screening/score.h"
#include "analysis/prediction_error/common_factor.h"

namespace contour::diagnosis {
namespace {

// Relative error of the model, one standard deviation: how far sizes lay off beyond their scatter on recorded
// machines of known size (docs/diagnosis_results.md).
const std::map<std::pair<std::string, std::string>, double> kModelError = {
    {{"asymmetric_coulomb", "difference_rel"}, 0.02},
    {{"backlash", "gap_um"}, 0.08},
    {{"compliance", "antiresonance_Hz"}, 0.015},
    {{"compliance", "stiffness_Nm_rad"}, 0.05},
    {{"cross_coupling", "torque_per_acceleration_Nms2_m"}, 0.02},
    {{"encoder_subdivision", "amplitude_rad"}, 0.001},
    {{"friction_drift", "change_rel"}, 0.03},
    {{"friction_ripple", "amplitude_rel"}, 0.01},
    {{"load_friction", "friction_per_torque_rel"}, 0.02},
    {{"payload_step", "inertia_change_rel"}, 0.01},
    {{"position_friction", "amplitude_rel"}, 0.04},
    {{"presliding_hysteresis", "share_rel"}, 0.02},
    {{"sample_jitter", "rms_us"}, 0.01},
    {{"stribeck", "Fs_over_Fc"}, 0.01},
    {{"stribeck", "vs_rad_s"}, 0.1},
    {{"temperature_viscosity", "rate_1_K"}, 0.03},
    {{"torque_saturation", "loss_at_rated_rel"}, 0.01},
    {{"viscous_nonlinear", "torque_at_max_speed_Nm"}, 0.07},
};

}  // namespace

void WidenIntervals(const Problem& problem, const Point& point, Cause& cause) {
  for (auto& [name, interval] : cause.parameters) {
    const auto known = kModelError.find({cause.kind, name});
    double sigma = known == kModelError.end() ? 0.0 : known->second;
    // All forces against the torque: the log itself says nothing about it.
    if (cause.kind == "torque_constant") sigma = FindCommonFactor(problem, point).sigma;
    const double by = 1.96 * sigma * std::fabs(interval.value);
    interval.low = interval.value - std::hypot(interval.value - interval.low, by);
    interval.high = interval.value + std::hypot(interval.high - interval.value, by);
  }
}

}  // namespace contour::diagnosis
