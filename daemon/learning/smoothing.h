#pragma once

#include <vector>

namespace contour {

/// A bell that turns no phase: what was early or late stays where it is. Half the power passes at
/// `bandwidth_Hz`. Beyond the ends there are zeros.
class Smoothing {
 public:
  Smoothing(double bandwidth_Hz, double period_s);
  [[nodiscard]] std::vector<float> Of(const std::vector<float>& values) const;

 private:
  std::vector<float> half_;  ///< weight of a value at a distance of so many periods
};

}  // namespace contour
