#include "daemon/telemetry/event_file.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "daemon/telemetry/log_format.h"
#include "drivers/lcm/crc32c.h"

namespace contour {
namespace {

/// Sync word, event number, time, length of the channel's name, length of the data.
constexpr std::size_t kHeaderBytes = 28;
constexpr std::int64_t kLongestChannel = 255;

std::int64_t BigEndian(std::string_view bytes, std::size_t at, std::size_t length) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < length; ++i) value = (value << 8) | static_cast<unsigned char>(bytes[at + i]);
  return length == 4 ? static_cast<std::int32_t>(value) : static_cast<std::int64_t>(value);
}

}  // namespace

EventFile::EventFile(const std::string& file) {
  errno = 0;
  in_.open(file, std::ios::binary | std::ios::ate);
  if (!in_) throw std::runtime_error(std::string("cannot be read: ") + std::strerror(errno));
  size_ = in_.tellg();
  in_.seekg(0);
}

EventFile::Result EventFile::Next(LogEvent& event) {
  checksum_before_ = checksum_;
  if (at_ >= size_) return Result::kEnd;
  std::string header(kHeaderBytes, '\0');
  if (!in_.read(header.data(), kHeaderBytes)) return Result::kCutShort;
  const std::int64_t channel = BigEndian(header, 20, 4);
  const std::int64_t data = BigEndian(header, 24, 4);
  const bool plausible = BigEndian(header, 0, 4) == static_cast<std::int32_t>(kLcmEventSync) &&
                         BigEndian(header, 4, 8) == number_ && channel >= 0 && channel <= kLongestChannel &&
                         data >= 0;
  const auto begin = at_ + static_cast<std::int64_t>(kHeaderBytes);
  if (!plausible || begin + channel + data > size_)
    return MoreBehind(begin) || !plausible ? Result::kDamaged : Result::kCutShort;
  event.unix_us = BigEndian(header, 12, 8);
  event.channel.resize(static_cast<std::size_t>(channel));
  event.bytes.resize(static_cast<std::size_t>(data));
  in_.read(event.channel.data(), channel);
  in_.read(event.bytes.data(), data);
  if (!in_) return Result::kCutShort;
  at_ = begin + channel + data;
  ++number_;
  checksum_ = Crc32c(event.bytes, Crc32c(event.channel, Crc32c(header, checksum_)));
  return Result::kEvent;
}

bool EventFile::MoreBehind(std::int64_t from) {
  static constexpr std::array<char, 4> kSync{'\xED', '\xA1', '\xDA', '\x01'};
  in_.clear();
  in_.seekg(from);
  std::string rest(static_cast<std::size_t>(size_ - from), '\0');
  in_.read(rest.data(), static_cast<std::streamsize>(rest.size()));
  if (rest.starts_with(kFooterChannel)) return true;  // the end is there, and not as long as it says
  return rest.find(std::string_view(kSync.data(), kSync.size())) != std::string::npos;
}

}  // namespace contour
