#include "analysis/diagnosis/causes/drift.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

TEST(Drift, ChangesTheInputThatItIsMadeOfAndNoOther) {
  const test::KnownAxis axis;
  std::vector<SharedEffect> dry, viscous;
  Drifts(axis.problem, "any", Input::kLevel, dry);
  Drifts(axis.problem, "any", Input::kViscous, viscous);
  ASSERT_EQ(dry.size(), viscous.size());
  for (std::size_t i = 0; i < dry.size(); ++i) {
    std::vector<double> a(dry[i]->steps.size(), 0.0);
    a[0] = 0.2;
    const AxisModel one = test::With(axis, dry[i], a), other = test::With(axis, viscous[i], a);
    EXPECT_FALSE(one.viscous || other.level);
    EXPECT_EQ(*one.level, *other.viscous);
  }
}

TEST(Drift, IsToldAsTheChangeOverWhatWasThereAtTheBeginning) {
  const test::KnownAxis axis;
  std::vector<SharedEffect> all;
  Drifts(axis.problem, "any", Input::kLevel, all);
  for (const SharedEffect& e : all) {
    std::vector<double> a(e->steps.size(), 0.0);
    a[0] = -0.3;
    const AxisModel m = test::With(axis, e, a);
    Point point;
    for (const BaseTerm& t : axis.problem.terms) point.base.push_back(t.start);
    point.effects.push_back(e);
    point.amplitudes.push_back(a);
    const NamedValues told = ChangeOverLog({axis.problem, point, 0});
    EXPECT_NEAR(told.at("change_rel"), (1.0 + m.level->back()) / (1.0 + m.level->front()) - 1.0, 1e-3);
    EXPECT_EQ(told.contains("time_constant_s"), a.size() == 2);
  }
}

}  // namespace
}  // namespace contour::diagnosis
