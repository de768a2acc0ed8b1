#pragma once

#include "analysis/diagnosis/causes/cause_definition.h"

// Causes that are a shape over the stroke, as a sum of basis functions.
namespace contour::diagnosis {

/// Over the stroke as travelled: cosines of `first` to `last` half periods, or Legendre polynomials from
/// degree 1.
std::vector<SharedSignal> Cosines(const Signals& s, int first, int last);
std::vector<SharedSignal> LegendrePolynomials(const Signals& s, int last);

/// A basis function over the stroke, -1 to 1; `number` counts from 1.
using StrokeBasis = double (*)(unsigned number, double place);
double CosineAt(unsigned number, double place);
double LegendreAt(unsigned number, double place);

/// How a shape is told: as a table over the stroke.
struct StrokeShape {
  Required<std::string_view> ordinate;
  Required<double> per_unit;  ///< of the ordinate in the effect's own unit
  Required<StrokeBasis> basis;
};

/// The sum of amplitudes times the basis, at table positions from the middle of the stroke.
Signal OverStroke(const Signals& s, const std::vector<double>& amplitudes, StrokeBasis basis,
                  const std::vector<double>& at_m);
std::vector<double> StrokeGrid(const Signals& s);

/// Half of highest minus lowest over the stroke, of a sum of cosines.
double HalfRange(const FittedEffect& fitted);

}  // namespace contour::diagnosis
