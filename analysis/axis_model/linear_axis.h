#pragma once

#include <Eigen/Core>

#include "analysis/axis_model/axis_model.h"

namespace contour::diagnosis {

/// What of an axis is linear: x' = dynamics x + motor u_motor + load u_load, with x = [q w] of a rigid axis
/// and [q_motor w_motor q_load w_load] of two inertias.
struct LinearAxis {
  int states = 2;
  Eigen::Matrix4d dynamics = Eigen::Matrix4d::Zero();  ///< rows and columns beyond `states` are 0
  Eigen::Vector4d motor = Eigen::Vector4d::Zero();     ///< per force at the motor
  Eigen::Vector4d load = Eigen::Vector4d::Zero();      ///< per force at the load; 0 for a rigid axis
};

/// With so much viscous friction, and no other, at the body that rubs.
LinearAxis MakeLinearAxis(const AxisModel& model, double viscous);

}  // namespace contour::diagnosis
