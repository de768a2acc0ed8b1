#include "tools/diagnosis/files/extensions_of.h"

#include <algorithm>
#include <cmath>

namespace contour::diagnosis {
namespace {

double Value(const Cause& cause, const std::string& name, double otherwise = 0.0) {
  const auto at = cause.parameters.find(name);
  return at == cause.parameters.end() || !std::isfinite(at->second.value) ? otherwise : at->second.value;
}

/// The table over the stroke, thinned to what a person can read.
const ShapeTable* Shape(const Cause& cause) {
  for (const ShapeTable& t : cause.shapes)
    if (t.abscissa == "position_mm" && !t.x.empty()) return &t;
  return nullptr;
}

double Rounded(double x) { return std::round(x * 1e6) / 1e6; }
std::vector<double> Rounded(std::vector<double> values) {
  for (double& v : values) v = Rounded(v);
  return values;
}

RippleExtension Ripple(const Cause& c) {
  return {Value(c, "amplitude_rel"), Value(c, "order_per_rev", 1.0), Value(c, "phase_rad")};
}

}  // namespace

bool CanExtend(const std::string& kind) {
  static const std::vector<std::string> kinds = {
      "asymmetric_coulomb", "constant_torque", "stribeck",    "position_friction", "cable_spring",
      "friction_ripple",    "ball_ripple",     "cogging",     "viscous_nonlinear", "temperature_viscosity",
      "torque_constant",    "compliance",      "input_delay", "current_lag",       "pitch_error"};
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

void AddCauses(const std::vector<Cause>& causes, double first_temperature_degC, ExtensionsConfig& e) {
  for (const Cause& c : causes) {
    const ShapeTable* shape = Shape(c);
    if (c.kind == "asymmetric_coulomb") e.asymmetric_coulomb = {Value(c, "difference_rel")};
    if (c.kind == "constant_torque") e.constant_torque = {Value(c, "torque_Nm")};
    if (c.kind == "stribeck")
      e.stribeck = {std::max(1.0, Value(c, "Fs_over_Fc", 1.0)), Value(c, "vs_rad_s", 1.0)};
    if (c.kind == "position_friction" && shape != nullptr)
      e.position_friction = {Value(c, "amplitude_rel"), Rounded(shape->x), Rounded(shape->y)};
    if (c.kind == "cable_spring" && shape != nullptr)
      e.cable_spring = {Value(c, "torque_at_stroke_end_Nm"), Rounded(shape->x), Rounded(shape->y)};
    if (c.kind == "pitch_error" && shape != nullptr)
      e.pitch_error = {Value(c, "amplitude_um"), Rounded(shape->x), Rounded(shape->y)};
    if (c.kind == "friction_ripple") e.friction_ripple = Ripple(c);
    if (c.kind == "ball_ripple") e.ball_ripple = Ripple(c);
    if (c.kind == "cogging")
      e.cogging = {Value(c, "amplitude_Nm"), Value(c, "order_per_rev", 1.0), Value(c, "phase_rad")};
    if (c.kind == "viscous_nonlinear")
      e.viscous_nonlinear = {Value(c, "torque_at_max_speed_Nm"), Value(c, "max_speed_rad_s", 1.0),
                             Value(c, "exponent", 2.0), Value(c, "knee_rad_s")};
    if (c.kind == "temperature_viscosity")
      e.temperature_viscosity = {Value(c, "rate_1_K"), first_temperature_degC};
    if (c.kind == "torque_constant") e.torque_constant = {Value(c, "ratio", 1.0)};
    if (c.kind == "compliance" && Value(c, "stiffness_Nm_rad") > 0.0)
      e.compliance = {Value(c, "antiresonance_Hz"), Value(c, "stiffness_Nm_rad"),
                      std::clamp(Value(c, "damping_ratio"), 0.0, 2.0)};
    if (c.kind == "input_delay") e.input_delay = {Value(c, "delay_us")};
    if (c.kind == "current_lag") e.current_lag = {Value(c, "time_constant_us")};
  }
}

double FirstTemperature_degC(const AxisLog& log) {
  for (const double t : log.temperature_degC)
    if (!std::isnan(t)) return t;
  return 20.0;
}

}  // namespace contour::diagnosis
