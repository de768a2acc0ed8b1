#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "analysis/axis_model/stated_axis.h"

// One run's model: numbers, and signals that effects add, in the generalised coordinates of AxisLog.
namespace contour::diagnosis {

using Signal = std::vector<double>;
using SharedSignal = std::shared_ptr<const Signal>;

struct AxisModel {
  std::size_t rows = 0;  ///< of the log, for signals
  bool two_inertia = false;
  bool friction_on_load = false;
  double motor_share = 0.0;  ///< of friction on the load, that acts on the motor
  double motor_inertia = 0.0, load_inertia = 0.0;
  double stiffness = 0.0, damping = 0.0;
  double gap = 0.0;  ///< free travel between the two inertias
  StatedFriction friction;
  /// Mean square of a speed that no row shows: noise shakes the axis, and the bristle wears off with |w|.
  double rough = 0.0;
  double start_bristle = 0.0;  ///< z at the first row
  double offset = 0.0;
  double delay_s = 0.0, lag_s = 0.0;
  double lag_for_delay_s = 0.0;  ///< more of the one, less of the other
  double torque_gain = 1.0;      ///< delivered over commanded
  double saturation = 0.0;       ///< share of the delivered u lost per square of u
  /// A second, softer friction element parallel to the main one: its share of the level; its stiffness over
  /// the main's at equal level.
  double soft_share = 0.0, soft_ratio = 0.1;
  double payload = 0.0;         ///< inertia added (to the load, or to everything when rigid)
  std::size_t payload_row = 0;  ///< from this row on

  /// Null means none. One element per row: linear between rows. Two per row (all first ones, then all second
  /// ones): linear from the one to the other over the row, which a wave needs that turns far in one.
  SharedSignal motor_force, load_force;  ///< accelerate
  SharedSignal level;                    ///< added to the factor 1 of the friction levels
  SharedSignal viscous;                  ///< added to the factor 1 of the viscous term
  SharedSignal reading_error;            ///< the encoder reads that much more than there is
  SharedSignal scale_error_m;            ///< the linear scale reads that much more

  bool operator==(const AxisModel&) const = default;
};

/// The model as it is stated.
AxisModel ModelOf(const StatedAxis& stated);

}  // namespace contour::diagnosis
