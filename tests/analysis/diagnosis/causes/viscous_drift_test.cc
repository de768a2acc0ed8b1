#include <gtest/gtest.h>

#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "viscous_drift";

TEST(ViscousDrift, MovesTheViscousTermAndNotTheLevel) {
  const test::KnownAxis axis;
  for (const SharedEffect& e : test::GridOf(axis, kKind)) {
    std::vector<double> a(e->steps.size(), 0.0);
    a[0] = 0.1;
    const AxisModel m = test::With(axis, e, a);
    EXPECT_TRUE(m.viscous);
    EXPECT_FALSE(m.level || m.load_force || m.motor_force);
  }
  EXPECT_EQ(*CauseNamed(kKind).extension, nullptr) << "it is over when the log is";
}

TEST(ViscousDrift, IsToldAsTheChangeFromBeginningToEnd) {
  const test::KnownAxis axis;
  const auto coefficient = [](const AxisModel& m, std::size_t row) { return 1.0 + (*m.viscous)[row]; };
  const SharedEffect even = test::OnGrid(axis, kKind, "linear");
  EXPECT_NEAR(coefficient(test::With(axis, even, {0.2}), 0), 0.9, 1e-12);
  EXPECT_NEAR(test::Told(axis, even, {0.2}).at("change_rel"), 1.1 / 0.9 - 1.0, 1e-12);
  const SharedEffect soon = test::OnGrid(axis, kKind, "exponential");
  const AxisModel m = test::With(axis, soon, {-0.3, 0.0});
  const NamedValues told = test::Told(axis, soon, {-0.3, 0.0});
  EXPECT_NEAR(told.at("change_rel"), coefficient(m, 1999) / coefficient(m, 0) - 1.0, 1e-3);
  EXPECT_GT(told.at("time_constant_s"), 0.0);
}

TEST(ViscousDrift, NothingChangesOfWhatIsNotThere) {
  test::KnownAxis axis;
  axis.problem.nominal.friction.s2 = 0.0;
  EXPECT_TRUE(test::GridOf(axis, kKind).empty());
}

TEST(ViscousDrift, IsDecidedByTheSameStrokesWarmAndCold) {
  const test::KnownAxis axis;
  EXPECT_TRUE(std::holds_alternative<SequenceShape>(test::DecidingProgram(axis, kKind).shape));
}

}  // namespace
}  // namespace contour::diagnosis
