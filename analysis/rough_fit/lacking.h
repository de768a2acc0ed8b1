#pragma once

#include <string>
#include <vector>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/prediction_error/signals.h"
#include "analysis/recording/axis_log.h"

namespace contour::diagnosis {

/// A number as least squares would have it, and its deviation by what the parts of the log say.
struct RoughNumber {
  double value = 0.0, sigma = 0.0;
};

/// One thing that a rigid axis with Coulomb and viscous friction does not have, put into its equation: what
/// the numbers of the axis are then. Its residual may be small and go through all parts of the log alike, so
/// that no scatter shows it, and yet the numbers be far off.
struct Lacking {
  enum class What {
    kLessForce,  ///< large forces do less than they say: the rows of small ones have other numbers
    kCurve,      ///< friction that is no straight line over the speed
    kFalls,  ///< the same, where the fit has friction that falls for it: with no more of that than is stated
    kDirection,  ///< viscous friction of each direction
    kTime,       ///< friction that changes in the course of the log
    kPlace,      ///< friction that goes with the place
    kSpring,     ///< a force that goes with the place
  };
  What what;
  RoughNumber inertia, coulomb, viscous;
  /// What least squares without it have.
  double inertia_without = 0.0, coulomb_without = 0.0, viscous_without = 0.0;
  /// What the level and the viscous friction go up and down by, root mean square, where they do.
  double level_varies = 0.0, viscous_varies = 0.0;
  /// Deviations from nothing, of the largest of what was put in or, of rows of small forces, of the inertia.
  double sure = 0.0;
  double explains = 0.0;     ///< share of what is left without it, of the rows that were looked at
  double unexplained = 1.0;  ///< share of the command's square that is left with it, of the same rows
  double below = 0.0;        ///< of rows of small forces: the largest
};

/// An axis as prediction errors have it, and a run of its model along the log (Problem::LearnSignals).
struct FittedRun {
  const StatedAxis& axis;
  const StatedFriction& stated;
  const Signals& traced;
};

/// All that can be tried, of the rows that slide (RESET of Ramsey, J. R. Stat. Soc. B 31(2), 1969: further
/// columns made of the motion and of the fitted force, and the same equation over rows of small force alone).
/// Friction as fitted is taken out before, with what it does about rest, and the numbers are moved from
/// there.
std::vector<Lacking> TryLacking(const AxisLog& log, const FittedRun& run);

/// The log with the position of the centre of mass, which is what the whole force accelerates, by the
/// position of the load (Problem::Trace).
AxisLog WithCentreOfMass(AxisLog log, const StatedAxis& axis, const Signal& load_position);

/// In plain words, and what to do about it.
std::string TextOf(const Lacking& lacking, bool linear);

/// Share of rows that have exactly the largest command of the log: the limit of what asks for it.
double ShareAtLimit(const AxisLog& log);

}  // namespace contour::diagnosis
