#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/visit.h"

namespace contour {

enum class LogLevel : std::uint8_t { kDebug, kInfo, kWarning, kError };

constexpr std::string_view Name(LogLevel l) noexcept {
  switch (l) {
    case LogLevel::kDebug:
      return "debug";
    case LogLevel::kInfo:
      return "info";
    case LogLevel::kWarning:
      return "warning";
    case LogLevel::kError:
      return "error";
  }
  return "unknown";
}
constexpr std::string_view Choices(LogLevel) noexcept { return "debug, info, warning or error"; }
constexpr bool FromName(std::string_view name, LogLevel& out) noexcept {
  for (const LogLevel l : {LogLevel::kDebug, LogLevel::kInfo, LogLevel::kWarning, LogLevel::kError}) {
    if (Name(l) != name) continue;
    out = l;
    return true;
  }
  return false;
}

/// `logging:` of a machine file: text messages for people. What the cycle records is another matter
/// (`--log`).
struct LoggingConfig {
  LogLevel level = LogLevel::kInfo;
  std::string file;
  bool journal = true;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("level", level, "least important messages that are written");
    v.Optional("file", file, "file that messages are appended to; empty: none");
    v.Optional("journal", journal, "write messages to standard error, which systemd puts into the journal");
  }
};

}  // namespace contour
