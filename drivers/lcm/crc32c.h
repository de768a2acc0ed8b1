#pragma once

#include <cstdint>
#include <string_view>

namespace contour {

/// CRC-32C (Castagnoli, reflected polynomial 0x82F63B78): 0xE3069283 for "123456789". `before` is the
/// checksum of what came before, for data that come in parts.
std::uint32_t Crc32c(std::string_view bytes, std::uint32_t before = 0) noexcept;

}  // namespace contour
