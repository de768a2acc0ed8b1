#include "analysis/rough_fit/second_estimates.h"

#include <algorithm>
#include <cmath>

#include "analysis/rough_fit/two_starts.h"
#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

/// A deviation grows by what two estimates differ by beyond their own (as that of means of groups does,
/// DerSimonian and Laird, Controlled Clinical Trials 7, 1986), and by what the number goes up and down by.
void Widen(double fitted, double apart, double other_sigma, double varies, double& sigma) {
  if (!(fitted > 0.0)) return;
  const double own = sigma * fitted;
  const double beyond = apart * apart + varies * varies - own * own - other_sigma * other_sigma;
  if (beyond > 0.0) sigma = std::sqrt(own * own + beyond) / fitted;
}

bool FarBeyond(double apart, double fitted, double other_sigma, double sigma) {
  return std::fabs(apart) > kDisagree * std::hypot(sigma * fitted, other_sigma);
}

double InertiaOf(const StatedAxis& axis) { return axis.motor_inertia + axis.load_inertia; }
double LevelOf(const StatedAxis& axis) { return 0.5 * (axis.friction.Fc_plus + axis.friction.Fc_minus); }

bool Certain(const Lacking& l) {
  return l.sure > kDisagree && l.inertia.value > 0.0 && l.inertia.sigma < kLeastSure * l.inertia.value;
}

std::string AtLimit(const Lacking& l, const AxisLog& log) {
  if (l.what != Lacking::What::kLessForce) return {};
  const double share = ShareAtLimit(log);
  if (share * static_cast<double>(log.size()) < static_cast<double>(kPartsOfLog)) return {};
  return "; " + RoundedText(100.0 * share) +
         " % of the rows ask for exactly the largest force, which is a limit of what asks";
}

std::string NumbersOf(const Lacking& l) {
  return "inertia " + RoundedText(l.inertia.value) + ", Coulomb level " + RoundedText(l.coulomb.value) +
         ", viscous friction " + RoundedText(l.viscous.value);
}

/// Of each kind the one that explains most.
std::vector<Lacking> BestOfEach(const std::vector<Lacking>& lacking) {
  std::vector<Lacking> out;
  for (const Lacking& l : lacking) {
    const auto same =
        std::find_if(out.begin(), out.end(), [&](const Lacking& o) { return o.what == l.what; });
    if (same == out.end())
      out.push_back(l);
    else if (l.explains > same->explains)
      *same = l;
  }
  return out;
}

}  // namespace

std::vector<Pair> TwoEstimates(const StatedAxis& axis, const RoughFit& rough) {
  std::vector<Pair> out;
  if (!SaysEnough(rough)) return out;
  const auto add = [&](const Pair& p) {
    if (axis.sigma.contains(p.name) && p.fitted > 0.0) out.push_back(p);
  };
  add({"inertia", "the inertia", InertiaOf(axis), rough.inertia,
       std::max(rough.inertia_by_parts, rough.inertia_sigma_rel)});
  if (rough.one_direction) return out;
  add({"Fc", "the Coulomb level", LevelOf(axis), rough.coulomb,
       std::max(rough.coulomb_by_parts, rough.coulomb_sigma / rough.coulomb)});
  add({"s2", "the viscous friction", axis.friction.s2, rough.viscous, rough.viscous_by_parts});
  return out;
}

bool Disagree(const Pair& p, const StatedAxis& axis) {
  return FarBeyond(p.fitted - p.by_least_squares, p.fitted, p.by_parts * p.by_least_squares,
                   axis.sigma.at(p.name));
}

void WidenAndSay(const std::vector<Pair>& pairs, StatedAxis& axis, std::vector<std::string>& notes) {
  for (const Pair& p : pairs) {
    const bool say = Disagree(p, axis);
    Widen(p.fitted, p.fitted - p.by_least_squares, p.by_parts * p.by_least_squares, 0.0, axis.sigma[p.name]);
    if (!say) continue;
    notes.push_back(std::string("Two estimates of ") + p.text + " disagree beyond their deviations: " +
                    RoundedText(p.fitted) + " by prediction errors, " + RoundedText(p.by_least_squares) +
                    " by least squares. The deviation holds both; the model lacks something, which contour "
                    "diagnose looks for.");
  }
}

void WidenByLacking(const std::vector<Lacking>& lacking, const AxisLog& log, StatedAxis& axis,
                    std::vector<std::string>& notes) {
  const double inertia = InertiaOf(axis), level = LevelOf(axis), viscous = axis.friction.s2;
  const auto before = axis.sigma;
  bool curve_said = false;
  // What least squares have with it and without it alike, it does not move; where the fit is off from both,
  // that is for WidenAndSay.
  const auto apart = [&](const char* name, double fitted, const RoughNumber& other, double without,
                         double varies) {
    const auto own = before.find(name);
    if (own == before.end()) return false;
    const double from_fit = fitted - other.value, from_without = without - other.value;
    const double off = std::min(std::fabs(from_fit), std::fabs(from_without));
    Widen(fitted, off, other.sigma, varies, axis.sigma[name]);
    return FarBeyond(off, fitted, other.sigma, own->second) ||
           FarBeyond(varies, fitted, other.sigma, own->second);
  };
  for (const Lacking& l : BestOfEach(lacking)) {
    bool say = apart("inertia", inertia, l.inertia, l.inertia_without, 0.0);
    say |= apart("Fc", level, l.coulomb, l.coulomb_without, l.level_varies);
    say |= apart("s2", viscous, l.viscous, l.viscous_without, l.viscous_varies);
    if (!say || !Certain(l)) continue;
    // It is the same curve.
    if (l.what == Lacking::What::kFalls && curve_said) continue;
    curve_said |= l.what == Lacking::What::kCurve;
    notes.push_back("The model lacks something: " + TextOf(l, log.linear) + ", which leaves " +
                    RoundedText(100.0 * (1.0 - l.explains)) +
                    " % of what least squares leave without it, and would make " + NumbersOf(l) +
                    ". The deviations hold that, too; contour diagnose looks for it" + AtLimit(l, log) + ".");
  }
  // What the level goes up and down by, break-away does.
  const auto at = before.find("Fc");
  if (at != before.end() && axis.sigma.contains("Fs"))
    axis.sigma["Fs"] = std::max(axis.sigma["Fs"], axis.sigma["Fc"] > at->second ? axis.sigma["Fc"] : 0.0);
}

std::string FarApart(const StatedAxis& axis, const std::vector<Lacking>& lacking, const AxisLog& log) {
  for (const Lacking& l : BestOfEach(lacking)) {
    if (!Certain(l)) continue;
    const double ratio = InertiaOf(axis) / l.inertia.value;
    if (ratio < kFarApart && ratio > 1.0 / kFarApart) continue;
    return "the inertia came out as " + RoundedText(InertiaOf(axis)) + ", but " + TextOf(l, log.linear) +
           " it is " + RoundedText(l.inertia.value) + AtLimit(l, log);
  }
  return {};
}

std::string WhatSaysMore(const std::vector<Lacking>& lacking, const AxisLog& log) {
  const Lacking* best = nullptr;
  for (const Lacking& l : lacking)
    if (Certain(l) && l.unexplained < kMostUnexplained && (best == nullptr || l.explains > best->explains))
      best = &l;
  if (best == nullptr) return {};
  return ". By least squares " + TextOf(*best, log.linear) + " motion explains " +
         RoundedText(100.0 * (1.0 - best->unexplained)) + " %: " + NumbersOf(*best) + AtLimit(*best, log);
}

}  // namespace contour::diagnosis
