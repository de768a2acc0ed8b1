#include "drivers/lcm/batch_checksums.h"

#include "drivers/lcm/cycle_messages.h"

namespace contour {
namespace {

/// In front of the entries: the type's fingerprint, checksum, batch number, count.
constexpr std::size_t kCountBegin = kChecksumEnd + 8;
constexpr std::size_t kEntriesBegin = kCountBegin + 4;

std::uint32_t ReadU32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = (value << 8) | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

void WriteU32(std::string& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>((value >> (24 - 8 * i)) & 0xFFu);
}

}  // namespace

std::string EncodeBatch(contour_lcm::cycle_batch& batch) {
  const std::size_t count = batch.entries.size();
  batch.count = static_cast<std::int32_t>(count);
  batch.crc32c = 0;
  batch.entry_bytes.resize(count);
  batch.entry_crc32c.assign(count, 0);
  for (std::size_t i = 0; i < count; ++i) batch.entry_bytes[i] = batch.entries[i]._getEncodedSizeNoHash();
  std::string bytes = Encode(batch);
  std::size_t at = kEntriesBegin;
  const std::size_t table = bytes.size() - 4 * count;
  for (std::size_t i = 0; i < count; ++i) {
    const auto length = static_cast<std::size_t>(batch.entry_bytes[i]);
    WriteU32(bytes, table + 4 * i, Crc32c(std::string_view(bytes).substr(at, length)));
    at += length;
  }
  WriteU32(bytes, kChecksumBegin, Crc32c(std::string_view(bytes).substr(kChecksumEnd)));
  return bytes;
}

std::size_t FirstDamagedEntry(std::string_view bytes) {
  if (bytes.size() < kEntriesBegin) return 0;
  const std::size_t count = ReadU32(bytes, kCountBegin);
  if (count > bytes.size() / 8 || kEntriesBegin + 8 * count > bytes.size()) return 0;
  const std::size_t lengths = bytes.size() - 8 * count;
  const std::size_t checksums = bytes.size() - 4 * count;
  std::size_t at = kEntriesBegin;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t length = ReadU32(bytes, lengths + 4 * i);
    if (length > lengths - at) return i;
    if (Crc32c(bytes.substr(at, length)) != ReadU32(bytes, checksums + 4 * i)) return i;
    at += length;
  }
  return 0;
}

}  // namespace contour
