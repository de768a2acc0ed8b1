#include "drivers/can/error_frame.h"

#include <linux/can.h>
#include <linux/can/error.h>

namespace contour {
namespace {

constexpr unsigned kPassive = CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE;
constexpr unsigned kWarning = CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING;
// CAN_ERR_CNT: bytes 6 and 7 are the counters. Headers of kernels before 6.0 do not name it.
constexpr std::uint32_t kHasCounters = 0x00000200;

}  // namespace

bool TakeErrorFrame(std::uint32_t id, std::span<const std::uint8_t, 8> data, bool holds_bus_off,
                    BusState& state) noexcept {
  ++state.error_frames;
  const bool bus_off = (id & CAN_ERR_BUSOFF) != 0;
  if (bus_off) {
    if (!state.bus_off) ++state.bus_offs;
    state.bus_off = true;
  }
  if ((id & CAN_ERR_RESTARTED) != 0) {
    if (!bus_off && !holds_bus_off) state.bus_off = false;
    state.errors = ControllerErrors::kActive;
  }
  if ((id & CAN_ERR_CRTL) != 0) {
    // One that says of an overflow only leaves the state as it was.
    if ((data[1] & kPassive) != 0)
      state.errors = ControllerErrors::kPassive;
    else if ((data[1] & kWarning) != 0)
      state.errors = ControllerErrors::kWarning;
    else if ((data[1] & CAN_ERR_CRTL_ACTIVE) != 0)
      state.errors = ControllerErrors::kActive;
  }
  if ((id & kHasCounters) != 0) {
    state.transmit_errors = data[6];
    state.receive_errors = data[7];
  }
  return bus_off;
}

void BeginsAnew(bool holds_bus_off, BusState& state) noexcept {
  if (!holds_bus_off) state.bus_off = false;
  state.errors = ControllerErrors::kActive;
  state.transmit_errors = state.receive_errors = 0;
}

}  // namespace contour
