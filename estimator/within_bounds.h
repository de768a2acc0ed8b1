#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace contour {

/// Moves the mean of a Gaussian to the point of a box that is nearest to it in the metric of its covariance,
/// so to the most likely values that keep all bounds: what a value at its bound is off by, the others make up
/// for along the covariance, and one that would have reached its bound for another's sake alone leaves it
/// again. A dual active-set method (Goldfarb and Idnani, 1983): it ends after finitely many steps, however
/// many values are at their bounds. `bound`: largest size of each value; infinity where there is none.
template <std::size_t N>
class WithinBounds {
 public:
  using Row = std::array<double, N>;
  using Matrix = std::array<Row, N>;

  WithinBounds(const Matrix& covariance, const Row& bound) noexcept
      : covariance_(covariance), bound_(bound) {}

  /// False: not settled; values beyond their bounds are cut off at them.
  bool Move(Row& value) noexcept {
    held_ = 0;
    bool settled = false;
    for (std::size_t step = 0; step < kSteps; ++step) {
      const std::size_t worst = Worst(value);
      if (worst == N) {
        settled = true;
        break;
      }
      if (!Bring(worst, value)) break;
    }
    for (std::size_t i = 0; i < N; ++i) value[i] = std::clamp(value[i], -bound_[i], bound_[i]);
    return settled;
  }

 private:
  // Each adds one bound or takes one away; problems of this size need few more than there are bounds kept.
  static constexpr std::size_t kSteps = 16 * N;
  // Of a bound, or of a variance: no more than rounding.
  static constexpr double kRounding = 1e-12;
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  struct Bound {
    std::size_t of = 0;
    double side = 1.0;     ///< 1 above, -1 below
    double pushes = 0.0;   ///< multiplier, at least 0
    double answers = 0.0;  ///< of the multiplier, per unit of the one that is brought in
  };

  // By which each value is beyond its bound, in its own standard deviations; N: none is.
  [[nodiscard]] std::size_t Worst(const Row& value) const noexcept {
    std::size_t worst = N;
    double most = 0.0;
    for (std::size_t i = 0; i < N; ++i) {
      const double beyond = std::abs(value[i]) - bound_[i] * (1.0 + kRounding);
      if (!(beyond > 0.0) || !(covariance_[i][i] > 0.0)) continue;
      const double deviations = beyond / std::sqrt(covariance_[i][i]);
      if (deviations <= most) continue;
      most = deviations;
      worst = i;
    }
    return worst;
  }

  /// Until the value is at its bound, letting go of others whose multiplier comes to nothing on the way.
  bool Bring(std::size_t in, Row& value) noexcept {
    Bound coming{in, value[in] > 0.0 ? 1.0 : -1.0, 0.0, 0.0};
    for (std::size_t step = 0; step < kSteps; ++step) {
      Row direction;
      if (!Along(coming, direction)) return false;
      const double moves = -coming.side * direction[in];  // variance that is left beside those held
      const bool can = moves > kRounding * covariance_[in][in];
      const double whole = can ? (coming.side * value[in] - bound_[in]) / moves : kNever;
      std::size_t first = held_;
      double least = whole;
      for (std::size_t h = 0; h < held_; ++h)
        if (held_bounds_[h].answers > 0.0 && held_bounds_[h].pushes / held_bounds_[h].answers < least) {
          least = held_bounds_[h].pushes / held_bounds_[h].answers;
          first = h;
        }
      if (!std::isfinite(least)) return false;
      if (can)
        for (std::size_t i = 0; i < N; ++i) value[i] += least * direction[i];
      for (std::size_t h = 0; h < held_; ++h) held_bounds_[h].pushes -= least * held_bounds_[h].answers;
      coming.pushes += least;
      if (first == held_) {
        value[in] = coming.side * bound_[in];
        held_bounds_[held_++] = coming;
        return true;
      }
      std::copy(held_bounds_.begin() + first + 1, held_bounds_.begin() + held_, held_bounds_.begin() + first);
      --held_;
    }
    return false;
  }

  /// Where the values go when this bound pushes and those that are held stay where they are; what those
  /// answer. False: those held do not determine it.
  bool Along(const Bound& coming, Row& direction) noexcept {
    std::array<std::array<double, N + 1>, N> rows{};
    for (std::size_t h = 0; h < held_; ++h) {
      for (std::size_t g = 0; g < held_; ++g) rows[h][g] = Signed(held_bounds_[h], held_bounds_[g]);
      rows[h][held_] = Signed(held_bounds_[h], coming);
    }
    // Positive definite, so pivots stay on the diagonal.
    for (std::size_t p = 0; p < held_; ++p) {
      if (!(rows[p][p] > kRounding * covariance_[held_bounds_[p].of][held_bounds_[p].of])) return false;
      for (std::size_t r = p + 1; r < held_; ++r) {
        const double share = rows[r][p] / rows[p][p];
        for (std::size_t c = p; c <= held_; ++c) rows[r][c] -= share * rows[p][c];
      }
    }
    for (std::size_t p = held_; p-- > 0;) {
      double rest = rows[p][held_];
      for (std::size_t c = p + 1; c < held_; ++c) rest -= rows[p][c] * held_bounds_[c].answers;
      held_bounds_[p].answers = rest / rows[p][p];
    }
    for (std::size_t i = 0; i < N; ++i) {
      direction[i] = -coming.side * covariance_[i][coming.of];
      for (std::size_t h = 0; h < held_; ++h)
        direction[i] += held_bounds_[h].answers * held_bounds_[h].side * covariance_[i][held_bounds_[h].of];
    }
    for (std::size_t h = 0; h < held_; ++h) direction[held_bounds_[h].of] = 0.0;
    return true;
  }

  [[nodiscard]] double Signed(const Bound& a, const Bound& b) const noexcept {
    return a.side * b.side * covariance_[a.of][b.of];
  }

  const Matrix& covariance_;
  const Row& bound_;
  std::array<Bound, N> held_bounds_{};
  std::size_t held_ = 0;
};

}  // namespace contour
