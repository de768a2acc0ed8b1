#include "analysis/prediction_error/signals.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/prediction_error/outlier_rows.h"
#include "analysis/prediction_error/stands_out.h"

namespace contour::diagnosis {
namespace {

Signal Convolve(const Signal& x, const std::vector<double>& kernel) {
  const auto n = static_cast<std::ptrdiff_t>(x.size());
  const auto half = static_cast<std::ptrdiff_t>(kernel.size() / 2);
  Signal y(x.size());
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    double sum = 0.0;
    if (k >= half && k + half < n) {
      const double* p = &x[static_cast<std::size_t>(k - half)];
      for (std::size_t i = 0; i < kernel.size(); ++i) sum += kernel[i] * p[i];
    } else {
      for (std::ptrdiff_t i = -half; i <= half; ++i)
        sum += kernel[static_cast<std::size_t>(i + half)] *
               x[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k + i, 0, n - 1))];
    }
    y[static_cast<std::size_t>(k)] = sum;
  }
  return y;
}

std::vector<double> Gaussian(double sigma) {
  const int half = std::max(1, static_cast<int>(std::ceil(4.0 * sigma)));
  std::vector<double> g;
  double sum = 0.0;
  for (int i = -half; i <= half; ++i) {
    g.push_back(std::exp(-0.5 * i * i / (sigma * sigma)));
    sum += g.back();
  }
  for (double& v : g) v /= sum;
  return g;
}

Signal Filled(const Signal& x) {
  Signal y = x;
  std::size_t last = 0;
  bool any = false;
  for (std::size_t k = 0; k < y.size(); ++k) {
    if (!std::isfinite(y[k])) continue;
    if (!any)
      std::fill(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(k), y[k]);
    else
      for (std::size_t i = last + 1; i < k; ++i)
        y[i] = y[last] + (y[k] - y[last]) * static_cast<double>(i - last) / static_cast<double>(k - last);
    any = true;
    last = k;
  }
  for (std::size_t i = last + 1; any && i < y.size(); ++i) y[i] = y[last];
  if (!any) std::fill(y.begin(), y.end(), 0.0);
  return y;
}

}  // namespace

Signal Smooth(const Signal& x, double sigma_rows) { return Convolve(x, Gaussian(sigma_rows)); }

Signal Derivative(const Signal& x, double sigma_rows, double period_s) {
  std::vector<double> g = Gaussian(sigma_rows);
  const auto half = static_cast<std::ptrdiff_t>(g.size() / 2);
  double moment = 0.0;
  for (std::ptrdiff_t i = -half; i <= half; ++i) {
    g[static_cast<std::size_t>(i + half)] *= static_cast<double>(i);
    moment += g[static_cast<std::size_t>(i + half)] * static_cast<double>(i);
  }
  for (double& v : g) v /= moment * period_s;
  return Convolve(x, g);
}

namespace {

/// What changes in many rows only: smoothed means of a tenth of the width each, straight lines between.
Signal SmoothSlow(const Signal& x, double sigma_rows) {
  constexpr double kPerSigma = 10.0;
  const std::size_t n = x.size(),
                    each = std::max<std::size_t>(1, static_cast<std::size_t>(sigma_rows / kPerSigma));
  Signal means;
  for (std::size_t from = 0; from < n; from += each) {
    const std::size_t to = std::min(n, from + each);
    double sum = 0.0;
    for (std::size_t k = from; k < to; ++k) sum += x[k];
    means.push_back(sum / static_cast<double>(to - from));
  }
  const Signal smooth = Smooth(means, sigma_rows / static_cast<double>(each));
  Signal out(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double at = std::clamp((static_cast<double>(k) + 0.5) / static_cast<double>(each) - 0.5, 0.0,
                                 static_cast<double>(smooth.size() - 1));
    const auto i = std::min(static_cast<std::size_t>(at), smooth.size() - 1);
    const double next = smooth[std::min(i + 1, smooth.size() - 1)];
    out[k] = smooth[i] + (at - static_cast<double>(i)) * (next - smooth[i]);
  }
  return out;
}

}  // namespace

namespace {

/// Every stretch between gaps on its own: nothing moves in a gap.
template <class F>
Signal PerStretch(const Signal& x, const std::vector<std::size_t>& begins, F&& of) {
  if (begins.size() < 2) return of(x);
  Signal out;
  out.reserve(x.size());
  for (std::size_t b = 0; b < begins.size(); ++b) {
    const auto from = static_cast<std::ptrdiff_t>(begins[b]);
    const auto to = static_cast<std::ptrdiff_t>(b + 1 < begins.size() ? begins[b + 1] : x.size());
    const Signal part = of(Signal(x.begin() + from, x.begin() + to));
    out.insert(out.end(), part.begin(), part.end());
  }
  return out;
}

/// Of the command's root mean square: dry friction below it says nothing of how large other forces are.
constexpr double kLeastForceShare = 0.1;

double UsualCommand(const AxisLog& log) {
  double sum = 0.0;
  std::size_t n = 0;
  for (const double u : log.command)
    if (std::isfinite(u)) sum += u * u, ++n;
  return n > 0 ? std::sqrt(sum / static_cast<double>(n)) : 0.0;
}

}  // namespace

double Signals::ForceScale() const { return std::max(coulomb, kLeastForceShare * usual_command); }

