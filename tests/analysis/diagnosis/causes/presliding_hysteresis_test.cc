#include <gtest/gtest.h>

#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "presliding_hysteresis";

TEST(PreslidingHysteresis, IsAShareOfTheLevelOnASofterElement) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "ratio 0.1");
  AxisModel expected = axis.problem.nominal;
  expected.soft_share = 0.25;
  const AxisModel m = test::With(axis, e, {0.25, std::log(2.0)});
  EXPECT_NEAR(m.soft_ratio, 0.2, 1e-12);
  expected.soft_ratio = m.soft_ratio;
  EXPECT_EQ(m, expected);
  const NamedValues told = test::Told(axis, e, {0.25, std::log(2.0)});
  EXPECT_EQ(told.at("share_rel"), 0.25);
  EXPECT_NEAR(told.at("stiffness_ratio"), 0.2, 1e-12);
}

TEST(PreslidingHysteresis, AShareIsBetweenNoneAndAll) {
  const test::KnownAxis axis;
  for (const SharedEffect& e : test::GridOf(axis, kKind)) {
    EXPECT_EQ(e->low[0], 0.0);
    EXPECT_LT(e->high[0], 1.0) << "something is left of the main element";
    EXPECT_EQ(test::With(axis, e, {-0.1, 0.0}).soft_share, 0.0);
  }
}

TEST(PreslidingHysteresis, TheElementIsSofterWhereverTheSearchBegins) {
  const test::KnownAxis axis;
  double last = 0.0;
  for (const SharedEffect& e : test::GridOf(axis, kKind)) {
    const double ratio = test::With(axis, e, e->start).soft_ratio;
    EXPECT_LT(ratio, 1.0);
    EXPECT_GT(ratio, last);
    if (last > 0.0) {
      EXPECT_LT(ratio * std::exp(e->low[1]), last * std::exp(e->high[1])) << "no ratio is left out";
    }
    last = ratio;
  }
}

TEST(PreslidingHysteresis, NothingDecidesBetweenItAndACoupling) {
  const test::KnownAxis axis;
  const auto reversals = std::get<ReversalsShape>(test::DecidingProgram(axis, kKind).shape);
  EXPECT_LT(reversals.amplitudes_mm.front(), 0.01) << "sticking";
  EXPECT_GE(reversals.amplitudes_mm.back(), 1.0) << "sliding";
  const Experiment none = (*CauseNamed(kKind).experiment)(axis.problem, true);
  EXPECT_TRUE(none.text.empty() && none.program.empty());
}

TEST(PreslidingHysteresis, TakesUpWhatAnotherLawOfFrictionLeaves) {
  EXPECT_TRUE(*CauseNamed(kKind).takes_up_mismatch);
  EXPECT_FALSE(*CauseNamed(kKind).refuted_by_mismatch);
  EXPECT_EQ(*CauseNamed(kKind).extension, nullptr);
}

TEST(PreslidingHysteresis, ASpecimenHasAnElementThatIsSofter) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  const Drawn drawn = (*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({0.5}));
  const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.presliding_hysteresis->share_rel, (*s.truth)(drawn, {}).at("share_rel"));
  EXPECT_LT(emulated.axis.effects.presliding_hysteresis->stiffness_ratio, 1.0);
  EXPECT_TRUE(
      test::EmulatedWith((*s.effect)({.size = *s.largest_size, .second = 0.1}, {}, {})).errors.empty());
}

}  // namespace
}  // namespace contour::diagnosis
