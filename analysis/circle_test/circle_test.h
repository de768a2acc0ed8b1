#pragma once

#include <array>
#include <string>
#include <vector>

// What one circle tells of two axes when something that is no part of them has measured it: a ball bar, a
// grid encoder, linear scales. The motor's encoder and the torque cannot tell before which side of the screw
// friction acts; where the table really went can.
namespace contour {

inline constexpr std::size_t kCircleAxes = 2;

/// One axis as it is stated, SI units at the table.
struct CircleAxis {
  std::string name;
  double stiffness_N_m = 0.0;
  double table_mass_kg = 0.0;
  double mass_kg = 0.0;  ///< all of it
  double lead_m = 0.0;
};

/// One period of the recorded circle.
struct CircleRow {
  double time_s = 0.0;
  std::array<double, kCircleAxes> motor_m{};  ///< R theta
  std::array<double, kCircleAxes> force_N{};  ///< of the motor, torque / R
  double speed_m_s = 0.0;                     ///< along the path as it was asked for
};

/// The measured radius at an angle, less some constant.
struct CirclePoint {
  double angle_rad = 0.0;  ///< from the first axis towards the second, about the centre
  double radius_m = 0.0;   ///< deviation from the nominal radius
};

struct Found {
  double value = 0.0, std = 0.0;
};
struct CircleAxisFound {
  Found motor_share;  ///< of the friction, that acts before the screw
  /// The table stands sine sin(theta) + cosine cos(theta) beyond R theta, theta the motor's angle; m.
  bool wobble_seen = false;  ///< the circle is wide enough to tell
  Found wobble_sine, wobble_cosine;
};
struct CircleTestResult {
  std::array<CircleAxisFound, kCircleAxes> axes;
  double before_m = 0.0;  ///< rms of what the model leaves of the measured radius
  double after_m = 0.0;   ///< with what was found
};

/// Rows from begin to before end.
struct RowRange {
  std::size_t begin = 0, end = 0;
};
/// Those that FitCircle goes by: whole turns, without the first where there are more. Throws as it does.
RowRange TurnsOfCircle(const std::vector<CircleRow>& rows);

/// Measured positions of whole turns as radii: a point per degree, the mean over it.
std::vector<CirclePoint> RadiiOf(const std::vector<std::array<double, kCircleAxes>>& table_m);

/// Fits share and wobble of both axes to the measured circle; the wind-up's compliance is that of the stated
/// K, so what is off in K is in the share. Other rows may be there: its longest stretch at full
/// speed is taken, but for the first of its turns where there are more. Throws std::invalid_argument with
/// what is wrong with the records: no circle, less than a turn, points that do not go round.
CircleTestResult FitCircle(const std::array<CircleAxis, kCircleAxes>& axes,
                           const std::vector<CircleRow>& rows, const std::vector<CirclePoint>& measured);

/// What forbids the use of a result; empty: nothing. A share that the circle does not tell, or one that is
/// none.
std::string WhatIsWrong(const CircleTestResult& result, const std::array<CircleAxis, kCircleAxes>& axes);

}  // namespace contour
