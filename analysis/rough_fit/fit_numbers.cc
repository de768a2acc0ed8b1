#include "analysis/rough_fit/fit_numbers.h"

#include <algorithm>
#include <cmath>

#include "analysis/prediction_error/fitted_half.h"
#include "analysis/prediction_error/problem.h"
#include "analysis/rough_fit/complete_from_log.h"
#include "analysis/rough_fit/position_jump.h"
#include "analysis/rough_fit/rough_fit.h"
#include "analysis/rough_fit/wrong_units.h"
#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

/// Relative deviation of what is to be found: half of all draws are within a factor of two.
constexpr double kFree = 1.0;
/// A number that is known no better is not known.
constexpr double kMostUncertain = 0.7;
/// Two estimates of one inertia.
constexpr double kFarApart = 1.5;
/// Of least squares, from where they say nothing of it.
constexpr double kLeastSure = 0.2;
/// [deviations; share of the level] From where two directions are not alike.
constexpr double kSure = 4.0, kUnlike_rel = 0.1;
constexpr FitEffort kThorough = {.most_steps = 40, .most_refreshes = 12, .close_enough = 0.1};

std::string Numbers(const StatedAxis& axis, const Problem& problem) {
  for (const BaseTerm& t : problem.terms) {
    if (t.nuisance) continue;
    const auto at = axis.sigma.find(t.name);
    if (at == axis.sigma.end() || !std::isfinite(at->second))
      return t.name +
             " came out as no number: the log does not fit the model at all; are force and position of "
             "one axis, and their signs right?";
    if (!(at->second > 0.0))
      return t.name + " has an interval of no width, which no measurement has: the log says nothing of it";
  }
  return {};
}

/// Least squares ask for no more than rows that accelerate. Where they have them and the prediction errors
/// say nothing, these are full of what the model has not.
std::string UnknownInertia(const StatedAxis& axis, const RoughFit& rough) {
  const std::string known = RoundedText(100.0 * axis.sigma.at("inertia")) + " %";
  if (!rough.why_not.empty() || rough.inertia_sigma_rel > kLeastSure)
    return "the log says nothing of the inertia (to " + known +
           " only): record quick reversals, with as much acceleration as the axis may have";
  return "prediction errors say nothing of the inertia (to " + known + " only), though the log accelerates " +
         "enough to tell it (" + RoundedText(rough.inertia) + " to " +
         RoundedText(100.0 * rough.inertia_sigma_rel) +
         " % by least squares): the model lacks something that goes with the motion (a ripple, a weight, a "
         "cable); contour diagnose names it";
}

std::string Inertia(const StatedAxis& axis, const RoughFit& rough) {
  if (axis.sigma.at("inertia") > kMostUncertain) return UnknownInertia(axis, rough);
  const double fitted = axis.motor_inertia + axis.load_inertia;
  const double apart = fitted / rough.inertia;
  if (!rough.why_not.empty() || rough.inertia_sigma_rel > kLeastSure ||
      (apart < kFarApart && apart > 1.0 / kFarApart))
    return {};
  return "two estimates of the inertia disagree, " + RoundedText(fitted) + " by prediction errors and " +
         RoundedText(rough.inertia) +
         " by least squares: the model lacks something large, or delay_ms and lag_ms are others; contour "
         "diagnose "
         "names it";
}

std::string WhyUnusable(const Problem& problem, const Fit& fit, const StatedAxis& axis,
                        const RoughFit& rough) {
  if (!rough.why_not.empty()) return rough.why_not + ": record strokes at several speeds";
  if (rough.unexplained > kMostUnexplained)
    return "motion explains no more than " + RoundedText(100.0 * (1.0 - rough.unexplained)) +
           " % of the force's square: are force and position of one axis, and their signs and units right?";
  if (const std::string why = Numbers(axis, problem); !why.empty()) return why;
  if (const std::string why = Inertia(axis, rough); !why.empty()) return why;
  if (!fit.converged)
    return "the fit did not settle: begin with a model that is nearer, or record more of what it is to say";
  return {};
}

/// Friction and a constant force act alike on an axis that goes in one direction; of the other such a log
/// says nothing.
void SayOneDirection(const RoughFit& rough, FittedNumbers& out) {
  if (!rough.one_direction) return;
  for (const char* level : {"Fc", "Fs"}) out.axis.sigma[level] = kFree;
  out.notes.emplace_back(
      "The log moves in one direction only: its friction and a constant force cannot be told apart. The "
      "Coulomb level is the sum of both, and that of the other direction is taken to be the same; record "
      "strokes in both.");
}

/// The model states how the two directions' levels relate, and the fit keeps that; where the log has it
/// otherwise, the levels are none of either.
void SayUnlikeDirections(const RoughFit& rough, const StatedAxis& stated, const AxisLog& log,
                         FittedNumbers& out) {
  const StatedFriction& f = stated.friction;
  // A force that is stated is fitted with the rest.
  if (rough.one_direction || !(rough.coulomb > 0.0) || stated.offset != 0.0 ||
      !(f.Fc_plus + f.Fc_minus > 0.0))
    return;
  const double as_stated = 0.5 * (rough.coulomb_forth + rough.coulomb_back) * (f.Fc_plus - f.Fc_minus) /
                           (0.5 * (f.Fc_plus + f.Fc_minus));
  const double apart = rough.coulomb_forth - rough.coulomb_back;
  if (std::abs(apart - as_stated) < std::max(kSure * rough.coulomb_sigma, kUnlike_rel * rough.coulomb))
    return;
  // What is written is off by half of the difference, whatever the fit makes of it.
  for (const char* level : {"Fc", "Fs"}) {
    double& sigma = out.axis.sigma[level];
    sigma = std::max(sigma, 0.5 * std::abs(apart - as_stated) / rough.coulomb);
  }
  const std::string unit = log.linear ? " N" : " Nm";
  out.notes.push_back(
      "Forth and back differ from what the model says of them: by least squares the axis resists by " +
      RoundedText(rough.coulomb_forth) + unit + " forth and " + RoundedText(rough.coulomb_back) + unit +
      " back, by friction or a constant force. The levels in the file keep the stated ratio and are "
      "right for neither; contour diagnose says which of the two it is.");
}

}  // namespace

FittedNumbers FitNumbers(AxisLog log, StatedAxis stated, int threads) {
  FittedNumbers out;
  out.notes = CompleteFromLog(log, stated);
  if (out.unusable = WrongUnits(log, stated); !out.unusable.empty()) return out;
  if (out.unusable = PositionJump(log); !out.unusable.empty()) return out;
  const RoughFit rough = FitRoughly(log, stated);
  for (const char* name : {"inertia", "load_inertia", "Fc", "Fs", "vs", "s0", "s1", "s2", "damping"})
    stated.sigma[name] = kFree;
  Problem problem(log, stated, threads);
  Point start;
  for (const BaseTerm& t : problem.terms) start.base.push_back(t.start);
  problem.LearnOutliers(start);
  problem.LearnNoise(start);
  Fit fit = FitPoint(problem, start, kThorough);
  for (int round = 0; round < 2; ++round) {
    problem.LearnNoise(fit.point);
    fit = FitPoint(problem, fit.point, kThorough);
  }
  out.axis = FittedAxis(problem, fit, FitHalves(problem, fit));
  out.unusable = WhyUnusable(problem, fit, out.axis, rough);
  SayOneDirection(rough, out);
  SayUnlikeDirections(rough, stated, log, out);
  return out;
}

}  // namespace contour::diagnosis
