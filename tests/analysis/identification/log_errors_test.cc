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

}  // namespace
}  // namespace contour::test
