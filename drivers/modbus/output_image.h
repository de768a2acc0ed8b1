#pragma once

#include <cstdint>
#include <map>

namespace contour {

/// What outputs shall be, by their addresses.
struct OutputImage {
  struct Register {
    std::uint16_t value = 0;
    bool stays = false;  ///< also when all is switched off
    bool operator==(const Register&) const = default;
  };
  std::map<int, bool> coils;
  std::map<int, Register> registers;
  bool operator==(const OutputImage&) const = default;

  /// The same outputs, off.
  [[nodiscard]] OutputImage Off() const {
    OutputImage off = *this;
    for (auto& [address, on] : off.coils) on = false;
    for (auto& [address, reg] : off.registers)
      if (!reg.stays) reg.value = 0;
    return off;
  }
};

}  // namespace contour
