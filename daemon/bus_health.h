#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/can/frame_bus.h"

namespace contour {

/// Tells the operator what the CAN controllers say of their errors: that they count many, that one is
/// bus-off, and that it is over. A controller between two states is told of once in a while only.
class BusHealth {
 public:
  struct Named {
    std::string name;
    std::string interface;
  };
  struct Line {
    bool over = false;  ///< nothing to be done
    std::string text;
  };
  using Time = std::chrono::steady_clock::time_point;

  explicit BusHealth(std::vector<Named> buses);
  /// The state of bus `i` as it is now; what is new of it.
  std::vector<Line> Look(std::size_t i, const BusState& state, Time now);

 private:
  enum class Level : std::uint8_t { kGood, kWarning, kPassive, kBusOff };
  struct Told {
    Level level = Level::kGood;
    std::uint16_t bus_offs = 0;
    Time again{};  ///< no earlier is there another line, bus-off and its end but
  };
  static Level LevelOf(const BusState& state) noexcept;
  [[nodiscard]] static std::string Text(const BusState& state, Level level, const Named& bus);

  std::vector<Named> buses_;
  std::vector<Told> told_;
};

}  // namespace contour
