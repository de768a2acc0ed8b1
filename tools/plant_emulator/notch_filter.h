#pragma once

#include "tools/plant_emulator/portable_math.h"

namespace contour::plant {

/// A drive's filter on its torque command, against one mode:
///   (s^2 + 2 depth width w s + w^2) / (s^2 + 2 width w s + w^2),
/// one tick by the bilinear transform, the notch's frequency kept. Without a frequency it passes all on.
class NotchFilter {
 public:
  NotchFilter() noexcept = default;
  NotchFilter(double frequency_Hz, double width, double depth, double tick_s) noexcept
      : on_(frequency_Hz > 0.0) {
    if (!on_) return;
    const double half = 3.14159265358979323846 * frequency_Hz * tick_s;
    const double w = portable::Sin(half) / portable::Cos(half);
    const double poles = 1.0 + 2.0 * width * w + w * w;
    b0_ = (1.0 + 2.0 * depth * width * w + w * w) / poles;
    b1_ = 2.0 * (w * w - 1.0) / poles;
    b2_ = (1.0 - 2.0 * depth * width * w + w * w) / poles;
    a2_ = (1.0 - 2.0 * width * w + w * w) / poles;
  }

  void Reset() noexcept { s1_ = s2_ = 0.0; }
  double Step(double in) noexcept {
    if (!on_) return in;
    const double out = b0_ * in + s1_;
    s1_ = portable::WithoutDust(b1_ * (in - out) + s2_);  // a1 = b1
    s2_ = portable::WithoutDust(b2_ * in - a2_ * out);
    return out;
  }

 private:
  bool on_ = false;
  double b0_ = 1.0, b1_ = 0.0, b2_ = 0.0, a2_ = 0.0;
  double s1_ = 0.0, s2_ = 0.0;
};

}  // namespace contour::plant
