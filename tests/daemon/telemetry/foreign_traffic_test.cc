#include "daemon/telemetry/foreign_traffic.h"

#include <gtest/gtest.h>

#include "drivers/cia301/sdo_transfer.h"

namespace contour {
namespace {

CycleInput With(std::initializer_list<CanFrame> frames, std::uint8_t bus = 0) {
  CycleInput in;
  for (const CanFrame& f : frames) in.frames.push_back({f, bus, 0});
  return in;
}

class ForeignTrafficTest : public ::testing::Test {
 protected:
  ForeignTrafficTest() { traffic_.Watch({{"main", 127, {1, 2}}, {"other", 126, {1}}}); }
  ForeignTraffic traffic_;
};

TEST_F(ForeignTrafficTest, CountsRequestsToOurDrivesPerBusAndTellsOfThemOnce) {
  traffic_.Add(With({SdoReadFrame(1, 0x6064, 0), SdoReadFrame(5, 0x6064, 0)}));
  traffic_.Add(With({SdoReadFrame(2, 0x6064, 0)}));
  EXPECT_EQ(traffic_.summary()[0].sdo_requests, 2u) << "node 5 is none of ours";
  EXPECT_EQ(traffic_.summary()[1].sdo_requests, 0u);
  const auto message = traffic_.TakeMessage();
  ASSERT_TRUE(message);
  EXPECT_NE(message->find("bus main"), std::string::npos);
  EXPECT_NE(message->find("2 requests"), std::string::npos);
  traffic_.Add(With({SdoReadFrame(1, 0x6064, 0)}));
  EXPECT_FALSE(traffic_.TakeMessage()) << "a tool that asks all the time does not fill the journal";
}

TEST_F(ForeignTrafficTest, TellsOfNodesThatAreNoneOfOurs) {
  traffic_.Add(
      With({HeartbeatFrame(1, NmtState::kOperational), HeartbeatFrame(127, NmtState::kOperational)}));
  EXPECT_FALSE(traffic_.TakeMessage());
  traffic_.Add(With({HeartbeatFrame(7, NmtState::kOperational)}, 1));
  EXPECT_EQ(traffic_.summary()[1].nodes, std::vector<std::uint8_t>{7});
  const auto message = traffic_.TakeMessage();
  ASSERT_TRUE(message);
  EXPECT_NE(message->find("bus other"), std::string::npos);
  EXPECT_FALSE(traffic_.TakeMessage());
}

}  // namespace
}  // namespace contour
