#include "tools/validation/emps/free_run.h"

#include <cmath>
#include <numbers>

namespace contour::emps {
namespace {

constexpr int kSteps = 5;
constexpr double kPeriod_s = 1e-3;
constexpr double kMiddle_m = 0.12;

}  // namespace

std::vector<std::size_t> Segment::Windows(std::size_t length, std::size_t step) const {
  std::vector<std::size_t> starts;
  for (std::size_t at = from; at + length <= to; at += step) starts.push_back(at);
  return starts;
}

std::vector<double> FreeRun(const Parameters& p, const Recording& r, std::size_t start, std::size_t rows) {
  std::vector<double> out(rows);
  double x = r.filtered_m[start];
  double v = r.velocity_m_s[start];
  const double h = kPeriod_s / kSteps;
  const bool stribeck = p.dFs_plus_N != 0.0 || p.dFs_minus_N != 0.0;
  for (std::size_t k = 0; k < rows; ++k) {
    out[k] = x;
    const double s = (x - kMiddle_m) / kMiddle_m;
    const double angle = 2.0 * std::numbers::pi * x / kTurn_m;
    const double ripple = 1.0 + p.ripple_cos1 * std::cos(angle) + p.ripple_sin1 * std::sin(angle) +
                          p.ripple_cos2 * std::cos(2.0 * angle) + p.ripple_sin2 * std::sin(2.0 * angle);
    const double level = (1.0 + p.x1 * s + p.x2 * s * s) * ripple;
    for (int i = 0; i < kSteps; ++i) {
      const bool forward = v > 0.0;
      double dry = forward ? p.Fc_plus_N : p.Fc_minus_N;
      if (stribeck) dry += (forward ? p.dFs_plus_N : p.dFs_minus_N) * std::exp(-std::abs(v) / p.vs_m_s);
      const double sign = v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0;
      const double viscous = forward ? p.Fv_plus_Ns_m : p.Fv_minus_Ns_m;
      const double a = (r.force_N[start + k] + p.offset_N - viscous * v - sign * dry * level) / p.mass_kg;
      x += h * (v + 0.5 * h * a);
      v += h * a;
    }
  }
  return out;
}

double FreeRunRmse_m(const Parameters& p, const Recording& r, const Segment& segment) {
  double square = 0.0;
  std::size_t count = 0;
  for (const std::size_t start : segment.Windows(kWindow, kWindow)) {
    const std::vector<double> x = FreeRun(p, r, start, kWindow);
    for (std::size_t k = 0; k < kWindow; ++k) square += std::pow(x[k] - r.position_m[start + k], 2);
    count += kWindow;
  }
  return std::sqrt(square / static_cast<double>(count));
}

}  // namespace contour::emps
