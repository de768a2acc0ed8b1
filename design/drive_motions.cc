#include "design/drive_motions.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "analysis/text/format_text.h"
#include "design/commission_motions.h"

namespace contour {
namespace {

/// Seconds per stroke of the slow ones: several periods of the chirp each.
constexpr double kStrokeTimes_s[] = {4.0, 6.0};
/// At either end of a stroke.
constexpr double kDwell_s = 0.2;
constexpr double kLowest_Hz = 3.0;
constexpr double kHighest_Hz = 400.0;
/// Of the cycle's rate: above it a held torque is no sine any more.
constexpr double kOfRate = 0.4;
/// The chirp moves the axis to and fro by this share of its speed at most, were it held by nothing above the
/// frequency at which drives' loops begin to let go, and the masses as light as a catalogue allows.
constexpr double kShareOfSlide = 0.5;
constexpr double kLetGo_Hz = 15.0;

}  // namespace

std::vector<CommissionMotion> DriveMotions(const CommissionPlan& plan, const AxisConfig& axis,
                                           double position_mm, double cycle_us) {
  const double up_mm = plan.high_mm - kCommissionMargin_mm - position_mm;
  const double down_mm = plan.low_mm + kCommissionMargin_mm - position_mm;
  const double way_mm = up_mm >= -down_mm ? up_mm : down_mm;
  const double top_mm_s = kCommissionShareOfTop * plan.limits.max_speed_mm_s;
  std::vector<CommissionMotion> motions;
  motions.push_back(
      {"strokes with ramps", CreepProgram(plan.axis, way_mm, {0.3 * top_mm_s, top_mm_s}, kDwell_s)});
  std::vector<double> slow;
  for (const double time_s : kStrokeTimes_s)
    slow.push_back(std::min(std::abs(way_mm) / time_s, 0.8 * top_mm_s));
  const double slowest_mm_s = *std::min_element(slow.begin(), slow.end());
  const Mechanics m = ToSi(axis.model.mechanics);
  const double weak_N = kShareOfSlide * 1e-3 * slowest_mm_s * kLightestOfCatalogue * m.mass_kg * 2.0 *
                        std::numbers::pi * kLetGo_Hz;
  const double amplitude_Nm = m.radius_m_rad * std::min(weak_N, CommissionChirp_N(axis));
  motions.push_back(
      {FormatText("chirp of %.3g Nm on the torque offset while sliding", amplitude_Nm),
       CreepProgram(plan.axis, way_mm, slow, kDwell_s) +
           FormatText("torque: {axis: %s, kind: chirp, amplitude_Nm: %.6f, frequency_min_hz: %g, "
                      "frequency_max_hz: %.0f, period_s: %g}\n",
                      plan.axis.c_str(), amplitude_Nm, kLowest_Hz,
                      std::min(kHighest_Hz, kOfRate * 1e6 / cycle_us), kDrivePeriod_s)});
  return motions;
}

}  // namespace contour
