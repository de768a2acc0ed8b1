#include "analysis/diagnosis/causes/parameters.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace contour::diagnosis {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr int kDraws = 400;
constexpr double kTail = 0.025;  // of a 95 % interval, either side

using Named = std::map<std::string, double>;

double Half(const Signal& shape) {
  const auto [low, high] = std::minmax_element(shape.begin(), shape.end());
  return 0.5 * (*high - *low);
}

// The effect's signal over the stroke, on a grid of table positions.
Signal OverStroke(const Problem& problem, const std::vector<double>& a, bool spring,
                  const std::vector<double>& at) {
  const double half = std::max(problem.signals_->half_stroke_m, 1e-9);
  Signal y;
  for (const double x : at) {
    const double u = std::clamp(x / half, -1.0, 1.0);
    double sum = 0.0;
    for (std::size_t j = 0; j < a.size(); ++j)
      sum += a[j] * (spring ? std::legendre(static_cast<unsigned>(j + 1), u)
                            : std::cos(static_cast<double>(j + 1) * std::numbers::pi * 0.5 * (u + 1.0)));
    y.push_back(sum);
  }
  return y;
}

std::vector<double> StrokeGrid(const Problem& problem) {
  std::vector<double> x;
  for (int i = 0; i <= 40; ++i) x.push_back(problem.signals_->half_stroke_m * (-1.0 + 0.05 * i));
  return x;
}

