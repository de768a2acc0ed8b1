#include "drivers/cia402/scaling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace contour {
namespace {

TEST(TorqueScale, IsInWholePerMilleOfTheRatedTorque) {
  const TorqueScale scale{0.637};
  EXPECT_EQ(scale.ToPerMille(0.637), 1000);
  EXPECT_EQ(scale.ToPerMille(-0.637 * 0.0014), -1);
  EXPECT_EQ(scale.ToPerMille(0.637 * 0.0004), 0);
  EXPECT_DOUBLE_EQ(scale.FromPerMille(-500), -0.3185);
  EXPECT_EQ(scale.ToPerMille(1e9), 32767);
  EXPECT_EQ(scale.ToPerMille(-1e9), -32768);
  EXPECT_EQ(scale.ToPerMille(std::numeric_limits<double>::quiet_NaN()), 0);
  for (std::int16_t p = -3000; p <= 3000; ++p) ASSERT_EQ(scale.ToPerMille(scale.FromPerMille(p)), p);
}

TEST(PositionScale, CountsAndBack) {
  const PositionScale scale{1048576};
  EXPECT_EQ(scale.ToCounts(2 * std::numbers::pi), 1048576);
  EXPECT_EQ(scale.ToCounts(-std::numbers::pi), -524288);
  EXPECT_DOUBLE_EQ(scale.ToRad(524288), std::numbers::pi);
  EXPECT_EQ(scale.ToCounts(std::numeric_limits<double>::infinity()), 0);
}

TEST(Unwrap, GoesOnOverTheWrap) {
  Unwrap unwrap;
  constexpr std::int32_t kTop = std::numeric_limits<std::int32_t>::max();
  EXPECT_EQ(unwrap.Update(kTop - 1), std::int64_t{kTop} - 1);
  EXPECT_EQ(unwrap.Update(std::numeric_limits<std::int32_t>::min() + 3), std::int64_t{kTop} + 4);
  EXPECT_EQ(unwrap.Update(kTop), kTop);
  // The target that belongs to an unwrapped position wraps as the drive does.
  const PositionScale scale{1048576};
  EXPECT_EQ(scale.ToCounts(scale.ToRad(std::int64_t{kTop} + 4)),
            std::numeric_limits<std::int32_t>::min() + 3);
}

TEST(Unwrap, ManyTurnsBothWays) {
  Unwrap unwrap;
  std::int64_t truth = 0;
  for (int i = 0; i < 100000; ++i) {
    truth += i < 60000 ? 1'000'003 : -1'500'007;
    const auto raw = static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::uint64_t>(truth)));
    ASSERT_EQ(unwrap.Update(raw), truth);
  }
}

}  // namespace
}  // namespace contour
