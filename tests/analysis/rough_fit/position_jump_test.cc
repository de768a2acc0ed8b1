#include "analysis/rough_fit/position_jump.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>

#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

test::HiddenAxis Made() {
  test::HiddenOptions o;
  o.duration_s = 30.0;
  return test::MakeHiddenAxis(o);
}

TEST(PositionJump, AnAxisHasNone) { EXPECT_EQ(PositionJump(Made().log), ""); }

// Before: "nothing was found", one outlier.
TEST(PositionJump, AReferenceThatIsLostIsOne) {
  test::HiddenAxis axis = Made();
  const std::size_t at = axis.log.size() / 3;
  for (std::size_t k = at; k < axis.log.size(); ++k) axis.log.position[k] += 5.0;
  const std::string text = PositionJump(axis.log);
  EXPECT_NE(text.find("at 10 s"), std::string::npos) << text;
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
