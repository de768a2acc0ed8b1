#include <gtest/gtest.h>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "outside:friction of time";

TEST(FrictionOfTime, FollowsWhateverGoesSlowlyOverTheLog) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "");
  // Straight lines from top to top: 0 at the beginning, 1 in the middle of the second stretch, and so on.
  const std::size_t count = e->steps.size();
  ASSERT_GT(count, 2u);
  std::vector<double> tops(count, 0.0);
  tops[1] = 0.02;
  tops[2] = 0.06;
  const AxisModel m = test::With(axis, e, tops);
  ASSERT_TRUE(m.level);
  const double between = static_cast<double>(test::KnownAxis::kRows) / static_cast<double>(count - 1);
  const auto at = [&](double stretches) { return (*m.level)[static_cast<std::size_t>(stretches * between)]; };
  EXPECT_NEAR(at(0.0), 0.0, 1e-12);
  EXPECT_NEAR(at(0.5), 0.01, 2e-4);
  EXPECT_NEAR(at(1.5), 0.04, 4e-4);
  EXPECT_NEAR(at(2.5), 0.03, 6e-4);
  EXPECT_EQ(at(3.5), 0.0);
}

TEST(FrictionOfTime, IsOfNothingElse) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "");
  AxisModel m = test::With(axis, e, std::vector<double>(e->steps.size(), 0.01));
  ASSERT_TRUE(m.level);
  // All tops equal is a constant.
  for (const double v : *m.level) ASSERT_NEAR(v, 0.01, 1e-12);
  m.level = axis.problem.nominal.level;
  EXPECT_EQ(m, axis.problem.nominal);
}

TEST(FrictionOfTime, IsNoCauseOfTheCatalogue) {
  const CauseDefinition& cause = CauseNamed(kKind);
  EXPECT_EQ(*cause.experiment, nullptr);
  EXPECT_EQ(*cause.specimen, nullptr);
  EXPECT_EQ(*cause.extension, nullptr);
  EXPECT_TRUE(*cause.refuted_by_mismatch) << "where friction is another law, it is no matter of time";
}

}  // namespace
}  // namespace contour::diagnosis
