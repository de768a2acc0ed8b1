#include <gtest/gtest.h>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "current_lag";

TEST(CurrentLag, IsAddedToTheStatedOneAndToldInMicroseconds) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "");
  AxisModel expected = axis.problem.nominal;
  expected.lag_s = 2e-4 + 150e-6;
  const AxisModel m = test::With(axis, e, {150e-6});
  EXPECT_NEAR(m.lag_s, expected.lag_s, 1e-15);
  expected.lag_s = m.lag_s;
  EXPECT_EQ(m, expected) << "and nothing else";
  const NamedValues told = test::Told(axis, e, {150e-6});
  ASSERT_EQ(told.size(), 1u);
  EXPECT_NEAR(told.at("time_constant_us"), 150.0, 1e-9);
}

TEST(CurrentLag, IsNeverNegative) {
  const test::KnownAxis axis;
  EXPECT_EQ(test::With(axis, test::OnGrid(axis, kKind, ""), {-1e-3}).lag_s, 0.0);
}

TEST(CurrentLag, EndsWhereNoneIsLeft) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "");
  ASSERT_EQ(e->low.size(), 1u);
  EXPECT_EQ(e->low[0], -2e-4);
  EXPECT_GT(e->high[0], 1e3) << "a long one has no end";
}

TEST(CurrentLag, IsANumberOfTheModelWhoseEvidenceLiesInItsPrior) {
  const CauseDefinition& cause = CauseNamed(kKind);
  ASSERT_EQ((*cause.freed_terms).size(), 1u);
  EXPECT_EQ((*cause.freed_terms)[0], "lag");
  EXPECT_TRUE(*(*cause.extension)->number_of_the_model);
  const test::KnownAxis axis;
  const double largest_s = (*cause.largest)(axis.problem);
  EXPECT_GE(largest_s, test::KnownAxis::kPeriod_s) << "a cycle of it is a flaw that drives have";
  EXPECT_LT(largest_s, 10.0 * test::KnownAxis::kPeriod_s);
}

TEST(CurrentLag, OfTwoLogsTheSumIsTheModels) {
  const ExtensionsConfig e = test::ExtendedBy({test::CauseWith(kKind, {{"time_constant_us", 150.0}}),
                                               test::CauseWith(kKind, {{"time_constant_us", -30.0}})});
  const auto [read, errors] = test::ThroughYaml(e);
  EXPECT_TRUE(errors.empty());
  EXPECT_EQ(read.current_lag->time_constant_us, 120.0);
  EXPECT_EQ(test::SimulatedWith(kKind, e).axis.effects.current_lag->time_constant_us, 120.0);
  const ExtensionsConfig far = test::ExtendedBy({test::CauseWith(kKind, {{"time_constant_us", 1e6}})});
  EXPECT_FALSE(test::ThroughYaml(far).errors.empty()) << "a second of it is refused";
}

TEST(CurrentLag, LessThanStatedIsNoneInTheEmulatedMachine) {
  const test::Emulated emulated =
      test::SimulatedWith(kKind, test::ExtendedBy({test::CauseWith(kKind, {{"time_constant_us", -30.0}})}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.current_lag->time_constant_us, 0.0);
}

TEST(CurrentLag, IsDecidedByAChirp) {
  const test::KnownAxis axis;
  const Program program = test::DecidingProgram(axis, kKind);
  ASSERT_TRUE(program.torque);
  EXPECT_EQ(program.torque->kind, TorqueSignalKind::kChirp);
  EXPECT_TRUE(*CauseNamed(kKind).about_timing);
}

TEST(CurrentLag, ASpecimenHasItsSizeInMicroseconds) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  const Drawn drawn = (*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({0.5}));
  const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.current_lag->time_constant_us, drawn.size);
  EXPECT_EQ((*s.truth)(drawn, {}).at("time_constant_us"), drawn.size);
  EXPECT_TRUE(test::EmulatedWith((*s.effect)({.size = *s.largest_size}, test::MachineToDrawFor(), {}))
                  .errors.empty());
}

}  // namespace
}  // namespace contour::diagnosis
