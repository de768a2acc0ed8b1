#include "analysis/diagnosis/causes/drift.h"

#include <cmath>
#include <string>

namespace contour::diagnosis {

void Drifts(const Problem& p, std::string_view kind, Input input, std::vector<SharedEffect>& out) {
  const std::size_t n = p.rows();
  const std::string name(kind);
  const auto part = [n](std::size_t k) { return static_cast<double>(k) / static_cast<double>(n); };
  out.push_back(LinearEffect({name, "linear", 3}, input,
                             {Make(n, [&](std::size_t k) { return part(k) - 0.5; })}, 5e-3));
  for (const double tau : {0.08, 0.25})
    out.push_back(WithOrder(
        ShapedEffect(
            p, {name, "exponential " + std::to_string(tau), 3}, input, 5e-3, {-1.2, 1.0},
            [part, tau](std::size_t k, double x) { return 0.5 - std::exp(-part(k) / (tau * std::exp(x))); }),
        tau));
}

NamedValues ChangeOverLog(const FittedEffect& fitted) {
  const Problem& p = fitted.problem;
  const Effect& e = fitted.effect();
  const std::vector<double>& a = fitted.amplitudes();
  const double seconds = p.log.period_s * static_cast<double>(p.rows());
  if (e.order <= 0.0) return {{"change_rel", a[0] / (1.0 - 0.5 * a[0])}};
  const double tau = e.order * std::exp(a[1]);
  return {{"change_rel", a[0] * (1.0 - std::exp(-1.0 / tau)) / (1.0 - 0.5 * a[0])},
          {"time_constant_s", tau * seconds}};
}

}  // namespace contour::diagnosis
