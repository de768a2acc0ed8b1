#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

// The model that the simulation runs with, as stated, and how well each of its numbers is known.
namespace contour::diagnosis {

/// LuGre friction in the coordinate of the inertia it acts on:
///   F = s0 z + s1(w) z' + s2 w,  z' = w - s0 |w| z / g(w),  g = Fc + (Fs - Fc) exp(-(|w| / vs)^p),
///   s1(w) = s1 exp(-(w / vd)^2), or s1 constant when vd is 0.
struct StatedFriction {
  double Fc_plus = 0.0, Fc_minus = 0.0;
  double Fs_plus = 0.0, Fs_minus = 0.0;
  double vs = 0.0, exponent = 1.0;
  double s0 = 0.0, s1 = 0.0, vd = 0.0, s2 = 0.0;

  /// Whether break-away has numbers of its own; where none are stated it equals Coulomb friction.
  [[nodiscard]] bool BreaksAwayHigher() const { return Fs_plus + Fs_minus > Fc_plus + Fc_minus; }

  bool operator==(const StatedFriction&) const = default;
};

/// amplitude sin(order_per_rev angle + phase_rad), of the motor's angle.
struct StatedWave {
  double amplitude = 0.0, order_per_rev = 1.0, phase_rad = 0.0;
};

/// Over the table's position; straight lines between the points, constant beyond them. Empty: 0.
struct StatedTable {
  std::vector<double> position_m, value;
};
/// Of a table y over x, x rising, which must not be empty: straight lines, constant beyond the ends.
inline double ValueAt(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto after = std::upper_bound(x.begin(), x.end(), at);
  if (after == x.begin()) return y.front();
  if (after == x.end()) return y.back();
  const auto i = static_cast<std::size_t>(after - x.begin());
  return y[i - 1] + (y[i] - y[i - 1]) * (at - x[i - 1]) / (x[i] - x[i - 1]);
}

/// Friction beyond the linear term: at_max_speed y^exponent with y = |w| / max_speed, or with a knee, as
/// share of the maximum speed, at_max_speed y (1 + knee) / (y + knee).
struct StatedDrag {
  double at_max_speed = 0.0, max_speed = 1.0, exponent = 2.0, knee = 0.0;
};

/// What the model states beyond its basic numbers: effects found before.
struct StatedExtras {
  std::vector<StatedWave> cogging;                       ///< u on the motor
  std::vector<StatedWave> friction_ripple, ball_ripple;  ///< of the friction level
  StatedTable friction_rel;                              ///< of the friction level
  StatedTable spring;                                    ///< u, accelerates
  StatedTable pitch_error_m;                             ///< table beyond what the motor's angle says
  std::vector<StatedWave> wobble_m;                      ///< the same, per turn
  std::vector<StatedDrag> drag;
  double viscous_difference_rel =
      0.0;  ///< of the viscous coefficient: half more upwards, half less downwards
  double viscous_rate_1_K = 0.0, reference_degC = 20.0;
};

/// In the generalised coordinates of AxisLog (rotary: rad, Nm, kg m^2 at the motor; linear: m, N, kg).
struct StatedAxis {
  std::string source;  ///< file, for messages
  std::string axis;    ///< its name; empty when not known
  bool linear = false;
  bool endless = false;      ///< no stroke, and nothing that goes with one
  bool to_and_fro = false;   ///< stated not to be endless
  double gear_ratio = 1.0;   ///< turns of the motor per turn of q, where q is not the motor's angle
  double lead_m = 0.0;       ///< table travel per motor turn; 0 when unknown (linear axes without a screw)
  double table_per_q = 1.0;  ///< table travel in m per unit of q: lead / (2 pi), or 1

  bool two_inertia = false;
  double motor_inertia = 0.0;  ///< everything, when !two_inertia
  double load_inertia = 0.0;   ///< the load seen at q
  double stiffness = 0.0;      ///< between the two, seen at q
  double damping = 0.0;
  bool friction_on_load = false;  ///< else on the motor's inertia
  double motor_share = 0.0;       ///< of friction on the load: so much of it acts on the motor
  StatedFriction friction;
  double offset = 0.0;  ///< constant u that the model states, positive accelerates
  StatedExtras extras;

  double delay_s = 0.0;                           ///< from the row to the beginning of its command
  double lag_s = 0.0;                             ///< first-order current loop
  double position_step = 0.0;                     ///< q of one count
  double command_step = 0.0;                      ///< u of one step of the command
  double rated = 0.0;                             ///< rated u
  double torque_constant = 0.0;                   ///< u per ampere; 0: unknown
  double stroke_min_m = 0.0, stroke_max_m = 0.0;  ///< table

  /// Relative standard deviation, by the names: inertia (motor_inertia), load_inertia, stiffness, damping,
  /// Fc, Fs, vs, s0, s1, s2, offset, delay, lag, torque_constant. Absent: the engine's stated default.
  std::map<std::string, double> sigma;

  /// What the file leaves open, by the same names (Fc, s2, vs, s0): a placeholder stands there until
  /// CompleteFromLog. "stroke" where its ends are not stated; "ampere" where the log has said what one gives.
  std::set<std::string> open;
};

}  // namespace contour::diagnosis
