#include "analysis/diagnosis/quantification/displacements.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/analysis/support/hidden_axis.h"
#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

/// So much further [rad] from a row on.
using Jumps = std::vector<std::pair<std::size_t, double>>;

/// What is noted of an axis whose encoder reads so: outliers are marked, as in any log.
std::vector<std::string> NotesOn(test::HiddenAxis made, const Jumps& jumps) {
  for (const auto& [row, by] : jumps)
    for (std::size_t k = row; k < made.log.size(); ++k) made.log.position[k] += by;
  const test::LearntProblem learnt(made);
  Diagnosis out;
  TellDisplacements(learnt.problem, learnt.point, out);
  return out.notes;
}

std::vector<std::string> NotesWith(const Jumps& jumps) { return NotesOn(test::HiddenAxisFor(30.0), jumps); }

TEST(Displacements, ASoundLogHasNone) { EXPECT_TRUE(NotesWith({}).empty()); }

// Before: "nothing was found", two outliers.
TEST(Displacements, AnEncoderThatLosesCountsIsTold) {
  const std::vector<std::string> notes = NotesWith({{9999, 0.1}, {15000, -0.2}});
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("2 times, at 9.999 s first, by up to (at 15 s) "), std::string::npos) << notes[0];
  EXPECT_NE(notes[0].find(" rad."), std::string::npos) << notes[0];
}

TEST(Displacements, AWrongReadingIsNoneHoweverLongItLasts) {
  for (const std::size_t rows : {1U, 2U, 3U})
    for (const std::string& note : NotesWith({{9999, 0.1}, {9999 + rows, -0.1}}))
      ADD_FAILURE() << rows << " rows: " << note;
}

TEST(Displacements, AReadingThatWasHeldIsNone) {
  for (const std::size_t rows : {1U, 3U, 4U, 5U, 20U}) {
    test::HiddenAxis made = test::HiddenAxisFor(30.0);
    for (const std::size_t from : {4250U, 9999U, 15000U})
      for (std::size_t k = from; k < from + rows; ++k) made.log.position[k] = made.log.position[from - 1];
    for (const std::string& note : NotesOn(std::move(made), {})) ADD_FAILURE() << rows << " rows: " << note;
  }
}

// Three jumps and an impact that changes the speed at once: it is no jump, and hides none.
TEST(Displacements, AnImpactHidesNone) {
  test::HiddenAxis made = test::HiddenAxisFor(30.0);
  constexpr std::size_t kImpact = 20000, kLasts = 20;
  double off = 0.0;
  for (std::size_t k = kImpact; k < made.log.size(); ++k) {
    if (k < kImpact + kLasts) off += 0.1;
    made.log.position[k] += off;
  }
  const std::vector<std::string> notes =
      NotesOn(std::move(made), {{6000, 0.08}, {9999, 0.08}, {15000, -0.08}});
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("3 times, at 6 s first"), std::string::npos) << notes[0];
}

// Of a coarse, noisy encoder and next to no command: what a row shows is not what a force does.
TEST(Displacements, NoiseAndStepsOfTheEncoderAreNone) {
  test::HiddenAxis made = test::HiddenAxisFor(30.0);
  std::uint32_t random = 1;
  for (double& position : made.log.position) {
    random = 1664525U * random + 1013904223U;
    const double noise = 0.02 * (static_cast<double>(random >> 8U) / 16777216.0 - 0.5);
    position = 0.01 * std::round((position + noise) / 0.01);
  }
  for (const std::string& note : NotesOn(std::move(made), {})) ADD_FAILURE() << note;
}

}  // namespace
}  // namespace contour::diagnosis
