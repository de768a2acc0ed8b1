#include "analysis/diagnosis/screening/screen.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

/// Long enough for the stroke in both directions, which tells a torque from a friction.
test::FittedAxis With(std::vector<test::HiddenEffect> effects) {
  test::HiddenOptions o = test::FittedAxis::Short(std::move(effects));
  o.duration_s = 14.0;
  return test::FittedAxis(o);
}

bool Has(const std::vector<Scored>& scored, const std::string& kind) {
  return std::any_of(scored.begin(), scored.end(), [&](const Scored& s) { return s.effect->kind == kind; });
}

TEST(Screen, WhatIsThereIsPromisedMost) {
  const test::FittedAxis axis = With({{"cogging", 0.2, 12.0, 0.4, 0.0}});
  const std::vector<SharedEffect> catalogue = CatalogueEffects(axis.problem);
  const std::vector<Scored> scored = Screen(axis.problem, axis.base, catalogue);
  ASSERT_FALSE(scored.empty());
  EXPECT_EQ(scored[0].effect->kind, "cogging");
  EXPECT_EQ(scored[0].effect->order, 12.0);
  for (std::size_t i = 1; i < scored.size(); ++i)
    EXPECT_LE(scored[i].drop - Penalty(*scored[i].effect),
              scored[i - 1].drop - Penalty(*scored[i - 1].effect));
  EXPECT_TRUE(Has(scored, "constant_torque")) << "the catalogue and the scans";
}

TEST(Screen, WhatTheFitHasIsNotTriedAgainButFurtherOrdersAre) {
  const test::FittedAxis axis = With({{"cogging", 0.2, 12.0, 0.4, 0.0}, {"cogging", 0.1, 5.0, 0.0, 0.0}});
  std::vector<SharedEffect> catalogue = CatalogueEffects(axis.problem);
  const std::vector<Scored> first = Screen(axis.problem, axis.base, catalogue);
  ASSERT_EQ(first[0].effect->order, 12.0);
  Fit fit = axis.With(first[0].effect);
  const std::vector<Scored> next = Screen(axis.problem, fit, catalogue);
  EXPECT_EQ(next[0].effect->kind, "cogging");
  EXPECT_EQ(next[0].effect->order, 5.0);
  for (const Scored& s : next) EXPECT_FALSE(s.effect->kind == "cogging" && s.effect->order == 12.0);
  // Of what is no wave, none is tried twice.
  std::erase_if(catalogue, [](const SharedEffect& e) { return e->kind != "constant_torque"; });
  EXPECT_FALSE(
      Has(Screen(axis.problem, axis.With(axis.Of("constant_torque")), catalogue), "constant_torque"));
}

TEST(Screen, NumbersOfALawThatDoesNotHoldAreNoCause) {
  const test::FittedAxis axis;
  Fit fit = axis.With(axis.Of("presliding_hysteresis"));
  for (std::size_t i = 0; i < axis.problem.terms.size(); ++i)
    if (axis.problem.terms[i].name == "rough") fit.point.base[i] = -10.0 * axis.problem.terms[i].sigma;
  const std::vector<SharedEffect> catalogue = {axis.Of("stribeck"), axis.Of("constant_torque")};
  const std::vector<Scored> scored = Screen(axis.problem, fit, catalogue);
  EXPECT_FALSE(Has(scored, "stribeck"));
  EXPECT_TRUE(Has(scored, "constant_torque"));
  EXPECT_TRUE(Has(Screen(axis.problem, axis.base, catalogue), "stribeck"));
}

}  // namespace
}  // namespace contour::diagnosis
