#pragma once

#include <cstddef>
#include <numbers>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/prediction_error/problem.h"
#include "analysis/recording/axis_log.h"

// An axis whose signals are known by formula and not smoothed from a log, so that a test can say by hand what
// an effect makes of them.
namespace contour::diagnosis::test {

struct KnownOptions {
  bool two_inertia = false, friction_on_load = false;
  bool linear = false;  ///< seen at the carriage
  bool stribeck = true;
  bool scale = true, temperature = true, axis2 = true;
};

/// Lead 10 mm. The table moves 20 mm + 50 mm sin(pi t) for 2 s, which is ten turns of the motor; the stroke
/// is stated as +-100 mm. Fc 0.06 Nm forth and 0.04 Nm back (mean 0.05), rated 0.64 Nm, J 1e-4 kg m^2, of
/// which the table of two inertias has 4e-5.
class KnownAxis {
 public:
  static constexpr std::size_t kRows = 2000;
  static constexpr double kPeriod_s = 1e-3;
  static constexpr double kHalfStroke_m = 0.05, kMiddle_m = 0.02;
  static constexpr double kTablePerRad = 0.01 / (2.0 * std::numbers::pi);
  static constexpr double kTopSpeed_m_s = kHalfStroke_m * std::numbers::pi;
  static constexpr double kTopSpeed_rad_s = kTopSpeed_m_s / kTablePerRad;
  static constexpr double kCoulomb_Nm = 0.05;

  explicit KnownAxis(const KnownOptions& options = {});
  // The problem looks at the log and the stated axis.
  KnownAxis(const KnownAxis&) = delete;
  KnownAxis& operator=(const KnownAxis&) = delete;

  AxisLog log;
  StatedAxis stated;
  Problem problem;

  [[nodiscard]] const Signals& signals() const { return *problem.signals; }
};

}  // namespace contour::diagnosis::test
