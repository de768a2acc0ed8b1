#pragma once

#include <cstdint>
#include <string_view>

namespace contour {

/// CRC-32C (Castagnoli, reflected polynomial 0x82F63B78): 0xE3069283 for "123456789".
std::uint32_t Crc32c(std::string_view bytes) noexcept;

}  // namespace contour
