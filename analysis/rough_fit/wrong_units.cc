#include "analysis/rough_fit/wrong_units.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "analysis/rough_fit/rough_fit.h"
#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

/// [relative] With an inertia that is known worse they do as well.
constexpr double kMostUncertain = 0.2;
/// [variance inflation factor] The usual bound: beyond it other columns say what this one says.
constexpr double kMostInflated = 10.0;
/// No model is off by so much; degrees, counts, millimetres, milliseconds and gears are.
constexpr double kOtherUnits = 10.0;

std::string Force(const AxisLog& log) { return log.linear ? "force_N" : "torque_Nm"; }

std::string TurnedRound(const AxisLog& log, const RoughFit& rough) {
  return "force and position have opposite signs: by least squares the inertia is " +
         RoundedText(rough.inertia) + " and friction " + RoundedText(rough.coulomb) +
         ". Turn one of them round, as by --columns " + Force(log) + "=HEADER*-1";
}

std::string Elsewhere(const AxisLog& log, const RoughFit& rough, double stated) {
  const bool less = rough.inertia < stated;
  const double times = less ? stated / rough.inertia : rough.inertia / stated;
  return std::string("by least squares the ") + (log.linear ? "mass is " : "inertia is ") +
         RoundedText(rough.inertia) + ", " + RoundedText(times) + " times " + (less ? "less" : "more") +
         " than the model states (" + RoundedText(stated) + "). Are time_s, " + Force(log) + " and " +
         (log.linear ? "position_m" : "the position") +
         " in the units that their names say, on the same side of any gear? Others come in by --columns "
         "NAME=HEADER*FACTOR. If all of it is right, state that " +
         (log.linear ? "mass" : "inertia");
}

}  // namespace

std::string WrongUnits(const AxisLog& log, const StatedAxis& stated) {
  if (std::all_of(log.command.begin(), log.command.end(), [](double u) { return u == 0.0; }))
    return Force(log) + " is 0 in every row";
  const RoughFit rough = FitRoughly(log, stated, RoughShape::kFrictionAndSpring);
  if (!rough.why_not.empty() || !(rough.unexplained < kMostUnexplained) ||
      !(rough.inertia_sigma_rel < kMostUncertain) || !(rough.inflation < kMostInflated))
    return {};
  if (rough.inertia < 0.0) {
    const bool pushes = rough.coulomb + 2.0 * rough.coulomb_sigma < 0.0;
    return pushes ? TurnedRound(log, rough) : std::string();
  }
  // Fast motion shows the motor alone, slow motion all of it.
  const double inertia = stated.motor_inertia + stated.load_inertia;
  const bool far =
      rough.inertia > kOtherUnits * inertia || kOtherUnits * rough.inertia < stated.motor_inertia;
  return far ? Elsewhere(log, rough, inertia) : std::string();
}

}  // namespace contour::diagnosis
