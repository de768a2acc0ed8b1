#include "drivers/can/error_frame.h"

#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>

#include <array>

#include "drivers/can/loopback_bus.h"

namespace contour {
namespace {

std::array<std::uint8_t, 8> Data(int controller, std::uint8_t transmit = 0, std::uint8_t receive = 0) {
  return {0, static_cast<std::uint8_t>(controller), 0, 0, 0, 0, transmit, receive};
}

struct Controller {
  BusState state;
  bool Says(std::uint32_t id, int controller = 0, bool holds_bus_off = false) {
    return TakeErrorFrame(id | CAN_ERR_FLAG, Data(controller), holds_bus_off, state);
  }
};

TEST(ErrorFrame, SaysWhetherTheControllerCountsManyErrors) {
  Controller c;
  EXPECT_FALSE(c.Says(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING));
  EXPECT_EQ(c.state.errors, ControllerErrors::kWarning);
  c.Says(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE);
  EXPECT_EQ(c.state.errors, ControllerErrors::kPassive);
  // What says nothing of it.
  c.Says(CAN_ERR_TX_TIMEOUT);
  c.Says(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW);
  EXPECT_EQ(c.state.errors, ControllerErrors::kPassive);
  c.Says(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_WARNING);
  EXPECT_EQ(c.state.errors, ControllerErrors::kWarning);
  c.Says(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE);
  c.Says(CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE);
  EXPECT_EQ(c.state.errors, ControllerErrors::kActive);
  EXPECT_EQ(c.state.error_frames, 7U);
}

TEST(ErrorFrame, CountersAreTakenWhereTheKernelSaysThatTheyAreThere) {
  BusState state;
  constexpr std::uint32_t kCounters = 0x200;
  TakeErrorFrame(CAN_ERR_FLAG | CAN_ERR_CRTL, Data(CAN_ERR_CRTL_TX_PASSIVE, 1, 2), false, state);
  EXPECT_EQ(state.transmit_errors, 0);
  TakeErrorFrame(CAN_ERR_FLAG | CAN_ERR_CRTL | kCounters, Data(CAN_ERR_CRTL_TX_PASSIVE, 130, 7), false,
                 state);
  EXPECT_EQ(state.transmit_errors, 130);
  EXPECT_EQ(state.receive_errors, 7);
}

TEST(ErrorFrame, ARestartEndsBusOffOnceItHasBeenSeen) {
  Controller c;
  c.Says(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE);
  EXPECT_TRUE(c.Says(CAN_ERR_BUSOFF));
  EXPECT_TRUE(c.Says(CAN_ERR_BUSOFF));
  EXPECT_EQ(c.state.bus_offs, 1U);
  c.Says(CAN_ERR_RESTARTED, 0, true);
  EXPECT_TRUE(c.state.bus_off);
  EXPECT_EQ(c.state.errors, ControllerErrors::kActive);
  c.Says(CAN_ERR_RESTARTED);
  EXPECT_FALSE(c.state.bus_off);
  c.Says(CAN_ERR_BUSOFF);
  EXPECT_EQ(c.state.bus_offs, 2U);
}

TEST(ErrorFrame, AnInterfaceThatIsSetUpAgainHasAControllerWithoutErrors) {
  Controller c;
  c.Says(CAN_ERR_CRTL | 0x200, CAN_ERR_CRTL_TX_PASSIVE);
  c.state.transmit_errors = 130;
  c.Says(CAN_ERR_BUSOFF);
  BeginsAnew(true, c.state);
  EXPECT_TRUE(c.state.bus_off) << "nobody has seen it yet";
  BeginsAnew(false, c.state);
  EXPECT_FALSE(c.state.bus_off);
  EXPECT_EQ(c.state.errors, ControllerErrors::kActive);
  EXPECT_EQ(c.state.transmit_errors, 0);
  EXPECT_EQ(c.state.bus_offs, 1U);
}

TEST(ErrorFrame, CanBeInjectedIntoTheBusInTheProcess) {
  LoopbackBus bus(1'000'000, {});
  bus.InjectErrorFrame(CAN_ERR_FLAG | CAN_ERR_CRTL, Data(CAN_ERR_CRTL_RX_PASSIVE));
  EXPECT_EQ(bus.State().errors, ControllerErrors::kPassive);
  bus.InjectErrorFrame(CAN_ERR_FLAG | CAN_ERR_BUSOFF, Data(0));
  EXPECT_TRUE(bus.State().bus_off);
}

}  // namespace
}  // namespace contour
