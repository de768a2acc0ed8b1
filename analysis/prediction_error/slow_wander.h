#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace contour::diagnosis {

/// A first-order wander next to white noise of unit variance: what a linear scale does over seconds and
/// minutes, of which the taps of a Whitener know nothing. Unless it is in the noise, whatever goes with the
/// position or with time in steps of seconds follows it and passes for evidence.
struct SlowWander {
  double memory_rows = 1.0;
  double variance = 0.0;  ///< 0: none

  bool operator==(const SlowWander&) const = default;
};

/// The likeliest of `white`, rows with their root weights (0: does not count); it begins anew at `begins`.
SlowWander LearnSlowWander(std::span<const double> white, std::span<const double> root_weight,
                           std::span<const std::size_t> begins);

/// Takes out of weighted rows what those before say of them: innovations of unit variance. Linear in the rows
/// of a column, the same for all columns. `per_row`: rows of the log that each stands for, in its weight.
void TakeOutWander(const SlowWander& wander, std::span<const double> root_weight,
                   std::span<const std::size_t> begins, double per_row, std::span<double* const> columns);

/// What the innovations' variances add to the sum of squares in -2 log likelihood beyond the weights.
double LogVariances(const SlowWander& wander, std::span<const double> root_weight,
                    std::span<const std::size_t> begins);

}  // namespace contour::diagnosis
