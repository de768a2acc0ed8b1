#pragma once

#include <string>
#include <vector>

#include "config/machine_config.h"

namespace contour {

/// Something that no single key shows: `key` is the dotted key to look at, `message` says what was found and
/// what is needed.
struct ConfigProblem {
  std::string key;
  std::string message;
};

/// What the motor has left for accelerating an axis at its velocity limit.
struct AxisReserve {
  double radius_m_rad = 0.0;
  double mass_kg = 0.0;         ///< effective: Jm / R^2 + Mt
  double friction_N = 0.0;      ///< the larger Coulomb level, and viscous friction at the velocity limit
  double pushed_N = 0.0;        ///< weight or spring that the model states
  double needed_Nm = 0.0;       ///< R (m a + friction + pushed) at the limits of acceleration and velocity
  double available_m_s2 = 0.0;  ///< what the torque limit allows there
};
AxisReserve Reserve(const AxisConfig& axis);

/// Everything that has to fit together: buses and nodes, torques, limits against what the motor can do,
/// stopping travel, room on the bus. Empty when the machine can work.
std::vector<ConfigProblem> Check(const MachineConfig& config);

/// A model by itself; `key` is its dotted key, empty when it stands alone.
std::vector<ConfigProblem> Check(const ModelConfig& model, const std::string& key);

}  // namespace contour
