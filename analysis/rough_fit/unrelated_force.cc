#include "analysis/rough_fit/unrelated_force.h"

#include <algorithm>

#include "analysis/rough_fit/rough_fit.h"
#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

/// [share of the command's square] Cogging or a weight may leave as much of the force of an axis that has
/// both.
constexpr double kMostUnseen = 0.5;
/// [counts] What noise makes of a position that stands.
constexpr double kStands_counts = 4.0;
/// [deviations] Least squares of noise come to less.
constexpr double kSeen = 3.0;

bool SeesInertia(const RoughFit& r) { return r.inertia > 0.0 && kSeen * r.inertia_sigma_rel < 1.0; }
bool SeesFriction(const RoughFit& r) { return r.coulomb > kSeen * r.coulomb_sigma; }

}  // namespace

std::string UnrelatedForce(const AxisLog& log, const StatedAxis& stated) {
  const std::string force = log.linear ? "force_N" : "torque_Nm";
  const auto& u = log.command;
  if (std::all_of(u.begin(), u.end(), [&](double one) { return one == u.front(); }))
    return force + " is the same in every row: what moved the axis is not in it";
  double least = 1.0;
  for (const RoughShape shape : {RoughShape::kFriction, RoughShape::kFrictionAndSpring}) {
    const RoughFit r = FitRoughly(log, stated, shape);
    // Rows that are missing all over a log leave nothing to smooth, though the axis moves.
    if (!r.why_not.empty())
      return r.travel > kStands_counts * stated.position_step
                 ? std::string()
                 : r.why_not + ": record strokes at several speeds";
    if (r.unexplained < kMostUnseen || SeesInertia(r) || SeesFriction(r)) return {};
    least = std::min(least, r.unexplained);
  }
  return "motion explains no more than " + RoundedText(100.0 * (1.0 - least)) +
         " % of the force's square, and neither an inertia nor friction shows in it: are " + force +
         " and position of one axis, of the same rows, and is the position right?";
}

}  // namespace contour::diagnosis
