#include "analysis/identification/log_errors.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

using identify::LogErrors;
using identify::TableAxis;

TEST(LogErrorsTest, AreLeastForTheAxisThatIsThere) {
  const TableAxis truth = Exactly(PlainAxis());
  TableAxis heavy = truth, soft = truth, none = truth;
  heavy.motor_inertia *= 1.1;
  soft.friction.s0 *= 0.5;
  none.motor_inertia = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> logs = LogErrors({truth, heavy, soft, none}, {Everything()}, 1.0, 1);
  ASSERT_EQ(logs.size(), 4U);
  EXPECT_LT(logs[0], logs[1]);
  EXPECT_LT(logs[0], logs[2]);
  EXPECT_EQ(logs[3], 1e300);
}

// The position jumps and comes back: both models are off by as much there, and are told apart elsewhere.
TEST(LogErrorsTest, OneWindowOutOfAllProportionDoesNotHideTheRest) {
  constexpr double kAllAlike_s = std::numeric_limits<double>::infinity();
  const TableAxis truth = Exactly(PlainAxis());
  TableAxis heavy = truth;
  heavy.motor_inertia *= 1.1;
  const auto apart = [&](const identify::Measured& record) {
    const std::vector<double> logs = LogErrors({truth, heavy}, {record}, kAllAlike_s, 1);
    return logs[1] - logs[0];
  };
  const identify::Measured sound = Everything();
  identify::Measured slipped = sound;
  const std::size_t at = sound.size() / 2;
  for (std::size_t k = at; k < at + 50; ++k) slipped.position_m[k] += 1e-3;
  EXPECT_GT(apart(sound), 0.1);
  EXPECT_GT(apart(slipped), 0.5 * apart(sound));
}

}  // namespace
}  // namespace contour::test
