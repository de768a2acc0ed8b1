#pragma once

#include <string>
#include <vector>

#include "analysis/axis_model/axis_model.h"
#include "analysis/axis_model/stated_axis.h"

namespace contour::diagnosis {

/// A number of the stated model, with how far it may be off: value = stated * exp(x), x ~ N(0, sigma).
struct BaseTerm {
  std::string name;
  double stated = 0.0;
  double sigma = 0.0;
  double step = 0.0;      ///< of x, for differences of runs
  double start = 0.0;     ///< of x, of the first fit
  bool additive = false;  ///< value = stated + x instead
  bool nuisance = false;  ///< not a number of the stated model
  double* (*field)(AxisModel&) = nullptr;
};

/// The numbers of the model that its own uncertainty lets move, then what is no number of it: the roughness
/// of rest and where the bristles are at the guess.
std::vector<BaseTerm> MakeBaseTerms(const StatedAxis& stated, AxisModel nominal);

/// As the model file states it, or what a careful data sheet is worth.
double StatedSigma(const StatedAxis& stated, const std::string& name);

}  // namespace contour::diagnosis
