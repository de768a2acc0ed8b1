#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "analysis/prediction_error/excerpt.h"
#include "analysis/prediction_error/linear_model.h"
#include "analysis/prediction_error/noise_levels.h"
#include "analysis/prediction_error/whitener.h"

namespace contour::diagnosis {

/// What is known of an axis before its noise is learnt.
struct NoiseSetup {
  double inertia = 0.0;  ///< [kg m^2] of all that moves
  double period_s = 0.0;
  double reading_step = 0.0;  ///< [rad]
  bool slow_torque = true;    ///< whether a slow torque is looked for
};

/// Makes innovations white. Torque that nobody commanded moves a sliding axis and hardly a stuck one, and the
/// reading has noise of its own: a Kalman filter on the linearised model (KalmanPass) takes both into
/// account, and a torque that wanders slowly, which says when a stuck axis breaks away; an autoregressive
/// filter after it takes what colour is left.
class NoiseFilter {
 public:
  NoiseFilter() = default;
  /// The ratios of the noises by maximum likelihood from the innovations of the linearised run.
  /// `counted`: rows whose innovation counts. `before`: the log's filter of an earlier run, whose ratios lie
  /// near; null: none.
  NoiseFilter(std::shared_ptr<const LinearModel> linear, const std::vector<std::uint8_t>& counted,
              const NoiseSetup& setup, const NoiseFilter* before);

  /// Whitens each, in place of size rows; rows that do not count come out 0 before the colour filter.
  /// Of an excerpt's segments where there are any: in, out and weight are theirs then, back to back.
  void Apply(std::span<const double* const> in, std::span<double* const> out,
             const std::vector<std::uint8_t>& counted, const double* weight,
             std::span<const Segment> segments = {}) const;

  /// What the filters make of a pulse of motor torque over one row (or of the reading at one), at row k.
  std::vector<double> Pulse(std::size_t row, bool reading, std::size_t length,
                            const std::vector<std::uint8_t>& counted) const;

  struct Gradient {
    Signal motor, level;  ///< per transition: of a constant over it
    Signal reading;       ///< per row
  };
  /// Of |white|^2 / 2 with respect to signals, where `white` is the filters' own output, weights included.
  Gradient Back(const std::vector<double>& white, const std::vector<std::uint8_t>& counted,
                const double* weight) const;

  /// Sum over the rows that count of the logarithm of the variance that an innovation is divided by.
  double LogVariances(const std::vector<std::uint8_t>& counted) const;

  bool learnt() const { return linear_ != nullptr; }
  const LinearModel& linear() const { return *linear_; }
  double torque_noise() const { return torque_noise_; }
  /// Of an observer that believes reading and model as far as the two noises let it.
  double ObserverBandwidth_Hz(double period_s) const;

 private:
  [[nodiscard]] std::size_t Stride() const;

  std::shared_ptr<const LinearModel> linear_;
  NoiseLevels levels_;
  int states_ = 0;  ///< the linearised model's, and the slow torque where there is any
  std::shared_ptr<const std::vector<float>> step_;  ///< their transitions: A and c
  std::vector<float> gain_;                         ///< per transition: kappa, 1 / sqrt(S)
  std::vector<double> taps_;
  double torque_noise_ = 0.0;
};

/// A colour filter alone.
void ApplyColourFilter(const Whitener& whitener, std::span<const double* const> in,
                       std::span<double* const> out, const std::vector<std::uint8_t>& counted,
                       const double* weight, std::span<const Segment> segments = {});

}  // namespace contour::diagnosis
