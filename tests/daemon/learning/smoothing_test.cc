#include "daemon/learning/smoothing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace contour {
namespace {

TEST(Smoothing, TurnsNoPhaseAndKeepsAConstant) {
  const Smoothing smoothing(40.0, 1e-3);
  std::vector<float> pulse(201, 0.0F);
  pulse[100] = 1.0F;
  const std::vector<float> bell = smoothing.Of(pulse);
  float sum = 0.0F;
  for (std::size_t j = 0; j <= 100; ++j) EXPECT_EQ(bell[100 - j], bell[100 + j]) << j;
  for (const float b : bell) sum += b;
  EXPECT_NEAR(sum, 1.0, 1e-5);
}

TEST(Smoothing, HalfThePowerPassesAtTheBandwidth) {
  for (const double bandwidth_Hz : {10.0, 40.0, 100.0}) {
    const Smoothing smoothing(bandwidth_Hz, 1e-3);
    std::vector<float> wave(2000);
    for (std::size_t k = 0; k < wave.size(); ++k)
      wave[k] =
          static_cast<float>(std::sin(2.0 * std::numbers::pi * bandwidth_Hz * 1e-3 * static_cast<double>(k)));
    const std::vector<float> smooth = smoothing.Of(wave);
    double in = 0.0, out = 0.0;
    for (std::size_t k = 500; k < 1500; ++k) {
      in += static_cast<double>(wave[k] * wave[k]);
      out += static_cast<double>(smooth[k] * smooth[k]);
    }
    EXPECT_NEAR(out / in, 0.5, 0.01) << bandwidth_Hz;
  }
}

}  // namespace
}  // namespace contour
