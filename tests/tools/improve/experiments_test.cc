#include "tools/improve/experiments.h"

#include <gtest/gtest.h>

#include "config/load_machine.h"
#include "daemon/program_limits.h"

namespace contour::improve {
namespace {

using diagnosis::Cause;
using diagnosis::Diagnosis;
using diagnosis::Verdict;

Cause Found(const std::string& kind, double gain_low) {
  Cause c;
  c.kind = kind;
  c.heldout_gain_low = gain_low;
  c.heldout_gain = gain_low + 0.1;
  return c;
}

Diagnosis Says(Verdict verdict, std::vector<Cause> causes) {
  Diagnosis d;
  d.verdict = verdict;
  d.causes = std::move(causes);
  return d;
}

TEST(WhatIsOpen, NothingWhereEveryCauseGainsForCertain) {
  EXPECT_EQ(WhatIsOpen(Says(Verdict::kCauseFound, {Found("cogging", 0.2)})), "");
}

TEST(WhatIsOpen, SetsTheUnexplainedAndWhatMayGainNothing) {
  for (const Verdict v : {Verdict::kNothingFound, Verdict::kUnexplained, Verdict::kInsufficientData})
    EXPECT_NE(WhatIsOpen(Says(v, {})), "");
  EXPECT_NE(WhatIsOpen(Says(Verdict::kCauseFound, {Found("cogging", 0.2), Found("stribeck", -0.01)})), "");
  Cause set = Found("cable_spring", 0.2);
  set.indistinguishable_from = {"constant_torque"};
  EXPECT_NE(WhatIsOpen(Says(Verdict::kAmbiguous, {set})), "");
}

TEST(WhatIsOpen, ACauseOfLittleEvidenceDecidesNothing) {
  Cause large = Found("cogging", 0.2), small = Found("cable_spring", -0.2);
  small.indistinguishable_from = {"constant_torque"};
  large.log_evidence_gain = 1000.0;
  small.log_evidence_gain = 90.0;
  EXPECT_EQ(WhatIsOpen(Says(Verdict::kAmbiguous, {large, small})), "");
  small.log_evidence_gain = 900.0;
  EXPECT_NE(WhatIsOpen(Says(Verdict::kAmbiguous, {large, small})), "");
}

TEST(DecidingPrograms, EachOnceAndNoneThatHasRun) {
  Cause a = Found("constant_torque", 0.1), b = Found("asymmetric_coulomb", 0.1), c = Found("cogging", 0.1);
  a.deciding_program = b.deciding_program = "steps";
  c.deciding_program = "speeds";
  a.indistinguishable_from = {"asymmetric_coulomb"};
  b.indistinguishable_from = {"constant_torque"};
  c.indistinguishable_from = {"friction_ripple"};
  Cause decided = Found("stribeck", 0.1);
  decided.deciding_program = "reversals";
  const Diagnosis d = Says(Verdict::kAmbiguous, {a, b, c, decided, Found("payload_step", 0.1)});
  const auto programs = DecidingPrograms(d, {});
  ASSERT_EQ(programs.size(), 2u);
  EXPECT_EQ(programs[0].text, "steps");
  EXPECT_EQ(programs[1].text, "speeds");
  EXPECT_EQ(DecidingPrograms(d, {{"", "steps", ProgramFormat::kYaml}}).size(), 1u);
}

class RunnableTest : public ::testing::Test {
 protected:
  static PerAxis<double> Zero() {
    PerAxis<double> zero(2);
    zero[0] = zero[1] = 0.0;
    return zero;
  }
  static ProgramText Creep(double stroke_mm, double speed_mm_s) {
    return {"a creep",
            "shape: creep\naxis: x\nstroke_mm: " + std::to_string(stroke_mm) + "\nvelocities_mm_s: [" +
                std::to_string(speed_mm_s) + "]\n",
            ProgramFormat::kYaml};
  }
  const MachineConfig machine_ = LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml");
  const PerAxis<PlanLimits> limits_ = ProgramLimits(machine_);
  const WorkingSpace space_ = SpaceFor(machine_, "x", {20.0, 50.0, 0.9}, Zero());
  std::vector<std::string> left_out_;
};

TEST_F(RunnableTest, WhatIsTooLargeTooFastOrTooLongIsLeftOutAndSaid) {
  const auto placed = Runnable({Creep(15, 20), Creep(25, 20), Creep(10, 60), Creep(10, 0.1), Creep(5, 10)},
                               space_, limits_, Zero(), 30.0, left_out_);
  ASSERT_EQ(placed.size(), 2u);
  ASSERT_EQ(left_out_.size(), 3u);
  EXPECT_NE(left_out_[0].find("--travel_mm"), std::string::npos) << left_out_[0];
  EXPECT_NE(left_out_[1].find("--max_speed_mm_s"), std::string::npos) << left_out_[1];
  EXPECT_NE(left_out_[2].find("s are left"), std::string::npos) << left_out_[2];
}

TEST_F(RunnableTest, AProgramBeginsWhereAllOfItFits) {
  const auto placed = Runnable({Creep(15, 20), Creep(-15, 20)}, space_, limits_, Zero(), 100.0, left_out_);
  ASSERT_EQ(placed.size(), 2u);
  EXPECT_LE(placed[0].start_m[0] + 15e-3, space_.axes[0].high_m);
  EXPECT_LT(placed[0].start_m[0], 0.0);
  EXPECT_GE(placed[1].start_m[0] - 15e-3, space_.axes[0].low_m);
  EXPECT_EQ(placed[0].start_m[1], 0.0) << "what does not move stays";
  EXPECT_TRUE(placed[0].moves[0]);
  EXPECT_FALSE(placed[0].moves[1]);
}

TEST_F(RunnableTest, TheWayThereMovesOneAxisAfterTheOther) {
  PerAxis<double> to = Zero();
  to[0] = 2e-3;
  to[1] = -3e-3;
  const auto way = WayTo(Zero(), to, space_);
  ASSERT_EQ(way.size(), 2u);
  for (const ProgramText& w : way) EXPECT_NO_THROW(Place(w, space_, limits_, Zero())) << w.text;
  EXPECT_NE(way[1].text.find("[y, x]"), std::string::npos);
  EXPECT_TRUE(WayTo(to, to, space_).empty());
}

}  // namespace
}  // namespace contour::improve
