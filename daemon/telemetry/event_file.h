#pragma once

#include <cstdint>
#include <fstream>
#include <string>

namespace contour {

struct LogEvent {
  std::int64_t unix_us = 0;
  std::string channel;
  std::string bytes;
};

/// The events of an LCM event log in order. Unlike LCM's own reader it does not pass over what is no event,
/// and it knows damage from an end that was cut off.
class EventFile {
 public:
  /// Throws std::runtime_error with the cause when the file cannot be read.
  explicit EventFile(const std::string& file);

  enum class Result {
    kEvent,
    kEnd,       ///< behind the last event
    kCutShort,  ///< the last event is not whole
    kDamaged,   ///< here is no event, and there is more behind it
  };
  Result Next(LogEvent& event);

  /// CRC-32C of all bytes before the event that Next() gave last.
  [[nodiscard]] std::uint32_t checksum_before() const noexcept { return checksum_before_; }

 private:
  [[nodiscard]] bool MoreBehind(std::int64_t from);

  std::ifstream in_;
  std::int64_t size_ = 0;
  std::int64_t at_ = 0;
  std::int64_t number_ = 0;
  std::uint32_t checksum_before_ = 0;
  std::uint32_t checksum_ = 0;
};

}  // namespace contour
