#include "analysis/rough_fit/fit_numbers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "analysis/prediction_error/fitted_half.h"
#include "analysis/prediction_error/problem.h"
#include "analysis/rough_fit/complete_from_log.h"
#include "analysis/rough_fit/lacking.h"
#include "analysis/rough_fit/likelier.h"
#include "analysis/rough_fit/position_jump.h"
#include "analysis/rough_fit/rough_fit.h"
#include "analysis/rough_fit/second_estimates.h"
#include "analysis/rough_fit/two_starts.h"
#include "analysis/rough_fit/unlike_directions.h"
#include "analysis/rough_fit/wrong_units.h"
#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

/// Relative deviation of what is to be found: half of all draws are within a factor of two.
constexpr double kFree = 1.0;
/// A number that is known no better is not known.
constexpr double kMostUncertain = 0.7;

struct Estimate {
  StatedAxis axis;
  std::vector<std::string> names;       ///< of what was fitted
  std::map<std::string, double> apart;  ///< relative, of what two starts end at
  std::vector<double> raw;              ///< prediction errors; the problem holds their noise
  bool converged = false, rigid = true;
  std::vector<Lacking> lacking;
};

Estimate Estimated(Problem& problem, const RoughFit& rough) {
  TwoStarts settled = FitFromTwoStarts(problem, rough);
  Estimate out;
  out.axis = FittedAxis(problem, settled.fit, FitHalves(problem, settled.fit));
  out.converged = settled.fit.converged;
  out.rigid = !problem.nominal.two_inertia;
  problem.LearnSignals(settled.fit.point);
  const FittedRun run{out.axis, problem.stated.friction, *problem.signals};
  out.lacking = out.rigid ? TryLacking(problem.log, run)
                          : TryLacking(WithCentreOfMass(problem.log, out.axis,
                                                        problem.Trace(settled.fit.point).table_position),
                                       run);
  AxisModel model = problem.Build(settled.fit.point);
  for (std::size_t i = 0; i < problem.terms.size(); ++i) {
    const BaseTerm& t = problem.terms[i];
    if (t.nuisance) continue;
    out.names.emplace_back(t.name);
    const double unit = t.additive ? std::fabs(*t.field(model)) : 1.0;
    if (const auto at = out.axis.sigma.find(t.name); at != out.axis.sigma.end() && unit > 0.0)
      at->second = std::max(at->second, std::max(settled.sigma[i], settled.apart[i]) / unit);
    if (settled.apart[i] > 0.0 && unit > 0.0) out.apart[t.name] = settled.apart[i] / unit;
  }
  out.raw = std::move(settled.fit.raw);
  return out;
}

Estimate Estimated(const AxisLog& log, const StatedAxis& stated, const RoughFit& rough, int threads) {
  Problem problem(log, stated, threads);
  return Estimated(problem, rough);
}

