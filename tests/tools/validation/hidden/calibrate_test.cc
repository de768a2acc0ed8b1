// The model-error allowances are what the rule makes of recorded machines, and nothing else.

#include "tools/validation/hidden/calibrate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "analysis/diagnosis/tuning/model_error.h"
#include "analysis/text/format_text.h"

namespace contour::hidden {
namespace {

std::string TextOf(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string Line(const std::string& log, int accepted, double explained, bool in_base,
                 const std::string& kind, double tested) {
  return FormatText("%s,100000,0.05,%d,%.0f,%d,%s,50,5,1,60,%.1f,2.0,4.0,10\n", log.c_str(), accepted,
                    explained, in_base ? 1 : 0, kind.c_str(), tested);
}

std::string TableOf(const std::string& evidence) {
  std::istringstream stream(evidence);
  return ModelErrorTable(stream);
}

double Scale(const std::string& table, const std::string& kind) {
  const std::size_t at = table.find("{\"" + kind + "\"");
  double share = 0.0, scale = 0.0;
  if (at == std::string::npos) return 0.0;
  std::sscanf(table.c_str() + at + kind.size() + 4, "%lf, %lf", &share, &scale);
  return scale;
}

TEST(ModelErrorTable, InTheSourceIsWhatTheStoredEvidenceGives) {
  const std::string evidence = TextOf(SOURCE_DIR "/tests/tools/validation/hidden/evidence.csv");
  ASSERT_FALSE(evidence.empty());
  EXPECT_EQ(TableOf(evidence), TextOf(SOURCE_DIR "/analysis/diagnosis/tuning/model_error_table.inc"));
}

TEST(ModelErrorTable, AKindWhoseScoresExceedTheFlipsGetsAnAllowanceOfItsOwn) {
  std::string evidence;
  for (int i = 0; i < 20; ++i) {
    const std::string log = FormatText("clean_%04d", i);
    evidence += Line(log, 0, 0.0, false, "cogging", 1.0);  // below the flips
    if (i < 4) evidence += Line(log, 0, 0.0, false, "backlash", 24.0);
    evidence += Line(log, 0, 0.0, true, "stribeck", 90.0);  // its evidence is in the priors
  }
  const std::string table = TableOf(evidence);
  // Four exceed by 20; the scale of all kinds is 20 / ln 2.
  EXPECT_NEAR(Scale(table, "backlash"), (80.0 + 28.85) / 5.0, 0.01);
  EXPECT_EQ(table.find("cogging"), std::string::npos);
  EXPECT_EQ(table.find("stribeck"), std::string::npos);
}

TEST(ModelErrorTable, ALogThatOneKindGoesFarWrongInLeavesTheOthersAlone) {
  std::string evidence;
  for (int i = 0; i < 20; ++i)
    evidence +=
        Line(FormatText("clean_%04d", i), 0, 0.0, false, i < 5 ? "cogging" : "backlash", i < 5 ? 6.0 : 1.0);
  const std::string wrong = Line("clean_0020", 0, 0.0, false, "viscous_nonlinear", 104.0);
  EXPECT_NEAR(Scale(TableOf(evidence), ""), 2.0 / std::log(2.0), 0.01);
  EXPECT_NEAR(Scale(TableOf(evidence + wrong), ""), 2.0 / std::log(2.0), 0.01);
  EXPECT_GT(Scale(TableOf(evidence + wrong), "viscous_nonlinear"), 50.0);
}

TEST(ModelErrorTable, WhatIsLeftOfACauseIsASingleEffectsSecondRound) {
  const std::string evidence = Line("clean_0001", 0, 0.0, false, "cogging", 1.0) +
                               Line("clear_backlash_0001", 1, 10000.0, false, "compliance", 54.0) +
                               Line("clear_cogging_0001", 1, 10000.0, false, "compliance", 3.0);
  const std::string table = TableOf(evidence);
  EXPECT_NE(table.find("{\"backlash\""), std::string::npos);
  EXPECT_NE(table.find("1.5e-02"), std::string::npos);  // three times (54 - 4) / 10000
  EXPECT_EQ(table.find("{\"cogging\""), std::string::npos);
}

TEST(ModelErrorTable, WhatIsLeftAsAnotherOfTheKindIsNotLeftAsOthers) {
  const std::string table = TableOf(Line("clean_0001", 0, 0.0, false, "cogging", 1.0) +
                                    Line("clear_cogging_0001", 1, 10000.0, false, "cogging", 54.0) +
                                    Line("clear_cogging_0001", 1, 10000.0, false, "backlash", 14.0));
  // Three times 10 / 10000, and of the kind three times 50 / 10000.
  EXPECT_NE(table.find("3.0e-03, 1.2e-02}"), std::string::npos) << table;
}

TEST(ModelErrorTable, WhatIsUnexplainedHasAPartOfTheRateForItself) {
  std::string evidence;
  for (int i = 0; i < 20; ++i) {
    const std::string log = FormatText("clean_%04d", i);
    evidence += Line(log, 0, 0.0, false, "cogging", i < 3 ? 6.0 : 1.0);
    if (i < 2) evidence += Line(log, 0, 0.0, false, "unexplained", 44.0);
  }
  const std::string table = TableOf(evidence);
  EXPECT_NEAR(Scale(table, ""), 2.0 / std::log(2.0), 0.01);  // as without it
  EXPECT_NEAR(Scale(table, "unexplained"), (80.0 + 2.0 / std::log(2.0)) / 3.0, 0.01);
  // Nor is it what is left of a cause.
  EXPECT_EQ(TableOf(evidence + Line("clear_backlash_0001", 1, 10000.0, false, "unexplained", 54.0)), table);
}

TEST(ModelErrorTable, RefusesWhatIsNoEvidence) {
  EXPECT_THROW(TableOf(""), std::runtime_error);
  EXPECT_THROW(TableOf("clean_0001,2,3\n"), std::runtime_error);
  EXPECT_THROW(TableOf(Line("clean_0001", 0, 0.0, false, "cogging", 1.0).replace(11, 6, "x00000")),
               std::runtime_error);
  EXPECT_THROW(TableOf(Line("clear_cogging_0001", 0, 0.0, false, "cogging", 1.0)), std::runtime_error);
}

TEST(ModelErrorAllowance, GrowAsTheRateFalls) {
  const double at_5 = diagnosis::AllowancePerRow("cogging", 0.05),
               at_1 = diagnosis::AllowancePerRow("cogging", 0.01);
  EXPECT_GT(at_5, 0.0);
  EXPECT_GT(at_1, at_5);
  EXPECT_EQ(diagnosis::AllowancePerRow("cogging", 0.999), 0.0);
  EXPECT_EQ(at_5, diagnosis::AllowancePerRow("no kind of its own", 0.05));
}

}  // namespace
}  // namespace contour::hidden
