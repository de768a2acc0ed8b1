#include "config/stated_push.h"

#include <algorithm>
#include <cmath>

#include "config/extended_model.h"
#include "core/mechanics.h"

namespace contour {

double StatedPush::size_N() const { return std::max(std::fabs(least_N), std::fabs(most_N)); }

StatedPush StatedPushOf(const ModelConfig& model) {
  const ExtensionsConfig& e = model.extensions;
  const double constant_Nm = e.constant_torque ? e.constant_torque->torque_Nm : 0.0;
  double least_Nm = constant_Nm, most_Nm = constant_Nm;
  if (e.cable_spring && !e.cable_spring->torque_Nm.empty()) {
    const auto [least, most] =
        std::minmax_element(e.cable_spring->torque_Nm.begin(), e.cable_spring->torque_Nm.end());
    least_Nm += *least;
    most_Nm += *most;
  }
  const double radius_m_rad = ToSi(model.mechanics).radius_m_rad;
  return {least_Nm / radius_m_rad, most_Nm / radius_m_rad};
}

UnbornePush UnbornePushOf(const ModelConfig& model) {
  const StatedPush pushed = StatedPushOf(model);
  const Friction f = ToSi(Extended(model).friction, ToSi(model.mechanics).radius_m_rad);
  // Downwards the minus level holds against what pushes down, and the other way round.
  const auto left_N = [&](double plus_N, double minus_N) {
    return std::max(pushed.most_N - plus_N, -pushed.least_N - minus_N);
  };
  return {left_N(f.Fs_plus_N, f.Fs_minus_N), left_N(f.Fc_plus_N, f.Fc_minus_N)};
}

}  // namespace contour
