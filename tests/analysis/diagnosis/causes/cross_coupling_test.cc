#include <gtest/gtest.h>

#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "cross_coupling";

TEST(CrossCoupling, IsAForceInProportionToTheOtherAxissAcceleration) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "");
  const AxisModel m = test::With(axis, e, {2e-3});
  for (const std::size_t row : {10u, 333u, 1999u})
    EXPECT_NEAR((*m.load_force)[row], 2e-3 * 4.0 * std::sin(7e-3 * static_cast<double>(row)), 1e-12);
  EXPECT_EQ(test::Told(axis, e, {2e-3}), (NamedValues{{"torque_per_acceleration_Nms2_m", 2e-3}}));
  // The step of a run is a small part of friction at the highest acceleration.
  EXPECT_LT(e->steps[0] * 4.0, 0.1 * test::KnownAxis::kCoulomb_Nm);
}

TEST(CrossCoupling, WithoutAnotherAxisIsNotLookedFor) {
  EXPECT_TRUE(test::GridOf(test::KnownAxis({.axis2 = false}), kKind).empty());
}

TEST(CrossCoupling, MoreThanFrictionIsAnotherMachine) {
  test::KnownAxis axis;
  const auto largest = *CauseNamed(kKind).largest;
  // At 4 m/s^2 as much as the friction of 0.05 Nm.
  EXPECT_NEAR(largest(axis.problem), 0.05 / 4.0, 1e-6);
  axis.problem.signals->axis2_m_s2.assign(test::KnownAxis::kRows, 1e-4);
  EXPECT_EQ(largest(axis.problem), 0.0) << "the other axis stands still: nothing could be seen";
}

TEST(CrossCoupling, NoModelIsExtendedByItAndPeopleMoveTheOtherAxis) {
  EXPECT_EQ(*CauseNamed(kKind).extension, nullptr);
  const test::KnownAxis axis;
  const Experiment experiment = (*CauseNamed(kKind).experiment)(axis.problem, false);
  EXPECT_NE(experiment.text.find("other axis"), std::string::npos);
  EXPECT_TRUE(experiment.program.empty()) << "the program of one axis cannot do it";
}

TEST(CrossCoupling, ASpecimenNamesTheOtherAxis) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  EXPECT_TRUE((*s.needs).second_axis);
  const Drawn drawn = (*s.draw)(test::MachineToDrawFor(), -1.0, test::Numbers({0.5}));
  const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.cross_coupling->axis, "y");
  EXPECT_EQ(emulated.axis.effects.cross_coupling->torque_per_acceleration_Nms2_m,
            (*s.truth)(drawn, {}).at("torque_per_acceleration_Nms2_m"));
  EXPECT_LT(drawn.size, 0.0);
}

}  // namespace
}  // namespace contour::diagnosis
