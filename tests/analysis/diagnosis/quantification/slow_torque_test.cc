#include "analysis/diagnosis/quantification/slow_torque.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "analysis/diagnosis/decision/residual_trace.h"
#include "tests/analysis/support/hidden_axis.h"
#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

Traces TracesAt(const test::LearntProblem& learnt) {
  Fit fit;
  fit.point = learnt.point;
  fit.raw = learnt.problem.Raw(std::span(&learnt.point, 1))[0];
  return MakeTraces(learnt.problem, fit, fit);
}

/// What is noted of an axis whose log says that it was given so much more [Nm] for three seconds.
std::vector<std::string> NotesWith(double torque_Nm) {
  test::HiddenAxis made = test::HiddenAxisFor(30.0);
  const auto row = [&](double time_s) { return static_cast<std::size_t>(time_s / made.log.period_s + 0.5); };
  for (std::size_t k = row(12.0); k < row(15.0); ++k) made.log.command[k] -= torque_Nm;
  const test::LearntProblem learnt(made);
  Diagnosis out;
  out.free_run_s = 1.0;
  out.traces = TracesAt(learnt);
  TellSlowTorque(learnt.problem, out);
  return out.notes;
}

double NumberAfter(const std::string& note, const std::string& words) {
  return std::stod(note.substr(note.find(words) + words.size()));
}

TEST(SlowTorque, AForceFromOutsideIsToldWithSizeAndInstant) {
  constexpr double kForce_Nm = 0.2;
  for (const double sign : {-1.0, 1.0}) {
    const std::vector<std::string> notes = NotesWith(sign * kForce_Nm);
    ASSERT_EQ(notes.size(), 1U);
    // What is missing from the command moves the axis all the same.
    EXPECT_NEAR(std::abs(NumberAfter(notes[0], "goes up to ")), kForce_Nm, 0.1 * kForce_Nm) << notes[0];
    EXPECT_GE(NumberAfter(notes[0], "from "), 11.5) << notes[0];
    EXPECT_LE(NumberAfter(notes[0], "from "), 14.5) << notes[0];
  }
}

TEST(SlowTorque, NothingIsSaidOfASoundLog) { EXPECT_TRUE(NotesWith(0.0).empty()); }

TEST(SlowTorque, NothingIsSaidOfALogThatIsTooShort) {
  const test::LearntProblem learnt(test::HiddenAxisFor(30.0));
  Diagnosis out;
  out.free_run_s = 20.0;
  out.traces = TracesAt(learnt);
  TellSlowTorque(learnt.problem, out);
  EXPECT_TRUE(out.notes.empty());
}

}  // namespace
}  // namespace contour::diagnosis
