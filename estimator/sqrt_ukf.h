#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "estimator/gaussian.h"
#include "estimator/square_root.h"

namespace contour {

/// Spread of the sigma points: lambda = alpha^2 (n + kappa) - n. With alpha = 1, kappa = 0: lambda = 0,
/// W0m = 0, Wi = 1 / (2 n), W0c = beta. beta = 2 is the optimum for a Gaussian prior.
struct DefaultSpread {
  static constexpr double kAlpha = 1.0;
  static constexpr double kBeta = 2.0;
  static constexpr double kKappa = 0.0;
};

/// Weights of the unscented transform (paper eqs. 11-13, which leave them out).
template <std::size_t N, class Spread>
struct UkfWeights {
  static constexpr double kN = static_cast<double>(N);
  static constexpr double kScale = Spread::kAlpha * Spread::kAlpha * (kN + Spread::kKappa);  // n + lambda
  static constexpr double kLambda = kScale - kN;
  static constexpr double kMean0 = kLambda / kScale;
  static constexpr double kCovariance0 = kMean0 + 1.0 - Spread::kAlpha * Spread::kAlpha + Spread::kBeta;
  static constexpr double kOther = 0.5 / kScale;
};

/// 2 N + 1 sigma points, one row per state: point 0 is the centre, 1 + i and 1 + N + i lie along column i of
/// S. Rows are padded to an even length; the padding repeats the centre, so models may run over whole rows.
template <std::size_t N>
struct SigmaPoints {
  static constexpr std::size_t kCount = 2 * N + 1;
  static constexpr std::size_t kStride = kCount + kCount % 2;
  using Row = std::array<double, kStride>;
  alignas(16) std::array<Row, N> row;
};

/// Square-root unscented Kalman filter of N states with additive noise (R. van der Merwe, E. A. Wan, "The
/// square-root unscented Kalman filter for state and parameter-estimation", ICASSP 2001; equation numbers
/// below are of Fukui and Takami's paper, with what had to be corrected).
///
/// float64 throughout. All weights are non-negative, checked at compile time, so the square root of W0c is
/// real (eq. 16) and no downdate occurs anywhere: nothing in here can fail on finite input.
template <std::size_t N, class Spread = DefaultSpread>
class SqrtUkf : public Gaussian<N> {
 public:
  using Weights = UkfWeights<N, Spread>;
  static_assert(Weights::kScale > 0.0, "n + lambda must be positive");
  static_assert(Weights::kCovariance0 >= 0.0, "W0c < 0 has no square root: choose alpha = 1 and beta >= 0");

  /// Time update. `process(points)` moves every sigma point in place (SigmaPoints<N>&, noexcept); noise_std
  /// is the square root of the diagonal of Q.
  template <class Process>
  [[gnu::always_inline]] void Predict(Process&& process, const StateVector<N>& noise_std) noexcept {
    SigmaPoints<N> points;
    Draw(points);
    process(points);
    // Eqs. 14, 15: mean. Eq. 16: weighted deviations, the centre point stacked in with sqrt(W0c).
    // Eq. 17: S- = qr([sqrt(W) (X - x), sqrt(Q)]^T)^T; the paper prints the noise itself for sqrt(Q), and the
    // QR gives the upper factor, whose transpose is wanted.
    Triangular a;
    for (std::size_t i = 0; i < N; ++i) {
      this->x[i] = Mean(points.row[i].data());
      Deviations(points.row[i].data(), this->x[i], a.row[i].data());
    }
    a.SetNoise(noise_std);
    a.Run(this->s);
  }

  /// Measurement of state 0; see UpdateFirstState. Redrawing (eqs. 18-22) is not needed since h is linear: S-
  /// of eq. 17 stands for Mxx and H S- for Myy.
  UpdateResult UpdateState0(double y, double r, const InnovationGate& gate, const StateMask<N>& mask,
                            Innovation& innovation) noexcept {
    return UpdateFirstState<N>(*this, y, r, gate, mask, innovation);
  }

