#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/prediction_error/linear_model.h"

namespace contour::diagnosis {

/// What disturbs an axis and its reading.
struct NoiseVariances {
  double torque = 0.0;   ///< [Nm^2] of white torque noise, mean over a row
  double reading = 0.0;  ///< [rad^2]
  double slow = 0.0;     ///< [Nm^2] of a first-order (Gauss-Markov) torque noise; 0: none
  double keep = 0.0;     ///< what is left of that one a row later
};

/// The rows that a pass of the Kalman filter goes over.
struct PassRows {
  const LinearModel& model;
  const std::vector<std::uint8_t>& counted;
  double period_s;
  std::size_t from, to;
};

/// What -2 log likelihood is made of.
struct LikelihoodSums {
  double squares = 0.0, logs = 0.0, count = 0.0;

  /// At the likeliest size of all noises together.
  [[nodiscard]] double Unlikely() const;
};

/// States of the filter: the model's, and the slow torque where there is any.
int FilterStates(const LinearModel& model, const NoiseVariances& noise);

/// Time-varying Kalman filter (Anderson and Moore, Optimal Filtering, 6.2; coloured noise as a state, 11.4)
/// on the linearised model. Adds to the sums; writes gains, FilterStates + 1 per transition (kappa, 1 /
/// sqrt(S)), unless null.
void KalmanPass(const PassRows& rows, const NoiseVariances& noise, LikelihoodSums& sums, float* gains);

/// A and c of every transition and nothing else, as LaneWhiten reads them, which waits for memory; stride is
/// states * (states + 1).
std::vector<float> StatesAlone(const LinearModel& model);
/// The same with the slow torque as the last state.
std::vector<float> WithSlowTorque(const LinearModel& model, double keep);

}  // namespace contour::diagnosis
