#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/axis_model/axis_model.h"
#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/prediction_error/forward_filter.h"
#include "analysis/recording/axis_log.h"
#include "analysis/recording/data_quality.h"

namespace contour::diagnosis {

/// What regressors are made of, one element per row; smoothed without phase from the measured position, or
/// taken from a traced run of the model. Never from the measured command: a residual must not explain itself.
struct Signals {
  Signal position;      ///< q, gaps filled
  Signal velocity;      ///< of q
  Signal acceleration;  ///< of q
  Signal table_m;       ///< centred on the middle of the stroke
  Signal angle_rad;     ///< of the motor
  Signal sign;  ///< friction without its viscous part over the Coulomb level: a sign good in presliding
  Signal model_torque;              ///< u that the motion needs by the model
  Signal net_force;                 ///< what accelerates over the row: delivered less friction by the model
  Signal temperature_K;             ///< about its mean; empty without a sensor
  double mean_degC = 0.0;           ///< that mean
  Signal axis2_m_s2, axis2_m_s;     ///< empty without a second axis
  std::vector<std::size_t> begins;  ///< rows where motion begins anew, the first among them
  double half_stroke_m = 0.0;       ///< of what was travelled
  double max_speed = 0.0;           ///< of q
  double angle_per_q = 1.0;         ///< rad of the motor
  double middle_m = 0.0;            ///< table position of the stroke's middle as travelled
  double coulomb = 0.0;             ///< mean level
  double usual_command = 0.0;       ///< u, root mean square
  /// How large forces on this axis are: as dry friction, or, where there is next to none, as what moves it.
  [[nodiscard]] double ForceScale() const;
};

/// Of `sign`: friction beyond it follows the motion.
inline constexpr double kFollowsMotion = kRows.follows_motion_share;

/// Gaussian smoothing and its derivatives, without phase; ends are held.
Signal Smooth(const Signal& x, double sigma_rows);
Signal Derivative(const Signal& x, double sigma_rows, double period_s);

/// Kinematic part; `sign` and `model_torque` wait for UpdateFromTrace.
Signals MakeSignals(const AxisLog& log, const StatedAxis& stated);
/// `delivered`: mean over every row.
void UpdateFromTrace(const AxisModel& model, const FilterRun& trace, const std::vector<double>& delivered,
                     Signals& signals);

/// Rows whose position may correct the model, and what was wrong with the others. Isolated innovations far
/// beyond their neighbourhood are outliers; repeated readings of a moving axis are stale.
std::vector<std::uint8_t> ValidRows(const AxisLog& log, const Signals& signals, const StatedAxis& stated,
                                    DataQuality& quality);
void MarkOutliers(const std::vector<double>& innovation, double position_step,
                  std::vector<std::uint8_t>& valid, DataQuality& quality);

}  // namespace contour::diagnosis
