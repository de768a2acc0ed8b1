#include "analysis/diagnosis/causes/experiments.h"

#include <gtest/gtest.h>

#include <string>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"
#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

std::string ProgramFor(const test::HiddenAxis& axis, std::string_view kind) {
  const Problem problem(axis.log, axis.stated, 1);
  return DecidingExperiment(problem, kind, {}).program;
}

TEST(DecidingExperiment, MovesTheAxisOfTheLog) {
  test::HiddenOptions options;
  options.duration_s = 5.0;
  test::HiddenAxis axis = test::MakeHiddenAxis(options);
  axis.stated.axis = "feed";
  for (const CauseDefinition* cause : AllCauses()) {
    const std::string_view kind = cause->name;
    const std::string program = ProgramFor(axis, kind);
    EXPECT_EQ(program.find("axis: x"), std::string::npos) << kind;
    EXPECT_TRUE(program.empty() || program.find("axis: feed") != std::string::npos) << kind << '\n'
                                                                                    << program;
  }
  // A model alone has no name; its log may have one.
  axis.stated.axis = "";
  axis.log.axis = "z";
  EXPECT_NE(ProgramFor(axis, "cogging").find("axis: z"), std::string::npos);
  axis.log.axis = "";
  EXPECT_NE(ProgramFor(axis, "cogging").find("axis: x"), std::string::npos);
}

TEST(DecidingExperiment, EveryProgramCanBeRead) {
  const test::KnownAxis axis;
  for (const CauseDefinition* cause : AllCauses())
    for (const std::vector<std::string>& hypotheses : {std::vector<std::string>{}, {"compliance"}}) {
      const Experiment experiment = DecidingExperiment(axis.problem, *cause->name, hypotheses);
      if (experiment.program.empty()) continue;
      EXPECT_FALSE(experiment.text.empty()) << *cause->name;
      EXPECT_NO_THROW(test::DecidingProgram(axis, *cause->name, hypotheses)) << experiment.program;
    }
}

TEST(DecidingExperiment, StaysWithinTheSpeedAndTheStrokeOfTheLog) {
  const test::KnownAxis axis;
  for (const CauseDefinition* cause : AllCauses()) {
    if (DecidingExperiment(axis.problem, *cause->name, {}).program.empty()) continue;
    const Program program = test::DecidingProgram(axis, *cause->name);
    if (const auto* creep = std::get_if<CreepShape>(&program.shape)) {
      EXPECT_EQ(creep->stroke_mm, 100.0) << *cause->name;
      for (const double v : creep->velocities_mm_s)
        EXPECT_LT(v, 1e3 * test::KnownAxis::kTopSpeed_m_s) << *cause->name;
    }
    if (program.torque) {
      EXPECT_LT(program.torque->amplitude_Nm, axis.stated.rated) << *cause->name;
    }
  }
}

TEST(DecidingExperiment, StrokesAtFiveSpeedsAreFiveThatRise) {
  const test::KnownAxis axis;
  const auto creep = std::get<CreepShape>(test::DecidingProgram(axis, "viscous_nonlinear").shape);
  ASSERT_EQ(creep.velocities_mm_s.size(), 5u);
  for (std::size_t i = 1; i < 5; ++i) EXPECT_GT(creep.velocities_mm_s[i], 1.3 * creep.velocities_mm_s[i - 1]);
}

TEST(DecidingExperiment, GivesTorqueAtTheMotorWhateverTheLogHas) {
  const test::KnownAxis rotary, linear({.linear = true});
  const auto steps = [](const test::KnownAxis& axis) {
    return std::get<TorqueStepsShape>(test::DecidingProgram(axis, "constant_torque").shape).torques_Nm;
  };
  EXPECT_EQ(steps(rotary), steps(linear));
}

TEST(DecidingExperiment, PushesAtLeastAsHardAsFriction) {
  test::KnownAxis axis;
  axis.problem.signals->coulomb = 0.4;  // of 0.64 Nm rated
  EXPECT_EQ(std::get<TorqueStepsShape>(test::DecidingProgram(axis, "constant_torque").shape).torques_Nm[0],
            0.4);
}

TEST(DecidingExperiment, WhatHasNoNameIsShownByTheExperimentOfItsQuantity) {
  const test::KnownAxis axis;
  EXPECT_EQ(ExperimentOn(axis.problem, Quantity::kTemperature),
            SameStrokesWarmAndCold(axis.problem, false).text);
  EXPECT_EQ(ExperimentOn(axis.problem, Quantity::kSpeed), FiveSpeedsAndPulses(axis.problem, false).text);
  EXPECT_NE(ExperimentOn(axis.problem, Quantity::kTime), ExperimentOn(axis.problem, Quantity::kPosition));
}

}  // namespace
}  // namespace contour::diagnosis
