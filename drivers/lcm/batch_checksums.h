#pragma once

#include <contour_lcm/cycle_batch.hpp>
#include <cstddef>
#include <string>
#include <string_view>

namespace contour {

/// Encodes a batch with the checksums of its entries and of the whole.
std::string EncodeBatch(contour_lcm::cycle_batch& batch);

/// Where an encoded batch whose checksum is wrong was damaged: the number of the first entry whose own bytes
/// do not agree with what the batch says of them; 0 when that cannot be told.
std::size_t FirstDamagedEntry(std::string_view bytes);

}  // namespace contour
