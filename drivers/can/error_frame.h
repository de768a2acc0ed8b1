#pragma once

#include <cstdint>
#include <span>

#include "drivers/can/frame_bus.h"

namespace contour {

/// What an error frame of SocketCAN says of the controller goes into `state`. `holds_bus_off`: a restart does
/// not end a bus-off that nobody has seen yet. True when the frame says bus-off.
bool TakeErrorFrame(std::uint32_t id, std::span<const std::uint8_t, 8> data, bool holds_bus_off,
                    BusState& state) noexcept;

/// A controller whose interface has been set up counts anew, and no error frame says so. `holds_bus_off` as
/// above.
void BeginsAnew(bool holds_bus_off, BusState& state) noexcept;

}  // namespace contour