Named Evaluate(const Problem& problem, const Point& point, std::size_t index) {
  const Effect& e = *point.effects[index];
  const std::vector<double>& a = point.amplitudes[index];
  const Signals& s = *problem.signals_;
  const double R = problem.stated_.table_per_q;
  const auto wave = [&](const char* amplitude, const char* order, double scale) {
    Named v{{amplitude, std::hypot(a[0], a[1]) * scale}};
    const double shift = a.size() > 2 ? a[2] : 0.0;
    if (order != nullptr) v[order] = e.order + shift;
    const double phase = std::atan2(a[1], a[0]) - shift * e.middle;
    v["phase_rad"] = std::remainder(phase, kTwoPi);
    return v;
  };
  if (e.kind == "asymmetric_coulomb") {
    Named v{{"difference_rel", a[0]}};
    if (a.size() > 1) v["viscous_difference_rel"] = a[1];
    return v;
  }
  if (e.kind == "constant_torque") return {{"torque_Nm", a[0]}};
  if (e.kind == "stribeck") {
    const AxisModel m = problem.Build(point);
    return {{"Fs_over_Fc", m.friction.Fs_plus / m.friction.Fc_plus}, {"vs_rad_s", m.friction.vs}};
  }
  if (e.kind == "position_friction")
    return {{"amplitude_rel", Half(OverStroke(problem, a, false, StrokeGrid(problem)))}};
  if (e.kind == "cable_spring") {
    const double half = s.half_stroke_m;
    const Signal ends = OverStroke(problem, a, true, {-half, half});
    const double stated = 0.5 * (problem.stated_.stroke_max_m - problem.stated_.stroke_min_m);
    return {{"torque_at_stroke_end_Nm", 0.5 * (ends[0] - ends[1]) * (stated > half ? stated / half : 1.0)}};
  }
  if (e.kind == "friction_ripple" || e.kind == "ball_ripple")
    return wave("amplitude_rel", "order_per_rev", 1.0);
  if (e.kind == "cogging") return wave("amplitude_Nm", "order_per_rev", 1.0);
  if (e.kind == "viscous_nonlinear") {
    Named v{{"torque_at_max_speed_Nm", a[0]}, {"max_speed_rad_s", s.max_speed}};
    if (e.order > 1.0) v["exponent"] = e.order * std::exp(a[1]);
    if (e.order > 0.0 && e.order <= 1.0) v["knee_rad_s"] = e.order * std::exp(a[1]) * s.max_speed;
    return v;
  }
  // The model's coefficient is that of the mean temperature, the rate is stated of the first.
  if (e.kind == "temperature_viscosity")
    return {{"rate_1_K", a[0] / std::max(0.05, 1.0 + a[0] * s.temperature_K.front())}};
  if (e.kind == "friction_drift") {
    const double seconds = problem.log_.period_s * static_cast<double>(problem.rows());
    if (e.order <= 0.0) return {{"change_rel", a[0] / (1.0 - 0.5 * a[0])}};
    const double tau = e.order * std::exp(a[1]);
    return {{"change_rel", a[0] * (1.0 - std::exp(-1.0 / tau)) / (1.0 - 0.5 * a[0])},
            {"time_constant_s", tau * seconds}};
  }
  if (e.kind == "torque_constant") return {{"ratio", 1.0 + a[0]}};
  if (e.kind == "torque_saturation") return {{"loss_at_rated_rel", a[0]}};
  if (e.kind == "payload_step") {
    // The amplitude is a share of the stated inertia; what is told is one of the fitted.
    const AxisModel m = problem.Build(point);
    const AxisModel& stated = problem.nominal_;
    const double fitted = m.motor_inertia + (m.two_inertia ? m.load_inertia : 0.0);
    return {{"inertia_change_rel", a[0] * (stated.motor_inertia + stated.load_inertia) / fitted},
            {"time_s", e.order + a[1]}};
  }
  if (e.kind == "compliance") {
    const AxisModel m = problem.Build(point);
    return {{"antiresonance_Hz", std::sqrt(m.stiffness / std::max(m.load_inertia, 1e-30)) / kTwoPi},
            {"stiffness_Nm_rad", m.stiffness},
            {"damping_ratio", 0.5 * m.damping *
                                  std::sqrt((1.0 / m.motor_inertia + 1.0 / std::max(m.load_inertia, 1e-30)) /
                                            std::max(m.stiffness, 1e-30))}};
  }
  if (e.kind == "backlash") return {{"gap_um", a[0] * R * 1e6}};
  if (e.kind == "presliding_hysteresis") {
    const AxisModel m = problem.Build(point);
    return {{"share_rel", m.soft_share}, {"stiffness_ratio", m.soft_ratio}};
  }
  if (e.kind == "input_delay") return {{"delay_us", a[0] * 1e6}};
  if (e.kind == "current_lag") return {{"time_constant_us", a[0] * 1e6}};
  if (e.kind == "encoder_eccentricity") return wave("amplitude_rad", nullptr, s.angle_per_q);
  if (e.kind == "encoder_subdivision") return wave("amplitude_rad", "order_per_rev", s.angle_per_q);
  if (e.kind == "pitch_error")
    return {{"amplitude_um", 1e6 * Half(OverStroke(problem, a, false, StrokeGrid(problem)))}};
  if (e.kind == "cross_coupling") return {{"torque_per_acceleration_Nms2_m", a[0]}};
  if (e.kind == "load_friction") return {{"friction_per_torque_rel", a[0]}};
  if (e.kind == "periodic_force") return wave("amplitude_Nm", "frequency_Hz", 1.0);
  return {{"amplitude", a.empty() ? 0.0 : a[0]}};
}

void AddShape(const Problem& problem, const Fit& fit, std::size_t index, std::size_t first, Cause& cause) {
  const Effect& e = *fit.point.effects[index];
  const std::vector<double>& a = fit.point.amplitudes[index];
  const bool spring = e.kind == "cable_spring";
  if (!spring && e.kind != "position_friction" && e.kind != "pitch_error") return;
  ShapeTable t;
  t.abscissa = "position_mm";
  t.ordinate = spring ? "torque_Nm" : (e.kind == "pitch_error" ? "error_um" : "friction_rel");
  const double unit = e.kind == "pitch_error" ? 1e6 : 1.0;
  const std::vector<double> grid = StrokeGrid(problem);
  const auto n = static_cast<Eigen::Index>(a.size());
  const Eigen::MatrixXd c =
      fit.covariance.block(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(first), n, n);
  std::vector<Signal> columns;
  for (std::size_t j = 0; j < a.size(); ++j) {
    std::vector<double> one(a.size(), 0.0);
    one[j] = 1.0;
    columns.push_back(OverStroke(problem, one, spring, grid));
  }
  const Signal y = OverStroke(problem, a, spring, grid);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    Eigen::VectorXd v(n);
    for (Eigen::Index j = 0; j < n; ++j) v(j) = columns[static_cast<std::size_t>(j)][i];
    t.x.push_back(1e3 * (grid[i] + problem.signals_->middle_m));
    t.y.push_back(unit * y[i]);
    t.sigma.push_back(unit * std::sqrt(std::max(0.0, v.dot(c * v))));
  }
  cause.shapes.push_back(std::move(t));
}

}  // namespace

