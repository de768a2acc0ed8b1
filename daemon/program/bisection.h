#pragma once

namespace contour {

/// The largest number between `low` and `high` that fits, where smaller ones fit when a larger one does;
/// `low` when none above it does. 60 halvings exhaust a double.
template <class Fits>
double LargestThat(Fits&& fits, double low, double high) {
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (fits(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace contour
