#include "analysis/axis_model/scale_parameter.h"

#include <array>
#include <utility>

namespace contour::diagnosis {

bool ScaleParameter(StatedAxis& axis, std::string_view name, double factor) {
  StatedFriction& f = axis.friction;
  using Values = std::array<double*, 2>;
  const std::array<std::pair<std::string_view, Values>, 10> all{{{"inertia", {&axis.motor_inertia}},
                                                                 {"load_inertia", {&axis.load_inertia}},
                                                                 {"stiffness", {&axis.stiffness}},
                                                                 {"damping", {&axis.damping}},
                                                                 {"Fc", {&f.Fc_plus, &f.Fc_minus}},
                                                                 {"Fs", {&f.Fs_plus, &f.Fs_minus}},
                                                                 {"vs", {&f.vs}},
                                                                 {"s0", {&f.s0}},
                                                                 {"s1", {&f.s1}},
                                                                 {"s2", {&f.s2}}}};
  for (const auto& [known, values] : all) {
    if (known != name) continue;
    for (double* value : values)
      if (value != nullptr) *value *= factor;
    return true;
  }
  return false;
}

}  // namespace contour::diagnosis
