#include "analysis/identification/screw_response.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

namespace contour::identify {
namespace {

constexpr double kMass = 40.0;

/// A free mass under a held random force, one period late; solved by hand.
Measured FreeMass(std::size_t rows, double noise_m = 0.0) {
  Measured d;
  d.period_s = 1e-3;
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  double x = 0.0, v = 0.0, acting = 0.0;
  for (std::size_t k = 0; k < rows; ++k) {
    d.position_m.push_back(x + noise_m * normal(random));
    d.force_N.push_back(60.0 * normal(random));
    d.present.push_back(1);
    x += v * 1e-3 + 0.5 * acting / kMass * 1e-6;
    v += acting / kMass * 1e-3;
    acting = d.force_N.back();
  }
  return d;
}

TEST(ScrewResponse, OfAFreeMassIsOneOverItsMass) {
  const auto response = MotorResponse({FreeMass(20000)});
  ASSERT_GT(response.size(), 100U);
  for (const ResponsePoint& p : response) {
    EXPECT_GE(p.frequency_Hz, 40.0);
    EXPECT_LE(p.frequency_Hz, 480.0);
    EXPECT_NEAR(p.accelerance_1_kg * kMass, 1.0, 0.05) << p.frequency_Hz;
    EXPECT_GT(p.coherence, 0.98) << p.frequency_Hz;
  }
}

TEST(ScrewResponse, ReadingsThatAreNoiseAreNotCoherent) {
  for (const ResponsePoint& p : MotorResponse({FreeMass(20000, 1e-3)}))
    EXPECT_LT(p.coherence, kGoodCoherence);
}

TEST(ScrewResponse, ARunUpIsNotShaken) {
  Measured d = FreeMass(20000);
  for (std::size_t k = 0; k < 4000; ++k) d.force_N[k] = 0.0;
  d.run_up = 4000;
  const auto response = MotorResponse({d});
  ASSERT_GT(response.size(), 100U);
  for (const ResponsePoint& p : response) EXPECT_GT(p.coherence, 0.98) << p.frequency_Hz;
}

/// 1 / 90 kg but for a dip and a rise of this depth.
std::vector<ResponsePoint> WithDip(double depth, double coherence) {
  std::vector<ResponsePoint> response;
  for (double f = 100.0; f < 480.0; f += 2.0) {
    const double at = (f - 320.0) / 12.0;
    response.push_back({f, (1.0 - depth * std::exp(-at * at)) / 90.0, coherence});
  }
  return response;
}

TEST(VisibleAntiresonance, IsTheDeepestPointOfWhatIsNotFlatAndWasShaken) {
  const std::optional<ResponsePoint> dip = VisibleAntiresonance(WithDip(0.8, 0.95));
  ASSERT_TRUE(dip.has_value());
  EXPECT_NEAR(dip->frequency_Hz, 320.0, 2.0);
  EXPECT_FALSE(VisibleAntiresonance(WithDip(0.3, 0.95)).has_value());
  EXPECT_FALSE(VisibleAntiresonance(WithDip(0.8, 0.3)).has_value());
  EXPECT_FALSE(VisibleAntiresonance({}).has_value());
}

TEST(ScrewResponse, AShortRecordOrOneWithHolesSaysNothing) {
  EXPECT_TRUE(MotorResponse({FreeMass(600)}).empty());
  Measured holes = FreeMass(5000);
  for (std::size_t k = 0; k < holes.size(); k += 100) holes.present[k] = 0;
  EXPECT_TRUE(MotorResponse({holes}).empty());
}

}  // namespace
}  // namespace contour::identify
