#include "drivers/cia301/bring_up_text.h"

#include <gtest/gtest.h>

#include <vector>

#include "drivers/cia301/bring_up_status.h"

namespace contour {
namespace {

const std::vector<std::string> kAxes{"x", "y"};

BringUpStatus Status(BringUpPhase phase, BringUpError error) {
  BringUpStatus s;
  s.phase = static_cast<std::uint8_t>(phase);
  s.error = static_cast<std::uint8_t>(error);
  s.axis = 1;
  s.node_id = 2;
  return s;
}

TEST(BringUpText, SaysWhereItStands) {
  EXPECT_EQ(BringUpText(Status(BringUpPhase::kOff, BringUpError::kNone), kAxes), "drives not brought up yet");
  EXPECT_EQ(BringUpText(Status(BringUpPhase::kOperational, BringUpError::kNone), kAxes),
            "all drives operational");
  BringUpStatus s = Status(BringUpPhase::kBootUp, BringUpError::kNone);
  s.waited_us = 250'000;
  EXPECT_EQ(BringUpText(s, kAxes), "axis y (node 2), wait for boot-up: waiting for 250 ms");
}

TEST(BringUpText, NamesObjectBothValuesAndAbortCode) {
  BringUpStatus s = Status(BringUpPhase::kIdentity, BringUpError::kIdentity);
  s.index = 0x1018;
  s.sub_index = 2;
  s.expected = 0x10;
  s.found = 0x2A;
  EXPECT_EQ(BringUpText(s, kAxes),
            "axis y (node 2), check identity: identity 0x1018:02 differs from the configuration: expected 16 "
            "(0x10), "
            "found 42 (0x2A); this is another drive than the machine file says");
  s.sub_index = 4;
  EXPECT_NE(BringUpText(s, kAxes).find("0x1018:04 differs"), std::string::npos);
  EXPECT_NE(BringUpText(s, kAxes).find("the cables of two drives are exchanged"), std::string::npos);
  s = Status(BringUpPhase::kPdo, BringUpError::kSdoAbort);
  s.index = 0x1A00;
  s.sub_index = 3;
  s.abort_code = 0x06040041;
  EXPECT_EQ(BringUpText(s, kAxes),
            "axis y (node 2), set up PDOs: the drive refused TPDO mapping 0x1A00:03: object cannot be mapped "
            "to the PDO "
            "(abort code 0x06040041)");
  s = Status(BringUpPhase::kStart, BringUpError::kNotOperational);
  s.found = 0x7F;
  s.waited_us = 500'000;
  EXPECT_EQ(BringUpText(s, kAxes),
            "axis y (node 2), wait for Operational: the drive did not become Operational within 500 ms "
            "(drive.operational_ms) after NMT start: "
            "its heartbeat says Pre-operational");
}

TEST(BringUpText, HasASentenceForEveryError) {
  for (std::uint8_t e = 1; e <= static_cast<std::uint8_t>(BringUpError::kReadOnlyDiffers); ++e) {
    if (e == 17) continue;
    const std::string text = BringUpText(Status(BringUpPhase::kFind, static_cast<BringUpError>(e)), kAxes);
    EXPECT_EQ(text.find("unknown error"), std::string::npos) << text;
    EXPECT_GT(text.size(), 50u) << text;
  }
}

}  // namespace
}  // namespace contour
