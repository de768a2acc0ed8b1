#pragma once

#include "config/model_config.h"

namespace contour {

/// What a model says pushes the table besides friction, wherever it stands and whatever moves it: the weight
/// of a vertical axis, a spring along the stroke (extensions constant_torque and cable_spring), N, both
/// signs.
struct StatedPush {
  double least_N = 0.0;
  double most_N = 0.0;

  /// The larger, without its sign.
  [[nodiscard]] double size_N() const;
};
StatedPush StatedPushOf(const ModelConfig& model);

/// What is left of the push once friction bears what it can of it, in the direction that is worse; below 0:
/// what friction could bear besides.
struct UnbornePush {
  double at_rest_N = 0.0;  ///< by break-away friction
  double sliding_N = 0.0;  ///< by Coulomb friction
};
UnbornePush UnbornePushOf(const ModelConfig& model);

}  // namespace contour
