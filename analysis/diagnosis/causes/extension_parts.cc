#include "analysis/diagnosis/causes/extension_parts.h"

#include <algorithm>

namespace contour::diagnosis {
namespace {

double Rounded(double x) { return std::round(x * 1e6) / 1e6; }
std::vector<double> Rounded(std::vector<double> values) {
  for (double& v : values) v = Rounded(v);
  return values;
}

double Join(Joined how, double a, double b) {
  return how == Joined::kSum ? a + b : (1.0 + a) * (1.0 + b) - 1.0;
}

std::string WaveText(const RippleWave& w) {
  return MapText(
      {{"amplitude_rel", w.amplitude_rel}, {"order_per_rev", w.order_per_rev}, {"phase_rad", w.phase_rad}});
}

}  // namespace

double ValueOf(const Cause& cause, const std::string& name, double otherwise) {
  const auto at = cause.parameters.find(name);
  return at == cause.parameters.end() || !std::isfinite(at->second.value) ? otherwise : at->second.value;
}

const ShapeTable* TableOverStroke(const Cause& cause) {
  for (const ShapeTable& t : cause.shapes)
    if (t.abscissa == "position_mm" && !t.x.empty()) return &t;
  return nullptr;
}

void AddTable(const ShapeTable& shape, Joined how, std::vector<double>& x, std::vector<double>& y) {
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
  for (const double at : x)
    y.push_back(Rounded(Join(how, ValueAt(old_x, old_y, at), ValueAt(own_x, own_y, at))));
}

double HalfRange(const std::vector<double>& y) {
  const auto [low, high] = std::minmax_element(y.begin(), y.end());
  return 0.5 * (*high - *low);
}

void AddRipple(const Cause& cause, std::optional<RippleExtension>& to) {
  AddWave(to, &RippleWave::amplitude_rel,
          RippleWave{ValueOf(cause, "amplitude_rel"), ValueOf(cause, "order_per_rev", 1.0),
                     ValueOf(cause, "phase_rad")});
}

Assignments RippleInSimulation(std::string_view effect, const std::optional<RippleExtension>& ripple) {
  if (!ripple) return {};
  std::vector<std::string> further;
  for (const RippleWave& w : ripple->further) further.push_back(WaveText(w));
  return {SetEffect(effect, {{"amplitude_rel", ripple->amplitude_rel},
                             {"order_per_rev", ripple->order_per_rev},
                             {"phase_rad", ripple->phase_rad},
                             {"further", further}})};
}

Assignments DrawnRipple(std::string_view effect, const Drawn& drawn) {
  return {SetEffect(
      effect,
      {{"amplitude_rel", drawn.size}, {"order_per_rev", drawn.order}, {"phase_rad", drawn.phase_rad}})};
}

}  // namespace contour::diagnosis
