#include "tools/validation/family/cnc_tuning.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "config/config_error.h"

namespace contour {
namespace {

CncTuned Some() {
  CncTuned t{"m100s", FamilyPlant::kRough, {1.31, 0.9, 1.44, 0.354, 1.31, -0.125, 11.2, 0.716, 0.16, 54.5}};
  t.before_um = 0.737;
  t.after_um = 0.42;
  t.evaluations = 270;
  return t;
}

std::string Written(const std::string& text) {
  const auto file = std::filesystem::path(::testing::TempDir()) / "cnc_tuned_test.csv";
  std::ofstream(file) << text;
  return file.string();
}

TEST(CncTuning, WhatIsWrittenIsRead) {
  std::ostringstream out;
  WriteCncTuned(out, {Some()});
  const std::vector<CncTuned> read = ReadCncTuned(Written(out.str()));
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].values, Some().values);
  EXPECT_EQ(read[0].evaluations, 270);
  FamilySetting setting{"m100s"};
  EXPECT_EQ(FindCncTuned(read, setting), nullptr);
  setting.plant = FamilyPlant::kRough;
  EXPECT_EQ(FindCncTuned(read, setting), &read[0]);
}

TEST(CncTuning, ADamagedLineIsToldByItsNumber) {
  std::ostringstream out;
  WriteCncTuned(out, {Some()});
  const std::string file = Written(out.str() + "base,ideal,1,2\n");
  try {
    ReadCncTuned(file);
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find(file + ":3"), std::string::npos) << e.what();
  }
  EXPECT_THROW(ReadCncTuned("/nowhere.csv"), ConfigError);
}

TEST(CncTuning, WithoutADualLoopNothingIsSaidOfIt) {
  CncTuned t = Some();
  EXPECT_EQ(CncAssignments(t).size(), 10U);
  t.values.back() = 0.0;
  EXPECT_EQ(CncAssignments(t).size(), 9U);
}

TEST(CncTuning, ASmallBudgetImprovesOnTheStart) {
  CncTask task;
  task.machine = "base";
  task.evaluations_per_key = 2;
  const CncTuned tuned = TuneCnc(FAMILY_DIR, task);
  EXPECT_EQ(tuned.evaluations, 18);
  EXPECT_LT(tuned.before_um, 2.0);  // the model's own numbers compensate already
  EXPECT_LT(tuned.after_um, 0.95 * tuned.before_um);
}

}  // namespace
}  // namespace contour
