#include "daemon/bus_health.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class BusHealthTest : public ::testing::Test {
 protected:
  /// All lines of one look.
  std::string Look(milliseconds later = milliseconds(2)) {
    now_ += later;
    std::string text;
    for (const BusHealth::Line& line : health_.Look(1, state_, now_)) text += line.text + "\n";
    return text;
  }
  static bool Has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

  BusHealth health_{{{"main", "can0"}, {"other", "can1"}}};
  BusState state_;
  BusHealth::Time now_ = BusHealth::Time() + seconds(1000);
};

TEST_F(BusHealthTest, ErrorPassiveIsToldWithItsCountersAndWhatToLookFor) {
  EXPECT_EQ(Look(), "");
  state_.errors = ControllerErrors::kPassive;
  state_.transmit_errors = 136;
  const std::string line = Look();
  for (const char* part : {"bus other", "error passive", "transmit 136", "bus-off is next", "terminations"})
    EXPECT_TRUE(Has(line, part)) << line;
  EXPECT_EQ(Look(), "") << "once";
  state_.errors = ControllerErrors::kActive;
  EXPECT_EQ(Look(), "") << "it may come back at once";
  EXPECT_TRUE(Has(Look(seconds(11)), "error active again"));
}

TEST_F(BusHealthTest, AControllerBetweenTwoStatesDoesNotFillTheJournal) {
  int lines = 0;
  for (int i = 0; i < 30'000; ++i) {
    state_.errors = i % 2 == 0 ? ControllerErrors::kPassive : ControllerErrors::kWarning;
    lines += Look().empty() ? 0 : 1;
  }
  EXPECT_GE(lines, 2);
  EXPECT_LE(lines, 7) << "in a minute";
}

TEST_F(BusHealthTest, BusOffAndItsEndAreToldAtOnce) {
  state_.errors = ControllerErrors::kPassive;
  EXPECT_NE(Look(), "");
  state_.bus_off = true;
  state_.bus_offs = 1;
  const std::string off = Look();
  EXPECT_TRUE(Has(off, "is bus-off") && Has(off, "ip link set can1 type can restart")) << off;
  state_.bus_off = false;
  state_.errors = ControllerErrors::kActive;
  const std::string over = Look();
  EXPECT_TRUE(Has(over, "bus-off is over") && Has(over, "error active again")) << over;
  EXPECT_EQ(Look(seconds(20)), "");
}

TEST_F(BusHealthTest, ABusOffThatWasOverBeforeAnybodyLookedIsToldAllTheSame) {
  state_.bus_offs = 2;
  EXPECT_TRUE(Has(Look(), "was bus-off and has restarted, 2 times"));
  EXPECT_EQ(Look(seconds(20)), "");
}

}  // namespace
}  // namespace contour
