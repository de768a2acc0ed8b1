#include "analysis/diagnosis/quantification/column_lag.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/hidden_axis.h"
#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

std::vector<std::string> Notes(bool from_velocity, double more_s) {
  test::HiddenAxis made = test::HiddenAxisFor(8.0);
  made.log.from_velocity = from_velocity;
  const test::LearntProblem learnt(made);
  Point point = learnt.point;
  if (more_s > 0.0) {
    const std::vector<SharedEffect> all = CatalogueEffects(learnt.problem);
    const auto delay =
        std::find_if(all.begin(), all.end(), [](const SharedEffect& e) { return e->kind == "input_delay"; });
    point.effects.push_back(*delay);
    point.amplitudes.push_back({more_s});
  }
  Diagnosis out;
  TellColumnLag(learnt.problem, point, out);
  return out.notes;
}

TEST(ColumnLag, OfALogWithAPositionNothingIsSaid) { EXPECT_TRUE(Notes(false, 2e-3).empty()); }

TEST(ColumnLag, HowLateAVelocityComesIsANote) {
  const std::vector<std::string> notes = Notes(true, 2e-3);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("comes 2000 us later"), std::string::npos) << notes[0];
}

TEST(ColumnLag, WhatIsNotToldOfALogWithoutAPositionIsSaid) {
  const std::vector<std::string> notes = Notes(true, 0.0);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].find("comes"), std::string::npos) << notes[0];
  EXPECT_NE(notes[0].find("Record the position"), std::string::npos) << notes[0];
}

}  // namespace
}  // namespace contour::diagnosis
