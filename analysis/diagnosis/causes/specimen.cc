#include "analysis/diagnosis/causes/specimen.h"

#include <cmath>

namespace contour::diagnosis {

double SizeAsStated(double factor, double main_parameter) { return factor * std::abs(main_parameter); }

double Between(double low, double high, const UniformNumbers& uniform) {
  return low + (high - low) * uniform();
}

double BetweenInLogarithm(double low, double high, const UniformNumbers& uniform) {
  return low * std::exp(uniform() * std::log(high / low));
}

double WholePeriods(const SpecimenMachine& machine, const UniformNumbers& uniform) {
  return (uniform() < 0.5 ? 1.0 : 2.0) * machine.emulated_stroke_mm / machine.travel_mm;
}

}  // namespace contour::diagnosis
