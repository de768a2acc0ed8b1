#include "analysis/prediction_error/wave_signals.h"

#include <cmath>
#include <memory>

namespace contour::diagnosis {

Signal Doubled(const Signal& s) {
  Signal out = s;
  out.insert(out.end(), s.begin() + 1, s.end());
  out.push_back(s.back());
  return out;
}

std::vector<SharedSignal> WaveSignals(const std::vector<double>& phase, const std::vector<double>& size) {
  const std::size_t n = phase.size();
  auto sine = std::make_shared<Signal>(2 * n, 0.0), cosine = std::make_shared<Signal>(2 * n, 0.0);
  for (std::size_t k = 0; k + 1 < n; ++k) {
    const double middle = 0.5 * (phase[k] + phase[k + 1]), d = 0.5 * (phase[k + 1] - phase[k]);
    // Mean of sin(middle + d x) over x in -1..1, and its slope by least squares.
    double mean = 1.0 - d * d / 6.0, slope = d * (1.0 - d * d / 10.0);
    if (std::fabs(d) >= 1e-2) {
      const double s = std::sin(d) / d;
      mean = s;
      slope = 3.0 * (s - std::cos(d)) / d;
    }
    const double a = size.empty() ? 1.0 : 0.5 * (size[k] + size[k + 1]);
    const double s = a * std::sin(middle), c = a * std::cos(middle);
    (*sine)[k] = mean * s - slope * c;
    (*sine)[n + k] = mean * s + slope * c;
    (*cosine)[k] = mean * c + slope * s;
    (*cosine)[n + k] = mean * c - slope * s;
  }
  return {sine, cosine};
}

}  // namespace contour::diagnosis
