#pragma once

#include <cmath>
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/diagnosis/causes/cause_definition.h"

// What extensions are made of.
namespace contour::diagnosis {

/// A parameter of a cause; where it has none, or none that is a number, `otherwise`.
double ValueOf(const Cause& cause, const std::string& name, double otherwise = 0.0);

/// The table over the stroke; null without one.
const ShapeTable* TableOverStroke(const Cause& cause);

enum class Joined { kSum, kFactors };  ///< of factors 1 + y

/// The shape joined to the table that is there, at the points of both, thinned to what a person can read.
void AddTable(const ShapeTable& shape, Joined how, std::vector<double>& x, std::vector<double>& y);

double HalfRange(const std::vector<double>& y);

template <class T>
T& Existing(std::optional<T>& e) {
  return e ? *e : e.emplace();
}

template <auto member>
void RemoveExtension(ExtensionsConfig& e) {
  (e.*member).reset();
}

/// A wave added to those that are there; of the same order, their sum.
template <class Extension, class Wave>
void AddWave(std::optional<Extension>& to, double Wave::*amplitude, const Wave& wave) {
  if (!to) {
    to.emplace();
    static_cast<Wave&>(*to) = wave;
    return;
  }
  std::vector<Wave*> all = {&*to};
  for (Wave& w : to->further) all.push_back(&w);
  for (Wave* w : all) {
    if (std::abs(w->order_per_rev - wave.order_per_rev) > 1e-9) continue;
    const std::complex<double> sum =
        std::polar(w->*amplitude, w->phase_rad) + std::polar(wave.*amplitude, wave.phase_rad);
    w->*amplitude = std::abs(sum);
    w->phase_rad = std::arg(sum);
    return;
  }
  to->further.push_back(wave);
}

void AddRipple(const Cause& cause, std::optional<RippleExtension>& to);
Assignments RippleInSimulation(std::string_view effect, const std::optional<RippleExtension>& ripple);

/// A ripple of validation.
Assignments DrawnRipple(std::string_view effect, const Drawn& drawn);

}  // namespace contour::diagnosis
