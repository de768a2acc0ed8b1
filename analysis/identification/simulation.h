#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "analysis/identification/table_axis.h"

namespace contour::identify {

struct OwnForce;

/// What was measured, in table units. Timing as diagnosis::AxisLog states it.
struct Measured {
  double period_s = 1e-3;
  double position_step_m = 0.0;  ///< one count of the encoder
  std::vector<double> force_N;   ///< command / R
  /// Where the drive closes its own loop: the offset that it was sent, in the place of the command, and what
  /// it said that it gave at the instant of the position. Empty elsewhere.
  std::vector<double> offset_N, reported_N;
  std::vector<double> position_m;     ///< R theta
  std::vector<double> table_m;        ///< linear scale; empty without one
  std::vector<std::uint8_t> present;  ///< 0: no sample at this grid point
  [[nodiscard]] std::size_t size() const { return force_N.size(); }
  [[nodiscard]] bool led_by_drive() const { return !reported_N.empty(); }
};

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

/// The axis's own motion one period after the other, led by the torque that was sent and corrected by the
/// position that was measured. The screw and viscous friction are stepped exactly (matrix exponential), the
/// bristle between them (Strang splitting); hold, delay and lag of the torque are exact.
class Simulation {
 public:
  static constexpr int kSubSteps = 5;

  Simulation(const TableAxis& axis, const Measured& data, const FollowGain& gain);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Goes on to the next grid point; returns measured minus predicted position, NaN where there is nothing
  /// to compare (no sample, or the first ones after a gap).
  double Next();

  // At the grid point reached, after the correction: the mass that rubs.
  [[nodiscard]] double table_m() const { return state_(rubbing_[0].place); }
  [[nodiscard]] double table_velocity_m_s() const { return state_(rubbing_[0].speed); }
  /// Bristle and viscous friction of the whole axis.
  [[nodiscard]] double friction_N() const;

 private:
  /// A bristle, its share of all friction, and the mass it holds.
  struct Rubbing {
    Eigen::Index place = 0, speed = 1;  ///< in state_
    double share = 1.0;
    double mass_kg = 1.0;
    double z_m = 0.0;
    double force_N = 0.0;
    double z_before_m = 0.0, place_before_m = 0.0;  ///< when the period began
  };
  /// A mass on a spring on the table; no mass: none.
  struct Swinging {
    double mass_kg = 0.0, stiffness_N_m = 0.0, damping_Ns_m = 0.0;
    double place_m = 0.0, speed_m_s = 0.0;
    double force_N = 0.0;  ///< on it
  };
  void Start();
  void MakePieces(const TableAxis& stiff);
  [[nodiscard]] double Level_N(double velocity_m_s) const;
  void MoveBristle(Rubbing& r, double from_z, double travel_m, double step_s) const;
  [[nodiscard]] double BristleForce_N(const Rubbing& r) const;
  [[nodiscard]] double BristleDamping_Ns_m(const Rubbing& r, double velocity_m_s) const;
  void Prepare();
  void PrepareCogging();
  void AddOwnForce();
  void Swing(double half_step_s);
  void Correct(double error_m);

  const TableAxis& axis_;
  const Measured& data_;
  const FollowGain gain_;
  /// One step of the linear part; the command is the older one before the delay's edge.
  struct Piece {
    double step_s;
    Eigen::Matrix4d flow;
    Eigen::Vector4d delayed, command;  ///< per N
    Eigen::Vector4d motor;             ///< per N that acts at once
    double lag_left;
    bool older;
  };
  void Advance(const Piece& piece, double command_N, double motor_N);

  std::vector<Piece> pieces_;
  std::vector<Rubbing> rubbing_;  ///< the table first
  Swinging side_;
  double table_mass_kg_ = 0.0;  ///< without what swings
  Eigen::Vector4d state_ = Eigen::Vector4d::Zero();
  double force_N_ = 0.0;  ///< behind the lag
  std::size_t k_ = 0;
  bool running_ = false;
  int to_settle_ = 0;
  int absent_ = 0;                                 ///< grid points without a sample, up to here
  double factor_plus_ = 1.0, factor_minus_ = 1.0;  ///< of the levels, at this period's place
  bool cogs_ = false;
  std::unique_ptr<OwnForce> own_;  ///< of a drive that closes its own loop
  std::vector<double> direct_N_;   ///< what acts on the motor at once, over the pieces of this period
  std::size_t whole_delay_ = 0;
};

/// Factor of the levels at a place, about 1.
double LevelFactor(const TableAxis& axis, double motor_m, double table_m, bool up);

/// All prediction errors of a record, zero where there is nothing to compare.
std::vector<double> PredictionErrors_m(const TableAxis& axis, const Measured& data, const FollowGain& gain);

}  // namespace contour::identify
