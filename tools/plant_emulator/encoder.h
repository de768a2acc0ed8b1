#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "tools/plant_emulator/axis_parameters.h"
#include "tools/plant_emulator/random.h"

namespace contour::plant {

/// The motor's encoder: errors of disc and interpolation, noise, quantisation. Counts go on beyond any turn.
class Encoder {
 public:
  Encoder(const AxisParameters& p, std::uint64_t seed, std::uint64_t stream) noexcept
      : counts_per_rad_(p.encoder_counts_per_rev / (2.0 * std::numbers::pi)),
        noise_lsb_(p.encoder_noise_lsb),
        jitter_s_(p.effects.sample_jitter ? 1e-6 * p.effects.sample_jitter->rms_us : 0.0),
        eccentricity_(p.effects.encoder_eccentricity),
        subdivision_(p.effects.encoder_subdivision),
        random_(seed, stream) {}

  std::int64_t Read(double angle_rad, double velocity_rad_s) noexcept {
    if (jitter_s_ > 0.0) angle_rad += jitter_s_ * random_.Normal() * velocity_rad_s;
    double seen = angle_rad;
    if (eccentricity_)
      seen += eccentricity_->amplitude_rad * portable::Sin(angle_rad + eccentricity_->phase_rad);
    if (subdivision_)
      seen += subdivision_->amplitude_rad *
              portable::Sin(subdivision_->order_per_rev * angle_rad + subdivision_->phase_rad);
    double counts = seen * counts_per_rad_ + 0.5;
    if (noise_lsb_ > 0.0) counts += noise_lsb_ * random_.Normal();
    return static_cast<std::int64_t>(std::floor(counts));
  }

  [[nodiscard]] double ToRad(std::int64_t counts) const noexcept {
    return static_cast<double>(counts) / counts_per_rad_;
  }
  [[nodiscard]] double counts_per_rad() const noexcept { return counts_per_rad_; }

 private:
  double counts_per_rad_;
  double noise_lsb_;
  double jitter_s_;
  std::optional<EncoderEccentricityEffect> eccentricity_;
  std::optional<EncoderSubdivisionEffect> subdivision_;
  Random random_;
};

}  // namespace contour::plant
