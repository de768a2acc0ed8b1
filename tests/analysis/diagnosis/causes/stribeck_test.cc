#include <gtest/gtest.h>

#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "stribeck";

TEST(Stribeck, WhereTheModelHasOneItsNumbersAreFactors) {
  const test::KnownAxis axis;
  const std::vector<SharedEffect> grid = test::GridOf(axis, kKind);
  ASSERT_EQ(grid.size(), 1u);
  const AxisModel m = test::With(axis, grid[0], {std::log(1.2), std::log(0.5)});
  EXPECT_NEAR(m.friction.Fs_plus, 1.2 * 0.09, 1e-12);
  EXPECT_NEAR(m.friction.Fs_minus, 1.2 * 0.06, 1e-12);
  EXPECT_NEAR(m.friction.vs, 1.0, 1e-12);
  EXPECT_EQ(m.friction.Fc_plus, 0.06);
  const NamedValues told = test::Told(axis, grid[0], {std::log(1.2), std::log(0.5)});
  EXPECT_NEAR(told.at("Fs_over_Fc"), 1.8, 1e-12);
  EXPECT_NEAR(told.at("vs_rad_s"), 1.0, 1e-12);
}

TEST(Stribeck, WhereItHasNoneSeveralSpeedsAreTried) {
  const test::KnownAxis axis({.stribeck = false});
  const std::vector<SharedEffect> grid = test::GridOf(axis, kKind);
  ASSERT_GT(grid.size(), 1u);
  double last = 0.0;
  for (const SharedEffect& e : grid) {
    const AxisModel m = test::With(axis, e, {0.3, 0.0});
    EXPECT_NEAR(m.friction.Fs_plus, 1.3 * 0.06, 1e-12);
    EXPECT_NEAR(m.friction.Fs_minus, 1.3 * 0.04, 1e-12);
    EXPECT_GT(m.friction.vs, last);
    EXPECT_LT(m.friction.vs, 0.1 * test::KnownAxis::kTopSpeed_rad_s) << "it is over long before full speed";
    if (last > 0.0) {
      EXPECT_LT(m.friction.vs * std::exp(e->low[1]), last * std::exp(e->high[1]));
    }
    last = m.friction.vs;
  }
}

TEST(Stribeck, IsInPlaceOfTheModelsAndNeverBelowCoulomb) {
  const ExtensionsConfig e =
      test::ExtendedBy({test::CauseWith(kKind, {{"Fs_over_Fc", 1.3}, {"vs_rad_s", 4.0}}),
                        test::CauseWith(kKind, {{"Fs_over_Fc", 1.8}, {"vs_rad_s", 1.5}})});
  const auto [read, errors] = test::ThroughYaml(e);
  EXPECT_TRUE(errors.empty());
  EXPECT_EQ(read.stribeck->Fs_over_Fc, 1.8);
  EXPECT_EQ(read.stribeck->vs_rad_s, 1.5);
  const test::Emulated emulated = test::SimulatedWith(kKind, e);
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.stribeck->vs_rad_s, 1.5);
  const ExtensionsConfig below =
      test::ExtendedBy({test::CauseWith(kKind, {{"Fs_over_Fc", 0.9}, {"vs_rad_s", 4.0}})});
  EXPECT_EQ(below.stribeck->Fs_over_Fc, 1.0);
  EXPECT_TRUE(test::ThroughYaml(below).errors.empty());
  const ExtensionsConfig far =
      test::ExtendedBy({test::CauseWith(kKind, {{"Fs_over_Fc", 20.0}, {"vs_rad_s", 4.0}})});
  EXPECT_FALSE(test::ThroughYaml(far).errors.empty());
}

TEST(Stribeck, IsANumberOfTheModel) {
  const auto freed = *CauseNamed(kKind).freed_terms;
  EXPECT_EQ(std::vector<std::string_view>(freed.begin(), freed.end()),
            (std::vector<std::string_view>{"Fs", "vs"}));
  EXPECT_TRUE(*CauseNamed(kKind).refuted_by_mismatch);
}

TEST(Stribeck, IsDecidedByGrowingReversalsButNotAmongCouplings) {
  const test::KnownAxis axis;
  EXPECT_EQ(std::get<ReversalsShape>(test::DecidingProgram(axis, kKind).shape).axis, "x");
  EXPECT_TRUE((*CauseNamed(kKind).experiment)(axis.problem, true).program.empty());
}

TEST(Stribeck, ASpecimensSizeIsHowFarTheRatioLiesAboveOne) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  EXPECT_TRUE((*s.needs).no_stribeck);
  const Drawn drawn{.size = 0.4, .second = 2.0};
  const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_DOUBLE_EQ(emulated.axis.effects.stribeck->Fs_over_Fc, 1.4);
  EXPECT_NEAR((*s.size_at)(2.0, 1.4), 0.8, 1e-12);
  EXPECT_EQ((*s.truth)(drawn, {}), (NamedValues{{"Fs_over_Fc", 1.4}, {"vs_rad_s", 2.0}}));
  EXPECT_EQ((*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({0.5})).second, 2.0)
      << "the machine's own vs";
}

}  // namespace
}  // namespace contour::diagnosis