Signals MakeSignals(const AxisLog& log, const StatedAxis& stated) {
  Signals s;
  s.begins = Beginnings(log);
  const double sigma = kRows.kinematic_smoothing_s / log.period_s;
  const double acceleration_sigma = std::max(1.0, kRows.acceleration_smoothing_share * sigma);
  const auto filled = [&](const Signal& x) { return PerStretch(x, s.begins, Filled); };
  const auto rate = [&](const Signal& x, double smoothing) {
    return PerStretch(x, s.begins, [&](const Signal& y) { return Derivative(y, smoothing, log.period_s); });
  };
  s.position = filled(log.position);
  s.velocity = rate(s.position, sigma);
  s.acceleration = rate(s.velocity, acceleration_sigma);
  const auto [low, high] = std::minmax_element(s.position.begin(), s.position.end());
  const double middle = 0.5 * (*low + *high);
  s.half_stroke_m = 0.5 * (*high - *low) * stated.table_per_q;
  s.middle_m = middle * stated.table_per_q;
  s.angle_per_q =
      stated.lead_m > 0.0 ? stated.table_per_q * 2.0 * std::numbers::pi / stated.lead_m : stated.gear_ratio;
  s.table_m.reserve(log.size());
  s.angle_rad.reserve(log.size());
  for (const double q : s.position) {
    s.table_m.push_back((q - middle) * stated.table_per_q);
    s.angle_rad.push_back(q * s.angle_per_q);
  }
  for (const double w : s.velocity) s.max_speed = std::max(s.max_speed, std::fabs(w));
  s.coulomb = 0.5 * (stated.friction.Fc_plus + stated.friction.Fc_minus);
  s.usual_command = UsualCommand(log);
  if (!log.temperature_degC.empty()) {
    s.temperature_K = SmoothSlow(Filled(log.temperature_degC), kRows.temperature_smoothing_s / log.period_s);
    double mean = 0.0;
    for (const double t : s.temperature_K) mean += t / static_cast<double>(log.size());
    for (double& t : s.temperature_K) t -= mean;
    s.mean_degC = mean;
  }
  if (!log.axis2_position_m.empty()) {
    s.axis2_m_s = rate(filled(log.axis2_position_m), sigma);
    s.axis2_m_s2 = rate(s.axis2_m_s, acceleration_sigma);
    // What the smoothing took, once more: it would make the coupling look stronger than it is (Tukey's
    // twicing).
    const Signal smoother = Smooth(s.axis2_m_s2, std::hypot(sigma, acceleration_sigma));
    for (std::size_t k = 0; k < log.size(); ++k) s.axis2_m_s2[k] += s.axis2_m_s2[k] - smoother[k];
  }
  return s;
}

void UpdateFromTrace(const AxisModel& model, const FilterRun& trace, const std::vector<double>& delivered,
                     Signals& s) {
  const std::size_t n = s.position.size();
  s.coulomb = 0.5 * (model.friction.Fc_plus + model.friction.Fc_minus);
  s.sign.resize(n);
  s.model_torque.resize(n);
  s.net_force.assign(n, 0.0);
  const double inertia = model.motor_inertia + (model.two_inertia ? model.load_inertia : 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    s.sign[k] = trace.friction[k] / s.coulomb;
    const double friction = trace.friction[k] + model.friction.s2 * s.velocity[k];
    s.model_torque[k] = inertia * s.acceleration[k] + friction;
    if (k < delivered.size()) s.net_force[k] = model.torque_gain * delivered[k] + model.offset - friction;
  }
  s.sign = Smooth(s.sign, 1.0);
}

std::vector<std::uint8_t> ValidRows(const AxisLog& log, const Signals& signals, const StatedAxis& stated,
                                    DataQuality& quality) {
  const std::size_t n = log.size();
  std::vector<std::uint8_t> valid(n, 1);
  quality.rows = log.rows;
  quality.missing = log.missing;
  quality.outliers = log.wrong_readings;
  const double moved = kRows.stale_counts_per_row * stated.position_step / log.period_s;
  for (std::size_t k = 0; k < n; ++k) {
    if (!std::isfinite(log.position[k]) || (k < log.present.size() && log.present[k] == 0)) {
      valid[k] = 0;
      continue;
    }
    if (k > 0 && log.position[k] == log.position[k - 1] && std::fabs(signals.velocity[k]) > moved &&
        moved > 0.0) {
      valid[k] = 0;
      ++quality.stale;
    }
  }
  return valid;
}

void MarkOutliers(const std::vector<double>& innovation, double position_step,
                  std::vector<std::uint8_t>& valid, DataQuality& quality) {
  StandsOut stands_out(innovation, position_step);
  for (std::size_t k = 2; k + kOutlierRows < innovation.size(); ++k) {
    if (valid[k] == 0 || !stands_out(k)) continue;
    const double e = std::fabs(innovation[k]);
    // A shock goes on; a wrong reading is over after the rows that it pulled along.
    if (std::fabs(innovation[k - 1]) > kRows.shock_share * e ||
        std::fabs(innovation[k + kOutlierRows]) > kRows.shock_share * e)
      continue;
    valid[k] = 0;
    ++quality.outliers;
  }
}

}  // namespace contour::diagnosis
