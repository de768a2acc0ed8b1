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

/// 2 N + 1 sigma points, one row per state: element j is the mean moved along column j of S, element
/// kHalf + j the same the other way, element kCentre the mean. What else there is in a row, for it to be a
/// whole number of registers, repeats the mean, so models may run over whole rows.
template <std::size_t N>
struct SigmaPoints {
  static constexpr std::size_t kHalf = (N + 3) / 4 * 4;
  static constexpr std::size_t kCentre = N < kHalf ? N : 2 * kHalf;
  static constexpr std::size_t kStride = 2 * kHalf + (N < kHalf ? 0 : 4);
  using Row = std::array<double, kStride>;
  alignas(32) std::array<Row, N> row;
};

/// Square roots of the points' weights, element by element of a row.
template <std::size_t N, class Weights>
alignas(32) inline constexpr typename SigmaPoints<N>::Row kRootWeights = [] {
  typename SigmaPoints<N>::Row w{};
  for (std::size_t j = 0; j < N; ++j)
    w[j] = w[SigmaPoints<N>::kHalf + j] = square_root::Sqrt(Weights::kOther);
  w[SigmaPoints<N>::kCentre] = square_root::Sqrt(Weights::kCovariance0);
  return w;
}();

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
  using Points = SigmaPoints<N>;
  static_assert(Weights::kScale > 0.0, "n + lambda must be positive");
  static_assert(Weights::kCovariance0 >= 0.0, "W0c < 0 has no square root: choose alpha = 1 and beta >= 0");

  /// Time update. `process(points)` moves every sigma point in place (SigmaPoints<N>&, noexcept), but for
  /// states from Moving on, which it leaves as they are; noise_std is the square root of the diagonal of Q.
  template <std::size_t Moving = N, class Process>
  [[gnu::always_inline]] void Predict(Process&& process, const StateVector<N>& noise_std) noexcept {
    Points points;
    Draw(points);
    process(points);
    // Eqs. 14, 15: mean. Eq. 16: weighted deviations, the centre point stacked in with sqrt(W0c).
    // Eq. 17: S- = qr([sqrt(W) (X - x), sqrt(Q)]^T)^T; the paper prints the noise itself for sqrt(Q), and the
    // QR gives the upper factor, whose transpose is wanted.
    Triangular a;
    for (std::size_t i = 0; i < Moving; ++i)
      this->x[i] = MeanAndDeviations(points.row[i].data(), a.row[i].data());
    for (std::size_t i = Moving; i < N; ++i) KeptDeviations(i, a.row[i].data());
    a.Run(noise_std, this->s);
  }

  /// Measurement of state 0; see UpdateFirstState. Redrawing (eqs. 18-22) is not needed since h is linear: S-
  /// of eq. 17 stands for Mxx and H S- for Myy.
  UpdateResult UpdateState0(double y, double r, const InnovationGate& gate, const StateMask<N>& mask,
                            Innovation& innovation) noexcept {
    return UpdateFirstState<N>(*this, y, r, gate, mask, innovation);
  }

  /// Scalar measurement y = h(x) + noise of standard deviation r > 0, h any function:
  /// `measure(points, row)` fills the row, element by element. Sigma points are redrawn from the prior x-, S-
  /// (the paper prints the posterior, eq. 18, before it is known).
  template <class Measure>
  UpdateResult Update(Measure&& measure, double y, double r, const InnovationGate& gate,
                      Innovation& innovation) noexcept {
    Points points;
    Draw(points);
    alignas(32) typename Points::Row predicted{}, myy;
    measure(points, predicted);
    const double mean = MeanAndDeviations(predicted.data(), myy.data());
    // Eq. 23: Syy = qr([Myy, sqrt(R)]^T), a number here. Eq. 22 is Myy (printed Mxy).
    const double syy = std::sqrt(square_root::Dot<kColumns>(myy.data(), myy.data()) + r * r);
    innovation.value = y - mean;
    innovation.std = syy;
    const double off = std::abs(innovation.value);
    if (!(off <= std::max(gate.sigmas * syy, gate.absolute))) return UpdateResult::kGated;

    // Eqs. 24-26 in Joseph form: S = qr([Mxx - K Myy, K sqrt(R)]^T)^T. The one noise column is dense, so it
    // is one more column of deviations.
    square_root::Triangulariser<N, kColumns + 1> a{};
    for (std::size_t i = 0; i < N; ++i) {
      alignas(32) typename Points::Row row;
      MeanAndDeviations(points.row[i].data(), row.data());
      const double k = square_root::Dot<kColumns>(row.data(), myy.data()) / (syy * syy);
      for (std::size_t c = 0; c < kColumns; ++c) a.row[i][c] = row[c] - k * myy[c];
      a.row[i][kColumns] = k * r;
      this->x[i] += k * innovation.value;
    }
    a.Run(StateVector<N>{}, this->s);
    return UpdateResult::kOk;
  }

  /// Sigma points of the present mean and covariance (eqs. 11, 12): x, x +- sqrt(n + lambda) S_i, the columns
  /// of the lower factor. S is zero above its diagonal: there the points are the centre.
  [[gnu::always_inline]] void Draw(Points& points) const noexcept {
    constexpr double kSpread = square_root::Sqrt(Weights::kScale);
    for (std::size_t i = 0; i < N; ++i) {
      double* row = points.row[i].data();
      const double centre = this->x[i];
      const square_root::Quad middle{centre, centre, centre, centre};
      constexpr square_root::Quad kSpreads{kSpread, kSpread, kSpread, kSpread};
      for (std::size_t j = 0; j < Points::kHalf; j += 4) {
        square_root::Quad d;
        Columns(i, j, d);
        d *= kSpreads;
        square_root::Store(row + j, middle + d);
        square_root::Store(row + Points::kHalf + j, middle - d);
      }
      if constexpr (Points::kCentre == 2 * Points::kHalf) square_root::Store(row + Points::kCentre, middle);
    }
  }

 private:
  /// Elements of a row of deviations, the centre's among them; what follows is zero.
  static constexpr std::size_t kColumns =
      Points::kCentre < Points::kHalf ? Points::kHalf + N : Points::kCentre + 1;
  using Triangular = square_root::Triangulariser<N, kColumns>;
  static_assert(Triangular::kWidth == Points::kStride);

  /// Row i of S from column j on, with zeros beyond the last. The length of a row is even.
  [[gnu::always_inline]] void Columns(std::size_t i, std::size_t j, square_root::Quad& q) const noexcept {
    const auto& row = this->s[i];
    if (j + 4 <= row.size())
      square_root::Load(row.data() + j, q);
    else
      q = square_root::Quad{row[j], j + 1 < row.size() ? row[j + 1] : 0.0};
  }

  /// The weights sum to one, so the mean is the centre plus the weighted differences from it: W0m drops out
  /// and nothing is lost when a state is large against its spread.
  [[gnu::always_inline]] static double MeanAndDeviations(const double* row, double* out) noexcept {
    constexpr auto& kRoots = kRootWeights<N, Weights>;
    constexpr std::size_t kQuads = Points::kStride / 4;
    const double centre = row[Points::kCentre];
    const square_root::Quad middle{centre, centre, centre, centre};
    std::array<square_root::Quad, kQuads> off;
    for (std::size_t k = 0; k < kQuads; ++k) {
      square_root::Load(row + 4 * k, off[k]);
      off[k] -= middle;
    }
    square_root::Quad sums = off[0] + off[1];
    for (std::size_t k = 2; k < 2 * Points::kHalf / 4; k += 2) sums += off[k] + off[k + 1];
    const double shift = Weights::kOther * square_root::Fold(sums);
    const square_root::Quad shifts{shift, shift, shift, shift};
    for (std::size_t k = 0; k < kQuads; ++k) {
      square_root::Quad roots;
      square_root::Load(kRoots.data() + 4 * k, roots);
      square_root::Store(out + 4 * k, roots * (off[k] - shifts));
    }
    return centre + shift;
  }

  /// Of a state that is as it was drawn.
  [[gnu::always_inline]] void KeptDeviations(std::size_t i, double* out) const noexcept {
    constexpr double kRoot = square_root::Sqrt(Weights::kScale) * square_root::Sqrt(Weights::kOther);
    constexpr square_root::Quad kRoots{kRoot, kRoot, kRoot, kRoot};
    for (std::size_t j = 0; j < Points::kHalf; j += 4) {
      square_root::Quad d;
      Columns(i, j, d);
      d *= kRoots;
      square_root::Store(out + j, d);
      square_root::Store(out + Points::kHalf + j, -d);
    }
    if constexpr (Points::kCentre == 2 * Points::kHalf)
      square_root::Store(out + Points::kCentre, square_root::Quad{});
  }
};

}  // namespace contour
