#include "drivers/cia402/scaling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
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

// Half a range is as near upwards as downwards: there and back may be a whole wrap.
TEST(Unwrap, AWrongBitLeavesNothingBehind) {
  constexpr std::int64_t kTop = std::numeric_limits<std::int32_t>::max();
  const auto raw_of = [](std::int64_t truth, int bit) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::uint64_t>(truth)) ^
                                     (bit < 0 ? 0U : 1U << bit));
  };
  for (const std::int64_t at : {std::int64_t{-6}, std::int64_t{4}, kTop - 3, -kTop + 2, 3 * kTop}) {
    for (const std::int64_t speed : {-5, 5}) {
      for (int bit = 0; bit < 32; ++bit) {
        for (int wrong = 1; wrong <= 3; ++wrong) {
          Unwrap unwrap;
          // Some wraps away from where it began.
          std::int64_t truth = 0;
          unwrap.Update(0);
          while (truth != at) {
            truth += std::clamp<std::int64_t>(at - truth, -(1 << 29), 1 << 29);
            ASSERT_EQ(unwrap.Update(raw_of(truth, -1)), truth);
          }
          for (int k = 0; k < wrong; ++k) unwrap.Update(raw_of(truth += speed, bit));
          EXPECT_EQ(unwrap.Update(raw_of(truth += speed, -1)), truth)
              << "bit " << bit << " for " << wrong << " at " << at << ", " << speed << " a reading";
        }
      }
    }
  }
}

// A count that began anew far away goes on from there, over its wrap too.
TEST(Unwrap, GoesOnWhereACountBeganAnew) {
  constexpr std::int32_t kTop = std::numeric_limits<std::int32_t>::max();
  Unwrap unwrap;
  unwrap.Update(-3);
  EXPECT_EQ(unwrap.Update(kTop - 10), std::int64_t{kTop} - 10);
  EXPECT_EQ(unwrap.Update(kTop), std::int64_t{kTop});
  EXPECT_EQ(unwrap.Update(std::numeric_limits<std::int32_t>::min()), std::int64_t{kTop} + 1);
}

}  // namespace
}  // namespace contour
