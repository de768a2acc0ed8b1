#pragma once

#include <algorithm>
#include <cstdint>

namespace contour {

/// Whether a filter's innovations are what the filter says of them. Their mean square, in standard
/// deviations, is 1 when model and noise are right (chi-square with one degree of freedom each); a wrong
/// model makes it larger, and far beyond `sigma`^2 no number of the filter means anything.
class InnovationWatch {
 public:
  struct Bounds {
    double sigma = 48.0;     ///< 0: not watched
    double explained = 0.0;  ///< root mean square that a model off by much explains: never an alarm
    std::int32_t samples = 500;
    std::int32_t gated = 20;  ///< in a row; 0: not watched
  };
  InnovationWatch() noexcept = default;
  explicit InnovationWatch(const Bounds& bounds) noexcept
      : bounds_(bounds),
        least_std_(bounds.sigma > 0.0 ? bounds.explained / bounds.sigma : 0.0),
        share_(1.0 / static_cast<double>(bounds.samples)) {}

  void Reset() noexcept {
    mean_square_ = 1.0;
    above_ = gated_ = 0;
  }

  /// One measurement; a standard deviation of 0: there was none. True once per bound reached.
  bool Step(double innovation, double std, bool gated) noexcept {
    if (!(std > 0.0)) return false;
    gated_ = gated ? gated_ + 1 : 0;
    // What is gated is counted above; a single one is not to stand for a whole mean.
    if (!gated) {
      const double ratio = innovation / std::max(std, least_std_);
      mean_square_ += share_ * (ratio * ratio - mean_square_);
    }
    const bool above = bounds_.sigma > 0.0 && mean_square_ > bounds_.sigma * bounds_.sigma;
    above_ = above ? above_ + 1 : 0;
    if (bounds_.gated != 0 && gated_ >= bounds_.gated) {
      gated_ = 0;
      return true;
    }
    if (above_ < bounds_.samples) return false;
    above_ = 0;
    return true;
  }

  [[nodiscard]] double mean_square() const noexcept { return mean_square_; }

 private:
  Bounds bounds_;
  double least_std_ = 0.0;
  double share_ = 1.0;
  double mean_square_ = 1.0;
  std::int32_t above_ = 0;
  std::int32_t gated_ = 0;
};

}  // namespace contour
