#include "analysis/prediction_error/fourier_transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace contour::diagnosis {
namespace {

std::vector<double> Noise(std::size_t size) {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  std::vector<double> x(size);
  for (double& v : x) v = normal(random);
  return x;
}

TEST(FourierTransform, IsTheSumByItsDefinition) {
  const std::vector<double> x = Noise(64);
  const HalfSpectrum spectrum = FourierTransform(x);
  ASSERT_EQ(spectrum.size(), 33U);
  for (std::size_t f = 0; f < spectrum.size(); ++f) {
    std::complex<double> sum = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k)
      sum += x[k] * std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(f * k) / 64.0);
    EXPECT_LT(std::abs(spectrum[f] - sum), 1e-12) << f;
  }
}

TEST(FourierTransform, AWaveIsOneLine) {
  std::vector<double> x(4096);
  for (std::size_t k = 0; k < x.size(); ++k)
    x[k] = 3.0 * std::cos(2.0 * std::numbers::pi * 100.0 * static_cast<double>(k) / 4096.0);
  const HalfSpectrum spectrum = FourierTransform(x);
  EXPECT_NEAR(spectrum[100].real(), 3.0 * 2048.0, 1e-8);
  EXPECT_NEAR(std::abs(spectrum[101]), 0.0, 1e-8);
}

TEST(FourierTransform, ThereAndBackIsTheSignal) {
  for (const std::size_t size : {2U, 256U, 6000U}) {
    const std::vector<double> x = Noise(size), back = InverseFourierTransform(FourierTransform(x));
    ASSERT_EQ(back.size(), size);
    for (std::size_t k = 0; k < size; ++k) EXPECT_NEAR(back[k], x[k], 1e-12);
  }
}

TEST(FourierTransform, TheSameSignalGivesTheSameBits) {
  const std::vector<double> x = Noise(4096);
  EXPECT_EQ(FourierTransform(x), FourierTransform(std::vector<double>(x)));
}

}  // namespace
}  // namespace contour::diagnosis
