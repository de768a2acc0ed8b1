#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "estimator/square_root.h"

namespace contour {

enum class UpdateResult : std::uint8_t {
  kOk,
  kGated,  ///< the measurement was too far off to be believed; state and covariance are unchanged
};

/// A measurement further from its prediction than `sigmas` standard deviations of the innovation and further
/// than `absolute` is not believed. (An outlier once let in ruins a filter for good.)
struct InnovationGate {
  double sigmas = 12.0;
  double absolute = 0.0;
};

/// Which gate a reading has to pass. One reading that is suddenly off may come of a SYNC that came late, or
/// of a flipped bit; the next one tells. So the first is left out, and what lasts is believed, until readings
/// have been as foretold for a while: to leave out one of every few would make a loop swing by itself. Nor is
/// sudden what follows from readings that were off before: at speed SYNCs come a little late or early all the
/// time, and a loop that answers one of them rings.
class SuddenGate {
 public:
  SuddenGate(const InnovationGate& gate, double sudden_m) noexcept
      : gate_{gate.sigmas, kTwoPeriods * gate.absolute},
        sudden_m_(std::min(gate.absolute, sudden_m)),
        first_{gate.sigmas, sudden_m_} {}

  [[nodiscard]] const InnovationGate& gate() const noexcept { return off_ || lasts_ > 0 ? gate_ : first_; }
  /// What no reading in a row with others may be further off by.
  [[nodiscard]] double most_m() const noexcept { return gate_.absolute; }
  /// Whether this reading is to be left out. To be asked once of each.
  bool LeavesOut(double innovation_m, double std_m) noexcept {
    const double size_m = std::abs(innovation_m);
    const double usual_m = gate_.sigmas * std_m;
    const bool off = !(size_m <= std::max(usual_m, first_.absolute));
    const bool believes = off_ || lasts_ > 0;
    lately_m_ = std::max(kKeeps * lately_m_, off ? 0.0 : size_m);
    first_.absolute = std::min(std::max(sudden_m_, kTwoPeriods * lately_m_), gate_.absolute);
    if (off && believes)
      lasts_ = kBelieved;
    else if (lasts_ > 0)
      --lasts_;
    off_ = off;
    return off && !(believes && size_m <= std::max(usual_m, gate_.absolute));
  }
  /// The same of one that was judged by gate().
  void After(double innovation_m, double std_m) noexcept { LeavesOut(innovation_m, std_m); }
  void Reset() noexcept {
    off_ = false;
    lasts_ = 0;
    lately_m_ = 0.0;
    first_.absolute = sudden_m_;
  }

  /// What a force has done in two periods, over one.
  static constexpr double kTwoPeriods = 4.0;
  /// Readings in a row as foretold: more than a period of any swing of a loop.
  static constexpr int kBelieved = 100;
  /// In which what they were off by before is forgotten; at each.
  static constexpr double kKeeps = 1.0 - 1.0 / kBelieved;

 private:
  InnovationGate gate_;
  double sudden_m_;
  InnovationGate first_;   ///< of a reading that follows others as foretold
  bool off_ = false;       ///< the reading before was suddenly off
  int lasts_ = 0;          ///< readings until one that is off is left out again
  double lately_m_ = 0.0;  ///< largest innovation that was not off, forgotten in as many readings
};

/// An encoder that disagrees for so long has really moved: filters start again from it.
inline constexpr double kGatedBeforeRestart_s = 20e-3;
[[nodiscard]] inline bool StartsAgain(std::uint32_t gated_in_a_row, double period_s) noexcept {
  return (gated_in_a_row + 0.5) * period_s >= kGatedBeforeRestart_s;
}

struct Innovation {
  double value = 0.0;
  double std = 0.0;
};

/// Mean and square-root covariance: what all filters of this folder carry.
template <std::size_t N>
struct Gaussian {
  StateVector<N> x{};
  SquareMatrix<N> s{};  ///< lower triangular, P = s s^T

  [[nodiscard]] double Variance(std::size_t i) const noexcept {
    double v = 0.0;
    for (std::size_t j = 0; j <= i; ++j) v += s[i][j] * s[i][j];
    return v;
  }

  /// Standard deviation of sum_i c_i x_i.
  [[nodiscard]] double Std(const StateVector<N>& c) const noexcept { return std::sqrt(Variance(c, 0, N)); }

  /// Its square, with c_i = 0 but for first <= i < last.
  [[nodiscard]] double Variance(const StateVector<N>& c, std::size_t first, std::size_t last) const noexcept {
    double v = 0.0;
    for (std::size_t j = 0; j < last; ++j) {
      double t = 0.0;
      for (std::size_t i = std::max(first, j); i < last; ++i) t += c[i] * s[i][j];
      v += t * t;
    }
    return v;
  }
};

template <std::size_t N>
[[nodiscard]] constexpr StateMask<N> AllStates() noexcept {
  StateMask<N> m{};
  for (auto& b : m) b = true;
  return m;
}

/// Exact Kalman update for a measurement of state 0: y = x0 + noise of standard deviation r > 0.
///
/// With S lower triangular only S00 is in row 0, so the Joseph form
///   S S^T <- (I - K H) P (I - K H)^T + r^2 K K^T        (paper eqs. 23-26, corrected)
/// multiplies column 0 of S by r / sqrt(S00^2 + r^2) and leaves the rest: exact, and it cannot fail.
///
/// States outside `mask` keep their value (a consider, or Schmidt, update): with the gain of those rows set
/// to zero the Joseph form exceeds the optimum by dK Syy dK^T, added here as a rank-one update of S.
template <std::size_t N>
inline UpdateResult UpdateFirstState(Gaussian<N>& state, double y, double r, const InnovationGate& gate,
                                     const StateMask<N>& mask, Innovation& innovation) noexcept {
  const double s00 = state.s[0][0];
  const double syy = std::sqrt(s00 * s00 + r * r);
  innovation.value = y - state.x[0];
  innovation.std = syy;
  const double off = std::abs(innovation.value);
  if (!(off <= std::max(gate.sigmas * syy, gate.absolute))) return UpdateResult::kGated;

  const double scale = r / syy;
  const double gain = s00 / (syy * syy) * innovation.value;
  StateVector<N> excess{};
  std::size_t first = N;
  for (std::size_t i = 0; i < N; ++i) {
    const double column = state.s[i][0];
    if (mask[i]) {
      state.x[i] += gain * column;
    } else {
      excess[i] = column * s00 / syy;
      first = std::min(first, i);
    }
    state.s[i][0] = scale * column;
  }
  if (first < N) square_root::AddRankOne(state.s, excess, first);
  return UpdateResult::kOk;
}

}  // namespace contour
