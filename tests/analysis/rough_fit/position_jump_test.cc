#include "analysis/rough_fit/position_jump.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

test::HiddenAxis Made() { return test::HiddenAxisFor(30.0); }

TEST(PositionJump, AnAxisHasNone) { EXPECT_EQ(PositionJump(Made().log), ""); }

// Before: "nothing was found", one outlier.
TEST(PositionJump, AReferenceThatIsLostIsOne) {
  test::HiddenAxis axis = Made();
  const std::size_t at = axis.log.size() / 3;
  for (std::size_t k = at; k < axis.log.size(); ++k) axis.log.position[k] += 5.0;
  const std::string text = PositionJump(axis.log);
  EXPECT_NE(text.find(" 10 s after the first row"), std::string::npos) << text;
}

// Before: at 40.5 s, which is in neither file.
TEST(PositionJump, OfSeveralFilesIsToldInItsOwn) {
  test::HiddenAxis made = Made();
  std::vector<AxisLog> logs = {made.log, made.log};
  logs[0].source = "first.csv";
  logs[1].source = "second.csv";
  logs[0].position[5000] += 5.0;  // a single wrong reading is none
  EXPECT_EQ(PositionJump(logs, made.stated), "");
  for (std::size_t k = logs[1].size() / 3; k < logs[1].size(); ++k) logs[1].position[k] += 5.0;
  const std::string text = PositionJump(logs, made.stated);
  EXPECT_TRUE(text.starts_with("second.csv: the position jumps")) << text;
  EXPECT_NE(text.find(" 10 s after the first row"), std::string::npos) << text;
}

TEST(PositionJump, OneThatComesBackIsSeenToo) {
  test::HiddenAxis axis = Made();
  for (std::size_t k = axis.log.size() / 3; k < axis.log.size() / 2; ++k) axis.log.position[k] += 5.0;
  EXPECT_NE(PositionJump(axis.log).find(" 10 s after the first row"), std::string::npos)
      << PositionJump(axis.log);
}

// Rows of 20 ms: it takes five of them, and creeps everywhere else.
TEST(PositionJump, AQuickMotionAmongSlowOnesIsNone) {
  AxisLog log;
  log.period_s = 0.02;
  double q = 0.0;
  for (int k = 0; k < 2000; ++k) {
    q += 1e-3 + (k == 998 || k == 1002 ? 0.2 : k > 998 && k < 1002 ? 0.4 : 0.0);
    log.position.push_back(q);
    log.command.push_back(0.1);
    log.present.push_back(1);
  }
  EXPECT_EQ(PositionJump(log), "");
}

TEST(PositionJump, SoIsAnEncoderThatStoodStillWhileItMoved) {
  test::HiddenAxis axis = Made();
  const std::size_t at = axis.log.size() / 3;
  for (std::size_t k = at; k < at + 700; ++k) axis.log.position[k] = axis.log.position[at];
  EXPECT_NE(PositionJump(axis.log), "");
}

TEST(PositionJump, AReadingThatCameLateIsNone) {
  test::HiddenAxis axis = Made();
  for (std::size_t k = 5; k < axis.log.size(); k += 50)
    axis.log.position[k] = axis.log.position[k - 1] = axis.log.position[k - 2];
  EXPECT_EQ(PositionJump(axis.log), "");
}

TEST(PositionJump, NorIsWhatLiesOverAGap) {
  test::HiddenAxis axis = Made();
  const std::size_t at = axis.log.size() / 3;
  for (std::size_t k = at; k < axis.log.size(); ++k) axis.log.position[k] += 5.0;
  axis.log.present[at] = 0;
  EXPECT_EQ(PositionJump(axis.log), "");
}

}  // namespace
}  // namespace contour::diagnosis
