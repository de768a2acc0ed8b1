#include "tools/plant_emulator/portable_math.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tools/plant_emulator/random.h"

namespace contour {
namespace {

TEST(PortableMath, AgreesWithTheLibrary) {
  plant::Random random(3, 0);
  for (int i = 0; i < 100000; ++i) {
    const double x = random.Uniform(-700.0, 700.0);
    ASSERT_NEAR(portable::Exp(x) / std::exp(x), 1.0, 2e-15) << x;
    const double small = random.Uniform(-2.0, 2.0);
    ASSERT_NEAR(portable::Exp(small) / std::exp(small), 1.0, 1e-15) << small;
    const double positive = std::exp(random.Uniform(-30.0, 30.0));
    ASSERT_NEAR(portable::Log(positive), std::log(positive), 1e-14) << positive;
    const double angle = random.Uniform(-3000.0, 3000.0);
    ASSERT_NEAR(portable::Sin(angle), std::sin(angle), 1e-12) << angle;
    ASSERT_NEAR(portable::Cos(angle), std::cos(angle), 1e-12) << angle;
  }
  EXPECT_EQ(portable::Exp(0.0), 1.0);
  EXPECT_EQ(portable::Exp(-1e6), 0.0);
  EXPECT_EQ(portable::Sin(0.0), 0.0);
  EXPECT_TRUE(std::isinf(portable::Exp(1e6)));
  EXPECT_TRUE(std::isnan(portable::Exp(std::nan(""))));
}

TEST(PortableMath, DecayIsSmoothWhereItsFormsMeet) {
  for (double x = 1e-12; x < 1e3; x *= 1.7) {
    const portable::Decay d = portable::DecayOver(x);
    EXPECT_NEAR(d.mean, -std::expm1(-x) / x, 1e-12) << x;
    EXPECT_NEAR(d.remaining, std::exp(-x), 1e-15) << x;
  }
  EXPECT_EQ(portable::DecayOver(0.0).mean, 1.0);
}

TEST(Random, NormalNumbersHaveTheRightMoments) {
  plant::Random random(1, 2);
  double sum = 0.0;
  double squares = 0.0;
  double fourths = 0.0;
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.Normal();
    sum += x;
    squares += x * x;
    fourths += x * x * x * x;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.01);
  EXPECT_NEAR(squares / kCount, 1.0, 0.02);
  EXPECT_NEAR(fourths / kCount, 3.0, 0.1);
}

TEST(Random, StreamsAndSeedsDiffer) {
  plant::Random a(1, 0);
  plant::Random same(1, 0);
  plant::Random stream(1, 1);
  plant::Random seed(2, 0);
  const double first = a.Uniform();
  EXPECT_EQ(first, same.Uniform());
  EXPECT_NE(first, stream.Uniform());
  EXPECT_NE(first, seed.Uniform());
  // The same numbers on every host: the generator's definition, not a library's.
  EXPECT_DOUBLE_EQ(plant::Random(1, 0).Uniform(), first);
}

}  // namespace
}  // namespace contour