  /// Scalar measurement y = h(x) + noise of standard deviation r > 0, h any function:
  /// `measure(points, row)` fills row[0 .. kCount-1]. Sigma points are redrawn from the prior x-, S- (the
  /// paper prints the posterior, eq. 18, before it is known).
  template <class Measure>
  UpdateResult Update(Measure&& measure, double y, double r, const InnovationGate& gate,
                      Innovation& innovation) noexcept {
    SigmaPoints<N> points;
    Draw(points);
    typename SigmaPoints<N>::Row predicted{};
    measure(points, predicted);
    const double mean = Mean(predicted.data());
    std::array<double, kColumns> myy{};
    Deviations(predicted.data(), mean, myy.data());
    // Eq. 23: Syy = qr([Myy, sqrt(R)]^T), a number here. Eq. 22 is Myy (printed Mxy).
    const double syy = std::sqrt(square_root::Dot<kColumns>(myy.data(), myy.data()) + r * r);
    innovation.value = y - mean;
    innovation.std = syy;
    const double off = std::abs(innovation.value);
    if (!(off <= std::max(gate.sigmas * syy, gate.absolute))) return UpdateResult::kGated;

    // Eqs. 24-26 in Joseph form: S = qr([Mxx - K Myy, K sqrt(R)]^T)^T. The one noise column is dense, so it
    // takes the place of the last deviation column's neighbour: N + 1 columns of which only the first is
    // used.
    square_root::Triangulariser<N, kColumns + 1> a;
    for (std::size_t i = 0; i < N; ++i) {
      double* row = a.row[i].data();
      Deviations(points.row[i].data(), this->x[i], row);
      const double k = square_root::Dot<kColumns>(row, myy.data()) / (syy * syy);
      for (std::size_t c = 0; c < kColumns; ++c) row[c] -= k * myy[c];
      row[kColumns] = k * r;
      this->x[i] += k * innovation.value;
    }
    a.SetNoise(StateVector<N>{});
    a.Run(this->s);
    return UpdateResult::kOk;
  }

  /// Sigma points of the present mean and covariance (eqs. 11, 12): x, x +- sqrt(n + lambda) S_i, the columns
  /// of the lower factor.
  [[gnu::always_inline]] void Draw(SigmaPoints<N>& points) const noexcept {
    constexpr double kSpread = square_root::Sqrt(Weights::kScale);
    for (std::size_t i = 0; i < N; ++i) {
      double* row = points.row[i].data();
      const double centre = this->x[i];
      row[0] = centre;
      // S is zero above its diagonal: there the points are the centre.
      for (std::size_t j = 0; j < N; ++j) {
        const double d = kSpread * this->s[i][j];
        row[1 + j] = centre + d;
        row[1 + N + j] = centre - d;
      }
      if constexpr (SigmaPoints<N>::kStride > SigmaPoints<N>::kCount) row[SigmaPoints<N>::kCount] = centre;
    }
  }

 private:
  // A centre weight of zero needs no column.
  static constexpr bool kCentre = Weights::kCovariance0 > 0.0;
  static constexpr std::size_t kColumns = 2 * N + (kCentre ? 1 : 0);
  using Triangular = square_root::Triangulariser<N, kColumns>;

  /// The weights sum to one, so the mean is the centre plus the weighted differences from it: W0m drops out
  /// and nothing is lost when a state is large against its spread.
  [[gnu::always_inline]] static double Mean(const double* row) noexcept {
    const square_root::Pair centre{row[0], row[0]};
    square_root::Pair sums{};
    for (std::size_t k = 1; k < 2 * N; k += 2) sums += square_root::Load(row + k) - centre;
    return row[0] + Weights::kOther * (sums[0] + sums[1]);
  }

  [[gnu::always_inline]] static void Deviations(const double* row, double mean, double* out) noexcept {
    constexpr double kOther = square_root::Sqrt(Weights::kOther);
    constexpr double kZero = square_root::Sqrt(Weights::kCovariance0);
    for (std::size_t k = 0; k < 2 * N; ++k) out[k] = kOther * (row[k + 1] - mean);
    if constexpr (kCentre) out[2 * N] = kZero * (row[0] - mean);
  }
};

}  // namespace contour
