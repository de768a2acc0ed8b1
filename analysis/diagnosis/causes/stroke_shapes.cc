#include "analysis/diagnosis/causes/stroke_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/diagnosis/causes/effect_parts.h"

namespace contour::diagnosis {
namespace {

double HalfStroke(const Signals& s) { return std::max(s.half_stroke_m, 1e-9); }

template <class F>
SharedSignal AlongTable(const Signals& s, F&& at) {
  const double half = HalfStroke(s);
  return Make(s.table_m.size(),
              [&](std::size_t k) { return at(std::clamp(s.table_m[k] / half, -1.0, 1.0)); });
}

}  // namespace

double CosineAt(unsigned number, double place) {
  return std::cos(static_cast<double>(number) * std::numbers::pi * 0.5 * (place + 1.0));
}

double LegendreAt(unsigned number, double place) { return std::legendre(number, place); }

std::vector<SharedSignal> Cosines(const Signals& s, int first, int last) {
  std::vector<SharedSignal> out;
  for (int j = first; j <= last; ++j)
    out.push_back(AlongTable(s, [&](double u) { return CosineAt(static_cast<unsigned>(j), u); }));
  return out;
}

std::vector<SharedSignal> LegendrePolynomials(const Signals& s, int last) {
  std::vector<SharedSignal> out;
  for (int j = 1; j <= last; ++j)
    out.push_back(AlongTable(s, [&](double u) { return LegendreAt(static_cast<unsigned>(j), u); }));
  return out;
}

Signal OverStroke(const Signals& s, const std::vector<double>& amplitudes, StrokeBasis basis,
                  const std::vector<double>& at_m) {
  const double half = HalfStroke(s);
  Signal y;
  for (const double x : at_m) {
    const double u = std::clamp(x / half, -1.0, 1.0);
    double sum = 0.0;
    for (std::size_t j = 0; j < amplitudes.size(); ++j)
      sum += amplitudes[j] * basis(static_cast<unsigned>(j + 1), u);
    y.push_back(sum);
  }
  return y;
}

std::vector<double> StrokeGrid(const Signals& s) {
  std::vector<double> x;
  for (int i = 0; i <= 40; ++i) x.push_back(s.half_stroke_m * (-1.0 + 0.05 * i));
  return x;
}

double HalfRange(const FittedEffect& fitted) {
  const Signals& s = fitted.signals();
  const Signal shape = OverStroke(s, fitted.amplitudes(), CosineAt, StrokeGrid(s));
  const auto [low, high] = std::minmax_element(shape.begin(), shape.end());
  return 0.5 * (*high - *low);
}

}  // namespace contour::diagnosis
