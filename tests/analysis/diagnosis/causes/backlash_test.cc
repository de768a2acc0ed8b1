#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "backlash";
constexpr double kRad_um = 1e6 * test::KnownAxis::kTablePerRad;  // of the table per rad of the motor

TEST(Backlash, OfAScrewIsFreeTravelAndNothingElse) {
  const test::KnownAxis axis({.two_inertia = true});
  const SharedEffect e = test::OnGrid(axis, kKind, "10");
  AxisModel expected = axis.problem.nominal;
  expected.gap = 0.01;
  EXPECT_EQ(test::With(axis, e, {0.01}), expected);
  EXPECT_NEAR(test::Told(axis, e, {0.01}).at("gap_um"), 0.01 * kRad_um, 1e-9);
}

TEST(Backlash, OfARigidAxisPutsAPartOfItBehindAStiffScrew) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "10");
  const AxisModel m = test::With(axis, e, {0.01});
  ASSERT_TRUE(m.two_inertia);
  EXPECT_NEAR(m.motor_inertia + m.load_inertia, 1e-4, 1e-15) << "no inertia comes or goes";
  EXPECT_NEAR(std::sqrt(m.stiffness / m.load_inertia) / (2.0 * std::numbers::pi), 400.0, 1e-6);
  EXPECT_EQ(m.gap, 0.01);
  EXPECT_EQ(test::With(axis, e, {0.0}), axis.problem.nominal) << "no gap is no screw either";
}

TEST(Backlash, BeginsAtSeveralGapsAndIsNeverNegative) {
  const test::KnownAxis axis({.two_inertia = true});
  for (const SharedEffect& e : test::GridOf(axis, kKind)) {
    EXPECT_NEAR(test::Told(axis, e, e->start).at("gap_um"), std::stod(e->label), 1e-6)
        << "the label's last digit";
    EXPECT_EQ(e->low[0], 0.0);
    EXPECT_GE(e->high[0] * kRad_um, 500.0) << "half a millimetre is a worn machine, and found";
    EXPECT_EQ(test::With(axis, e, {-0.01}).gap, 0.0);
  }
}

TEST(Backlash, IsLookedForDownToWhatTheEncoderShows) {
  test::KnownAxis axis({.two_inertia = true});
  const auto narrowest_um = [&] {
    double out = 1e9;
    for (const SharedEffect& e : test::GridOf(axis, kKind)) out = std::min(out, e->start[0] * kRad_um);
    return out;
  };
  const double count_um = axis.stated.position_step * kRad_um;
  EXPECT_LT(narrowest_um(), count_um);
  EXPECT_GT(narrowest_um(), 0.05 * count_um);
  const std::size_t fine = test::GridOf(axis, kKind).size();
  axis.stated.position_step *= 64.0;
  EXPECT_EQ(test::GridOf(axis, kKind).size(), fine - 3);
  axis.stated.position_step = 0.0;
  EXPECT_LT(test::GridOf(axis, kKind).size(), 12u) << "ends where no count is known, too";
}

TEST(Backlash, IsMendedAndNoModelIsExtendedByIt) {
  const CauseDefinition& cause = CauseNamed(kKind);
  EXPECT_EQ(*cause.extension, nullptr);
  const test::KnownAxis rotary({.two_inertia = true}), linear({.two_inertia = true, .linear = true});
  // The same gap at the table, whatever coordinate the log has.
  EXPECT_NEAR((*cause.largest)(rotary.problem) * test::KnownAxis::kTablePerRad,
              (*cause.largest)(linear.problem), 1e-12);
}

TEST(Backlash, AmongCouplingsAChirpDecidesAndElseReversals) {
  const test::KnownAxis axis({.two_inertia = true});
  EXPECT_TRUE(std::holds_alternative<ReversalsShape>(test::DecidingProgram(axis, kKind).shape));
  const Program chirp = test::DecidingProgram(axis, kKind, {"compliance"});
  ASSERT_TRUE(chirp.torque);
  EXPECT_EQ(chirp.torque->kind, TorqueSignalKind::kChirp);
}

TEST(Backlash, ASpecimenHasTheGapThatItsTruthSays) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  EXPECT_TRUE((*s.needs).two_inertia);
  const Drawn drawn = (*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({0.5}));
  const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.backlash->gap_um, (*s.truth)(drawn, {}).at("gap_um"));
}

}  // namespace
}  // namespace contour::diagnosis
