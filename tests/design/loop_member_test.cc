#include "design/loop_member.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/design/family_axes.h"

namespace contour {
namespace {

TEST(BristleAt, HasTheSlopeOfTheFrictionLevelWhenSpeedChangesSlowly) {
  const Friction f = AxisOf("base").friction;
  const auto level_N = [&](double v_m_s) {
    return f.Fc_plus_N + (f.Fs_plus_N - f.Fc_plus_N) * std::exp(-v_m_s / f.vs_m_s);
  };
  for (const double v_m_s : {0.05e-3, 0.5e-3, 2e-3}) {
    const TableBristle b = BristleAt(f, v_m_s);
    const double slope_Ns_m = (level_N(1.001 * v_m_s) - level_N(0.999 * v_m_s)) / (0.002 * v_m_s);
    EXPECT_NEAR(b.stiffness_N_m * b.rate / b.decay_1_s, slope_Ns_m, 1e-4 * std::abs(slope_Ns_m));
    EXPECT_LT(b.rate, 0.0);
  }
}

TEST(BristleAt, IsTheBristleItselfAtNoSpeed) {
  const Friction f = AxisOf("base").friction;
  const TableBristle b = BristleAt(f, 1e-9);
  EXPECT_DOUBLE_EQ(b.stiffness_N_m, f.sigma0_N_m);
  EXPECT_NEAR(b.damping_Ns_m, f.sigma1_Ns_m, 1e-6);
  EXPECT_LT(b.decay_1_s, 1e-3);
}

TEST(UncertaintySet, BeginsWithTheAxisAsStatedAndNamesEveryMemberOnce) {
  const std::vector<LoopMember> set = UncertaintySet(AxisOf("base"));
  EXPECT_EQ(set.front().name, "as stated, sliding");
  std::set<std::string> names;
  for (const LoopMember& m : set) EXPECT_TRUE(names.insert(m.name).second) << m.name;
  for (const MemberKind kind : {MemberKind::kAsStated, MemberKind::kFarOff, MemberKind::kLate})
    EXPECT_TRUE(std::any_of(set.begin(), set.end(), [&](const LoopMember& m) { return m.kind == kind; }));
}

TEST(UncertaintySet, IsAsWideAsTheModelSaysItIs) {
  LoopAxis axis = AxisOf("base");
  axis.stiffness_std = 0.2;
  double low = 1e300, high = 0.0;
  for (const LoopMember& m : UncertaintySet(axis)) {
    if (m.kind != MemberKind::kAsStated) continue;
    low = std::min(low, m.axis.stiffness_N_m);
    high = std::max(high, m.axis.stiffness_N_m);
  }
  EXPECT_DOUBLE_EQ(low, 0.8 * axis.axis.stiffness_N_m);
  EXPECT_DOUBLE_EQ(high, 1.2 * axis.axis.stiffness_N_m);
}

// A deviation of the whole value and more says that little is known, not that a mass may be negative.
TEST(UncertaintySet, HasNoNegativeAxisHoweverLittleIsKnown) {
  double before = 1.0;
  for (const double std : {0.1, 0.5, 0.500001, 0.9, 1.0, 1.5, 3.0, 10.0}) {
    LoopAxis axis = AxisOf("base");
    axis.stiffness_std = axis.motor_mass_std = axis.table_mass_std = std;
    double least = 1.0;
    for (const LoopMember& m : UncertaintySet(axis)) {
      if (m.kind != MemberKind::kAsStated) continue;
      const double share = m.axis.table_mass_kg / axis.axis.table_mass_kg;
      EXPECT_GT(share, 0.0) << m.name;
      EXPECT_GT(m.axis.motor_mass_kg, 0.0) << m.name;
      EXPECT_GT(m.axis.stiffness_N_m, 0.0) << m.name;
      least = std::min(least, share);
    }
    EXPECT_LT(least, before) << std;
    EXPECT_NEAR(least, std <= 0.5 ? 1.0 - std : 0.25 / std, 1e-12);
    before = least;
  }
}

TEST(CreepingSet, IsTheSameSetWithKindsOfItsOwnForWhatFrictionPassesThrough) {
  const LoopAxis axis = AxisOf("base");
  const std::vector<LoopMember> strict = UncertaintySet(axis), creeping = CreepingSet(axis);
  ASSERT_EQ(strict.size(), creeping.size());
  for (std::size_t i = 0; i < strict.size(); ++i) {
    EXPECT_EQ(strict[i].name, creeping[i].name);
    const bool slope = strict[i].name.find("Stribeck") != std::string::npos;
    const bool held = strict[i].name.find("held") != std::string::npos;
    const MemberKind kind = slope ? MemberKind::kCreeping : held ? MemberKind::kHeld : strict[i].kind;
    EXPECT_EQ(creeping[i].kind, kind) << strict[i].name;
  }
}

TEST(UncertaintySet, HasSlopeSpeedsOfTheAxisItself) {
  LoopAxis axis = AxisOf("base");
  const auto slowest = [&] {
    double most_1_s = 0.0;
    for (const LoopMember& m : UncertaintySet(axis)) most_1_s = std::max(most_1_s, m.bristle.decay_1_s);
    return most_1_s;
  };
  const double before = slowest();
  axis.friction.vs_m_s *= 10.0;
  EXPECT_NEAR(slowest(), 10.0 * before, 1e-6 * before);
}

}  // namespace
}  // namespace contour