std::string MainParameter(const std::string& kind) {
  static const std::map<std::string, std::string> main = {
      {"asymmetric_coulomb", "difference_rel"},
      {"constant_torque", "torque_Nm"},
      {"stribeck", "Fs_over_Fc"},
      {"position_friction", "amplitude_rel"},
      {"cable_spring", "torque_at_stroke_end_Nm"},
      {"friction_ripple", "amplitude_rel"},
      {"ball_ripple", "amplitude_rel"},
      {"cogging", "amplitude_Nm"},
      {"viscous_nonlinear", "torque_at_max_speed_Nm"},
      {"temperature_viscosity", "rate_1_K"},
      {"friction_drift", "change_rel"},
      {"torque_constant", "ratio"},
      {"torque_saturation", "loss_at_rated_rel"},
      {"payload_step", "inertia_change_rel"},
      {"compliance", "antiresonance_Hz"},
      {"backlash", "gap_um"},
      {"presliding_hysteresis", "share_rel"},
      {"input_delay", "delay_us"},
      {"current_lag", "time_constant_us"},
      {"encoder_eccentricity", "amplitude_rad"},
      {"encoder_subdivision", "amplitude_rad"},
      {"pitch_error", "amplitude_um"},
      {"cross_coupling", "torque_per_acceleration_Nms2_m"},
      {"load_friction", "friction_per_torque_rel"},
      {"periodic_force", "amplitude_Nm"},
      {"sample_jitter", "rms_us"}};
  const auto it = main.find(kind);
  return it == main.end() ? "amplitude" : it->second;
}

void DescribeEffect(const Problem& problem, const Fit& fit, std::size_t index, const Eigen::MatrixXd& draws,
                    Cause& cause) {
  std::size_t first = fit.point.base.size();
  for (std::size_t e = 0; e < index; ++e) first += fit.point.amplitudes[e].size();
  std::map<std::string, std::vector<double>> drawn;
  // The whole point is drawn: parameters such as a stiffness depend on the base's values too.
  for (Eigen::Index d = 0; d < draws.cols(); ++d) {
    Point p = Moved(fit.point, draws.col(d));
    p.effects = {p.effects[index]};
    p.amplitudes = {std::vector<double>(p.amplitudes[index])};
    for (const auto& [name, v] : Evaluate(problem, p, 0)) drawn[name].push_back(v);
  }
  const auto count = static_cast<double>(draws.cols());
  for (const auto& [name, v] : Evaluate(problem, fit.point, index)) {
    std::vector<double>& d = drawn[name];
    if (name == "phase_rad")
      for (double& x : d) x = v + std::remainder(x - v, kTwoPi);
    std::sort(d.begin(), d.end());
    const auto tail = static_cast<std::size_t>(count * kTail);
    const double low = d[tail], high = d[d.size() - 1 - tail];
    // A peak of noisy amplitudes is drawn too large on the average: turned over about the value. What is a
    // logarithm in the fit (a Stribeck speed, a stiffness) has its longer side upwards as drawn.
    const bool peak = name.starts_with("amplitude");
    cause.parameters[name] = peak ? Interval{v, 2.0 * v - high, 2.0 * v - low} : Interval{v, low, high};
  }
  AddShape(problem, fit, index, first, cause);
}

void DescribeEffect(const Problem& problem, const Fit& fit, std::size_t index, Cause& cause) {
  const Eigen::Index n = fit.covariance.rows();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 *
                                                             (fit.covariance + fit.covariance.transpose()));
  const Eigen::MatrixXd root =
      eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  std::mt19937_64 random(20240229);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd draws(n, kDraws);
  for (Eigen::Index d = 0; d < kDraws; ++d) {
    for (Eigen::Index i = 0; i < n; ++i) draws(i, d) = normal(random);
    draws.col(d) = (root * draws.col(d)).eval();
  }
  DescribeEffect(problem, fit, index, draws, cause);
}

}  // namespace contour::diagnosis
