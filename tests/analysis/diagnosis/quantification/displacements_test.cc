#include "analysis/diagnosis/quantification/displacements.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "tests/analysis/support/hidden_axis.h"
#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

/// Notes on an axis whose position is off by so much [rad] from each of these rows on.
std::vector<std::string> NotesWith(const std::vector<std::pair<std::size_t, double>>& jumps) {
  test::HiddenAxis made = test::HiddenAxisFor(30.0);
  for (const auto& [row, by] : jumps)
    for (std::size_t k = row; k < made.log.size(); ++k) made.log.position[k] += by;
  const test::LearntProblem learnt(made);
  Diagnosis out;
  TellDisplacements(learnt.problem, learnt.point, out);
  return out.notes;
}

TEST(Displacements, ASoundLogHasNone) { EXPECT_TRUE(NotesWith({}).empty()); }

// Before: "nothing was found", two outliers.
TEST(Displacements, AnEncoderThatLosesCountsIsTold) {
  const std::vector<std::string> notes = NotesWith({{9999, 0.1}, {15000, -0.2}});
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("2 times, at 9.999 s first, by up to (at 15 s) "), std::string::npos) << notes[0];
  EXPECT_NE(notes[0].find(" rad."), std::string::npos) << notes[0];
}

TEST(Displacements, AWrongReadingIsNone) {
  for (const std::string& note : NotesWith({{9999, 0.1}, {10000, -0.1}})) ADD_FAILURE() << note;
}

}  // namespace
}  // namespace contour::diagnosis
