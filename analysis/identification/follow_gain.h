#pragma once

#include <Eigen/Core>

#include "analysis/identification/measured.h"
#include "analysis/identification/table_axis.h"

namespace contour::identify {

/// How the simulation follows the measured position: x_m, v_m, x_t, v_t per metre of prediction error.
using FollowGain = Eigen::Vector4d;

/// Steady-state Kalman gain of the axis without friction, for a disturbance that makes the prediction follow
/// the measurement at about `bandwidth_Hz`.
FollowGain MakeFollowGain(const TableAxis& axis, double period_s, double bandwidth_Hz);
/// Of the torque that a drive reports, the smallest that was seen; 0 without reports.
double ReportStep_N(const Measured& data);
/// The gain for a record: of 60 Hz where the torque is known, times `factor`. What a drive reports of its own
/// loop is rounded, and in error where nobody knows: there the position is believed as far as that asks for,
/// or an axis that sticks would seem to give less to a force than it does.
FollowGain FollowGainFor(const TableAxis& axis, const Measured& data, double factor = 1.0);

}  // namespace contour::identify