std::string Numbers(const Estimate& of) {
  for (const std::string& name : of.names) {
    const auto at = of.axis.sigma.find(name);
    if (at == of.axis.sigma.end() || !std::isfinite(at->second))
      return name +
             " came out as no number: the log does not fit the model at all; are force and position of "
             "one axis, and their signs right?";
    if (!(at->second > 0.0))
      return name + " has an interval of no width, which no measurement has: the log says nothing of it";
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

std::string WhyUnusable(const Estimate& of, const RoughFit& rough) {
  if (!rough.why_not.empty()) return rough.why_not + ": record strokes at several speeds";
  if (rough.unexplained > kMostUnexplained)
    return "motion explains no more than " + RoundedText(100.0 * (1.0 - rough.unexplained)) +
           " % of the force's square: are force and position of one axis, and their signs and units right?";
  const double level_sigma = std::max(rough.coulomb_sigma, rough.coulomb_by_parts * std::fabs(rough.coulomb));
  if (rough.coulomb < -kDisagree * level_sigma)
    return "by least squares friction pushes the axis on (" + RoundedText(rough.coulomb) + " to " +
           RoundedText(level_sigma) + "): " +
           (rough.one_direction
                ? "a constant force, a weight say, pushes it as well, and one direction does not tell the "
                  "two apart; record strokes in both directions"
                : "the model lacks something large (a coupling that swings, a drive at its limit); contour "
                  "diagnose looks for it");
  if (const std::string why = Numbers(of); !why.empty()) return why;
  if (const std::string why = Inertia(of.axis, rough); !why.empty()) return why;
  if (!of.converged)
    return "the fit did not settle: begin with a model that is nearer, or record more of what it is to say";
  return {};
}

void SayApart(const std::map<std::string, double>& apart, FittedNumbers& out) {
  std::string which;
  for (const auto& [name, by] : apart) {
    if (name != "inertia" && name != "Fc" && name != "s2") continue;
    which += (which.empty() ? "" : ", ") + name + " by " + RoundedText(100.0 * by) + " %";
  }
  if (which.empty()) return;
  out.notes.push_back(
      "The fit ends elsewhere when it begins at the stated numbers than at those of least "
      "squares (" +
      which +
      "). The deviations hold both ends; the model lacks something, "
      "which contour diagnose looks for.");
}

/// The inertia as least squares have it, which see it where the axis slides and turns slowly: what a model
/// lacks at rest, at a reversal or above a resonance does not reach them.
StatedAxis WithInertiaOfLeastSquares(StatedAxis stated, const RoughFit& rough) {
  const double factor = rough.inertia / (stated.motor_inertia + stated.load_inertia);
  stated.motor_inertia *= factor;
  stated.load_inertia *= factor;
  stated.sigma["inertia"] = 0.0;
  return stated;
}

/// Of a log in ampere all forces are known up to one factor, and the stated inertia says which.
void KeepStatedInertia(double stated_inertia, StatedAxis& axis) {
  const double factor = stated_inertia / (axis.motor_inertia + axis.load_inertia);
  StatedFriction& f = axis.friction;
  for (double* x :
       {&axis.motor_inertia, &axis.load_inertia, &axis.stiffness, &axis.damping, &axis.offset,
        &axis.torque_constant, &f.Fc_plus, &f.Fc_minus, &f.Fs_plus, &f.Fs_minus, &f.s0, &f.s1, &f.s2})
    *x *= factor;
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

/// How the model was completed where the two directions are not as it says of them.
struct Completed {
  StatedAxis stated;
  std::string note;
  double by_rel = 0.0;  ///< what the levels may be off by: nothing where the log decides
};

/// The likelier of a constant force and of levels of friction of their own: a model with neither has levels
/// that are right in no direction, and its other numbers make up for it.
Completed Complete(const UnlikeDirections& unlike, const AxisLog& log, const RoughFit& rough, int threads,
                   Estimate& of) {
  const std::string unit = log.linear ? " N" : " Nm";
  std::string what = log.linear ? "constant_force_N" : "constant_torque_Nm", other = "friction";
  Completed out{unlike.pulled, "", unlike.by_rel};
  Problem with_force(log, unlike.pulled, threads);
  of = Estimated(with_force, rough);
  bool decided = !unlike.uneven;
  if (unlike.uneven) {
    Problem with_levels(log, *unlike.uneven, threads);
    Estimate uneven = Estimated(with_levels, rough);
    const double levels_better_by = FirstIsBetterBy({with_levels, uneven.raw}, {with_force, of.raw});
    decided = std::fabs(levels_better_by) > kDisagree;
    if (levels_better_by > 0.0) {
      what = "levels of friction of their own";
      other = log.linear ? "a constant force" : "a constant torque";
      out.stated = *unlike.uneven;
      of = std::move(uneven);
    }
  }
  if (decided) out.by_rel = 0.0;
  out.note =
      "Forth and back differ from what the model says of them: by least squares the axis resists by " +
      RoundedText(unlike.forth) + unit + " forth and " + RoundedText(unlike.back) + unit +
      " back. The file has " + what + " for it" +
      (decided ? ", which the log has for much likelier than " : "; rows that slide do not tell it from ") +
      other + (decided ? "." : ", and contour diagnose says what the rest of the log tells.");
  return out;
}

/// Once more with the inertia of least squares, where prediction errors disagree with it.
void Settle(const AxisLog& log, const StatedAxis& stated, const RoughFit& rough, int threads,
            FittedNumbers& out, Estimate of) {
  const std::vector<Pair> pairs = TwoEstimates(of.axis, rough);
  if (of.rigid && !pairs.empty() && Disagree(pairs.front(), of.axis)) {
    const Pair p = pairs.front();
    Estimate again = Estimated(log, WithInertiaOfLeastSquares(stated, rough), rough, threads);
    out.unusable = WhyUnusable(again, rough);
    if (!out.unusable.empty()) return;
    of = std::move(again);
    of.axis.sigma["inertia"] = std::fabs(p.fitted - p.by_least_squares) / p.by_least_squares;
    out.notes.push_back("Two estimates of the inertia disagree beyond their deviations: " +
                        RoundedText(p.fitted) + " by prediction errors, " + RoundedText(p.by_least_squares) +
                        " by least squares. The file has the latter, and a deviation that holds both; the "
                        "model lacks something, which contour diagnose looks for.");
  }
  out.axis = std::move(of.axis);
  SayApart(of.apart, out);
}

}  // namespace

FittedNumbers FitNumbers(AxisLog log, StatedAxis stated, int threads) {
  FittedNumbers out;
  out.notes = CompleteFromLog(log, stated);
  if (out.unusable = WrongUnits(log, stated); !out.unusable.empty()) return out;
  if (out.unusable = PositionJump(log); !out.unusable.empty()) return out;
  RoughFit rough = FitRoughly(log, stated, RoughShape::kFriction, &stated.friction);
  for (const char* name : {"inertia", "load_inertia", "Fc", "Fs", "vs", "s0", "s1", "s2", "damping"})
    stated.sigma[name] = kFree;
  Estimate of;
  double levels_rel = 0.0;
  if (const auto unlike = FindUnlikeDirections(rough, stated)) {
    Completed completed = Complete(*unlike, log, rough, threads, of);
    stated = std::move(completed.stated);
    levels_rel = completed.by_rel;
    out.notes.push_back(std::move(completed.note));
  } else {
    of = Estimated(log, stated, rough, threads);
  }
  out.axis = of.axis;
  rough = FitRoughly(log, stated, RoughShape::kFriction, &of.axis.friction);
  std::vector<Lacking> lacking = of.lacking;
  out.unusable = WhyUnusable(of, rough);
  if (out.unusable.empty()) Settle(log, stated, rough, threads, out, std::move(of));
  if (!out.unusable.empty()) {
    out.unusable += WhatSaysMore(lacking, log);
    return out;
  }
  if (out.unusable = FarApart(out.axis, lacking, log); !out.unusable.empty()) return out;
  WidenAndSay(TwoEstimates(out.axis, rough), out.axis, out.notes);
  WidenByLacking(lacking, log, out.axis, out.notes);
  if (out.axis.sigma.at("inertia") > kMostUncertain) {
    out.unusable = UnknownInertia(out.axis, rough) + WhatSaysMore(lacking, log);
    return out;
  }
  SayOneDirection(rough, out);
  for (const char* level : {"Fc", "Fs"})
    if (levels_rel > 0.0) out.axis.sigma[level] = std::max(out.axis.sigma[level], levels_rel);
  if (stated.open.contains("ampere")) {
    KeepStatedInertia(stated.motor_inertia + stated.load_inertia, out.axis);
    SayAmpere(out.axis, log.linear, out.notes);
  }
  return out;
}

}  // namespace contour::diagnosis
