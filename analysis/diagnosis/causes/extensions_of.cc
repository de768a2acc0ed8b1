#include "analysis/diagnosis/causes/extensions_of.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>

#include "analysis/axis_model/stated_axis.h"

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

/// A wave beside those that are there; of the same order, their sum.
template <class Extension, class Wave>
void AddWave(std::optional<Extension>& to, double Wave::*amplitude, const Wave& wave) {
  if (!to) {
    to.emplace();
    static_cast<Wave&>(*to) = wave;
    return;
  }
  std::vector<Wave*> all = {&*to};
  for (Wave& w : to->further) all.push_back(&w);
  for (Wave* w : all) {
    if (std::abs(w->order_per_rev - wave.order_per_rev) > 1e-9) continue;
    const std::complex<double> sum =
        std::polar(w->*amplitude, w->phase_rad) + std::polar(wave.*amplitude, wave.phase_rad);
    w->*amplitude = std::abs(sum);
    w->phase_rad = std::arg(sum);
    return;
  }
  to->further.push_back(wave);
}

void AddRipple(const Cause& c, std::optional<RippleExtension>& to) {
  AddWave(to, &RippleWave::amplitude_rel,
          RippleWave{Value(c, "amplitude_rel"), Value(c, "order_per_rev", 1.0), Value(c, "phase_rad")});
}

/// The shape joined to the table that is there, at the points of both.
template <class F>
void AddTable(const ShapeTable& shape, F&& join, std::vector<double>& x, std::vector<double>& y) {
  const std::vector<double> own_x = Rounded(shape.x), own_y = Rounded(shape.y);
  if (x.empty()) {
    x = own_x;
    y = own_y;
    return;
  }
  const std::vector<double> old_x = x, old_y = y;
  x.insert(x.end(), own_x.begin(), own_x.end());
  std::sort(x.begin(), x.end());
  x.erase(std::unique(x.begin(), x.end()), x.end());
  y.clear();
  for (const double at : x) y.push_back(Rounded(join(ValueAt(old_x, old_y, at), ValueAt(own_x, own_y, at))));
}

double HalfRange(const std::vector<double>& y) {
  const auto [low, high] = std::minmax_element(y.begin(), y.end());
  return 0.5 * (*high - *low);
}

/// Both rates about one temperature: r (T - T0) = r1 (T - T1) + r2 (T - T2).
void AddRate(double rate_1_K, double reference_degC, std::optional<TemperatureViscosityExtension>& to) {
  if (!to) to = TemperatureViscosityExtension{0.0, reference_degC};
  const double sum_1_K = to->rate_1_K + rate_1_K;
  if (std::abs(sum_1_K) > 1e-6)
    to->reference_degC =
        std::clamp((to->rate_1_K * to->reference_degC + rate_1_K * reference_degC) / sum_1_K, -50.0, 150.0);
  to->rate_1_K = sum_1_K;
}

template <class T>
T& Existing(std::optional<T>& e) {
  return e ? *e : e.emplace();
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
  const auto sum = [](double a, double b) { return a + b; };
  const auto factor = [](double a, double b) { return (1.0 + a) * (1.0 + b) - 1.0; };
  for (const Cause& c : causes) {
    const ShapeTable* shape = Shape(c);
    if (c.kind == "asymmetric_coulomb") {
      // Factors 1 + d / 2 and 1 - d / 2, twice: the difference of the products over their mean.
      double& d = Existing(e.asymmetric_coulomb).difference_rel;
      const double by = Value(c, "difference_rel");
      d = (d + by) / (1.0 + 0.25 * d * by);
    }
    if (c.kind == "constant_torque") Existing(e.constant_torque).torque_Nm += Value(c, "torque_Nm");
    if (c.kind == "stribeck")
      e.stribeck = {std::max(1.0, Value(c, "Fs_over_Fc", 1.0)), Value(c, "vs_rad_s", 1.0)};
    if (c.kind == "position_friction" && shape != nullptr) {
      PositionFrictionExtension& table = Existing(e.position_friction);
      AddTable(*shape, factor, table.position_mm, table.friction_rel);
      table.amplitude_rel = HalfRange(table.friction_rel);
    }
    if (c.kind == "cable_spring" && shape != nullptr) {
      CableSpringExtension& table = Existing(e.cable_spring);
      AddTable(*shape, sum, table.position_mm, table.torque_Nm);
      table.torque_at_stroke_end_Nm += Value(c, "torque_at_stroke_end_Nm");
    }
    if (c.kind == "pitch_error" && shape != nullptr) {
      PitchErrorExtension& table = Existing(e.pitch_error);
      AddTable(*shape, sum, table.position_mm, table.error_um);
      table.amplitude_um = HalfRange(table.error_um);
    }
    if (c.kind == "friction_ripple") AddRipple(c, e.friction_ripple);
    if (c.kind == "ball_ripple") AddRipple(c, e.ball_ripple);
    if (c.kind == "cogging")
      AddWave(e.cogging, &CoggingWave::amplitude_Nm,
              CoggingWave{Value(c, "amplitude_Nm"), Value(c, "order_per_rev", 1.0), Value(c, "phase_rad")});
    if (c.kind == "viscous_nonlinear") {
      const ViscousCurve curve = {Value(c, "torque_at_max_speed_Nm"), Value(c, "max_speed_rad_s", 1.0),
                                  Value(c, "exponent", 2.0), Value(c, "knee_rad_s")};
      if (e.viscous_nonlinear)
        e.viscous_nonlinear->further.push_back(curve);
      else
        static_cast<ViscousCurve&>(e.viscous_nonlinear.emplace()) = curve;
    }
    if (c.kind == "temperature_viscosity")
      AddRate(Value(c, "rate_1_K"), first_temperature_degC, e.temperature_viscosity);
    if (c.kind == "torque_constant") Existing(e.torque_constant).ratio *= Value(c, "ratio", 1.0);
    if (c.kind == "compliance" && Value(c, "stiffness_Nm_rad") > 0.0)
      e.compliance = {Value(c, "antiresonance_Hz"), Value(c, "stiffness_Nm_rad"),
                      std::clamp(Value(c, "damping_ratio"), 0.0, 2.0)};
    if (c.kind == "input_delay") Existing(e.input_delay).delay_us += Value(c, "delay_us");
    if (c.kind == "current_lag") Existing(e.current_lag).time_constant_us += Value(c, "time_constant_us");
  }
}

LogTemperature TemperatureOf(const AxisLog& log) {
  LogTemperature out;
  bool any = false;
  for (const double t : log.temperature_degC) {
    if (std::isnan(t)) continue;
    if (!any) out = {t, t};
    any = true;
    if (std::abs(t - out.first_degC) > std::abs(out.farthest_degC - out.first_degC)) out.farthest_degC = t;
  }
  return out;
}

}  // namespace contour::diagnosis
