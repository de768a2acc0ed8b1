#include "design/start_loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "config/load_machine.h"
#include "tests/design/family_axes.h"

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;

TEST(StartSet, BeginsWithTheAxisAsStatedAndNamesEveryMemberOnce) {
  const std::vector<LoopMember> set = StartSet(AxisOf("t30"), {});
  EXPECT_EQ(set.front().name, SlidingMember(AxisOf("t30")).name);
  std::set<std::string> names;
  for (const LoopMember& m : set) EXPECT_TRUE(names.insert(m.name).second) << m.name;
}

TEST(StartSet, ReachesAsFarAsTheDoubt) {
  const LoopAxis axis = AxisOf("t30");
  double soft = 1e300, stiff = 0.0, light = 1e300, heavy = 0.0, bristle = 0.0;
  for (const LoopMember& m : StartSet(axis, {0.2, 1.5, 3.0})) {
    soft = std::min(soft, m.axis.stiffness_N_m / axis.axis.stiffness_N_m);
    stiff = std::max(stiff, m.axis.stiffness_N_m / axis.axis.stiffness_N_m);
    light = std::min(light, m.axis.table_mass_kg / axis.axis.table_mass_kg);
    heavy = std::max(heavy, m.axis.table_mass_kg / axis.axis.table_mass_kg);
    bristle = std::max(bristle, m.bristle.stiffness_N_m / axis.friction.sigma0_N_m);
  }
  EXPECT_NEAR(soft, 1.0 / 1.5, 1e-9);
  EXPECT_NEAR(stiff, 1.5, 1e-9);
  EXPECT_NEAR(light, 0.8, 1e-9);
  EXPECT_NEAR(heavy, 1.2, 1e-9);
  EXPECT_NEAR(bristle, 6.0, 1e-9);  // right after a reversal it is twice as stiff
}

TEST(StartLoop, ALoopForTheModelAloneIsNotCertainForTheCatalogue) {
  // A short search: enough to tell the two sets apart.
  LoopSearchOptions options;
  options.random_starts = 20;
  options.runs = 2;
  options.evaluations_per_run = 200;
  options.refinements = 1;
  options.evaluations_per_refinement = 200;
  const LoopAxis axis = AxisOf("t30");
  const FoundLoop tuned = SearchLoop(axis, kPeriod_s, options);
  ASSERT_TRUE(Acceptable(tuned.verdict, 0.05));
  EXPECT_NE(WhyNotToStartWith(axis, tuned.tuning, kPeriod_s), "");
  options.members = StartSet(axis, {});
  const FoundLoop start = SearchLoop(axis, kPeriod_s, options);
  EXPECT_TRUE(Acceptable(start.verdict, 0.05)) << Binding(start.verdict).name;
  EXPECT_GT(start.verdict.step.peak_m, tuned.verdict.step.peak_m);
}

// A table heavier than its motor, and a screw that may be half or twice as stiff: what bears all of it with
// the smallest error for 200 ms only holds against friction and never takes it up.
TEST(StartLoop, TakesUpAForceWhereTheDoubtLeavesLittle) {
  LoopAxis axis = AxisOf({"heavy table", 280.0, 163.0, 104.0, 53.0, 3480.0});
  axis.axis.lag_s = 0.36e-3;
  axis.encoder_step_m = 2.15e-3 / 524288.0;
  const StartLoop start = FindStartLoop(axis, kPeriod_s, 2);
  EXPECT_EQ(start.wrong, "");
  EXPECT_LT(start.found.verdict.step.left_m, 0.55 * start.found.verdict.step.peak_m);
}

TEST(StartLoop, AMachineIsNotCommissionedWithALoopThatIsNotCertain) {
  MachineConfig machine = LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/family/t30.yaml");
  machine.control.friction = FrictionKind::kLinear;
  // What tune finds for t30 of nearly known masses and stiffness (docs/laboratory/loop_designs.md).
  const LoopTuning sharp{15.8, 0.05, 0.23, 272.0, 1165.0, 1350.0, 0.77, 0.10, 0.03, 1.0, 5.0};
  for (auto& [name, axis] : machine.axes) {
    axis.loop = sharp;
    axis.model.uncertainty.clear();
  }
  EXPECT_NE(WhyLoopsMayNotStart(machine).find("axes.x.loop: "), std::string::npos);
  EXPECT_NE(WhyLoopsMayNotStart(machine).find("--catalogue"), std::string::npos);
  EXPECT_NE(WhyLoopsMayNotStart(machine).find("drive.mode: csp"), std::string::npos) << "where none is found";
  // What does not use it, it does not endanger.
  for (auto& [name, axis] : machine.axes) axis.drive.mode = DriveMode::kCsp;
  EXPECT_EQ(WhyLoopsMayNotStart(machine), "");
  for (auto& [name, axis] : machine.axes) axis.drive.mode = DriveMode::kCst;
  machine.control.friction = FrictionKind::kSrukf;
  EXPECT_EQ(WhyLoopsMayNotStart(machine), "");
}

TEST(CatalogueDoubt, IsTheCataloguesWhereNothingIsStatedAndTwoDeviationsElsewhere) {
  ModelConfig model;
  CatalogueDoubt doubt = DoubtOf(model);
  EXPECT_DOUBLE_EQ(doubt.masses_rel, 0.3);
  EXPECT_DOUBLE_EQ(doubt.stiffness_factor, 2.0);
  EXPECT_DOUBLE_EQ(doubt.friction_factor, 2.0);
  model.uncertainty = {{"motor_inertia_kgm2", 0.06}, {"table_mass_kg", 0.04}, {"screw_stiffness_N_um", 0.12}};
  doubt = DoubtOf(model);
  EXPECT_DOUBLE_EQ(doubt.masses_rel, 0.12);
  EXPECT_NEAR(doubt.stiffness_factor, std::exp(0.24), 1e-12);
  EXPECT_DOUBLE_EQ(doubt.friction_factor, 2.0);
  model.uncertainty = {{"motor_inertia_kgm2", 1.0}, {"table_mass_kg", 0.001}, {"screw_stiffness_N_um", 3.0}};
  EXPECT_DOUBLE_EQ(DoubtOf(model).masses_rel, 0.3);
  EXPECT_DOUBLE_EQ(DoubtOf(model).stiffness_factor, 2.0);
}

}  // namespace
}  // namespace contour
