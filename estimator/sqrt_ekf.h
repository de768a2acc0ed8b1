#pragma once

#include "estimator/gaussian.h"
#include "estimator/square_root.h"

namespace contour {

/// Extended Kalman filter with a square-root covariance: the rival of SqrtUkf on the same model.
template <std::size_t N>
class SqrtEkf : public Gaussian<N> {
 public:
  /// `process(x, tangent)` moves the mean and, by the chain rule, the columns of S.
  template <class Process>
  void Predict(Process&& process, const StateVector<N>& noise_std) noexcept {
    SquareMatrix<N> tangent = this->s;
    process(this->x, tangent);
    square_root::Triangulariser<N, N> a{};
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t k = 0; k < N; ++k) a.row[i][k] = tangent[i][k];
    }
    a.Run(noise_std, this->s);
  }

  UpdateResult UpdateState0(double y, double r, const InnovationGate& gate, const StateMask<N>& mask,
                            Innovation& innovation) noexcept {
    return UpdateFirstState<N>(*this, y, r, gate, mask, innovation);
  }
};

}  // namespace contour
