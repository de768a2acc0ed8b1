#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/mechanics.h"
#include "core/side_mode.h"
#include "core/visit.h"
#include "estimator/extension_config.h"
#include "estimator/friction_config.h"

namespace contour {

/// What is believed of one axis, `axes.<name>.model`. It may stand alone in a file: identification writes
/// one, and a machine file may name one in place of the map.
struct ModelConfig {
  MechanicsConfig mechanics;
  FrictionConfig friction;
  std::vector<SideMode> side_modes;
  /// Relative standard deviation of a parameter, by its key.
  std::map<std::string, double> uncertainty;
  /// Effects that diagnosis found beside the model.
  ExtensionsConfig extensions;

  template <class Visitor>
  void Visit(Visitor& v) {
    mechanics.Visit(v);
    v.Required("friction", friction, "LuGre friction of the axis");
    v.Optional(
        "side_modes", side_modes,
        "parts of the table that swing on springs of their own, two at most; margins of loops know them");
    v.Optional("uncertainty", uncertainty, Range{0.0, 10.0},
               "relative standard deviation of a parameter of the model, by its key; of motor_share_rel, "
               "which is a share already, absolute");
    v.Optional("extensions", extensions, "further effects, as diagnosis writes them");
  }
};

}  // namespace contour
