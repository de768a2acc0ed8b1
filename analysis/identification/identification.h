#pragma once

#include <functional>
#include <string>
#include <vector>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/identification/joint_fit.h"
#include "analysis/identification/presliding_fit.h"
#include "analysis/identification/scale_wind_up.h"
#include "analysis/identification/shaken_screw.h"
#include "analysis/identification/sliding_fit.h"
#include "analysis/identification/unexplained_force.h"
#include "analysis/recording/axis_log.h"

namespace contour::identify {

struct EncoderFindings {
  double step_m = 0.0;   ///< smallest change ever seen; 0: it never changed
  double noise_m = 0.0;  ///< of a reading, quantisation included
};

/// What one window of the record looked like, and what the model makes of it.
struct OverlayPoint {
  double time_s = 0.0, position_m = 0.0, velocity_m_s = 0.0;
  double friction_measured_N = 0.0;  ///< force less m a
  double friction_simulated_N = 0.0;
};

struct Identification {
  TableAxis stated;
  TableAxis stepwise;  ///< where the joint fit began
  JointFit fit;
  bool screw_identified = false;
  std::vector<std::string> notes;  ///< in plain words: what could not be found, and why

  // The steps, for the report.
  SlidingFit sliding;
  std::vector<StribeckPoint> stribeck;
  std::vector<BreakAway> break_aways;
  PreslidingFit presliding;
  std::vector<LoopPoint> loops;
  std::vector<LoopPoint> loops_simulated;
  ShakenScrew shaken;
  ScrewWindUp wind_up;
  EncoderFindings encoder;
  std::vector<OverlayPoint> overlay;
  UnexplainedForce unexplained;
  double seconds = 0.0;        ///< of record
  double missing_share = 0.0;  ///< of its cycles
  double period_s = 0.0;       ///< of its samples
};

struct IdentifyOptions {
  bool steps_only = false;  ///< without the joint fit
  int threads = 1;          ///< the result does not depend on it
  std::function<void(const std::string& doing, double share)> progress;
};

/// The record in table units.
Measured ToMeasured(const diagnosis::AxisLog& log, const TableAxis& axis, double position_step);

/// Steps first (sliding, screw, presliding), then all parameters at once on the time series. Throws
/// std::runtime_error when the records do not hold what it takes.
Identification Identify(const diagnosis::StatedAxis& stated, const std::vector<diagnosis::AxisLog>& logs,
                        const IdentifyOptions& options);

}  // namespace contour::identify
