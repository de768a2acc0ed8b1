#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/telemetry/log_format.h"

namespace contour {

/// A further file that the configuration names, such as a model.
struct LogFile {
  std::string name;  ///< as the configuration writes it
  std::string text;

  friend bool operator==(const LogFile&, const LogFile&) = default;
};

/// What a log says about the run as a whole; enough to build the same cycle again.
struct LogHeader {
  std::string build;  ///< program, version, revision, compiler
  std::string machine;
  std::string controller;
  std::string clock;  ///< "wall", "lockstep" or "virtual"
  std::int64_t start_unix_us = 0;
  int cycle_us = 0;
  std::vector<std::string> axis_names;
  std::string config_name;             ///< file the configuration came from
  std::string config_text;             ///< the file itself
  std::vector<std::string> overrides;  ///< KEY=VALUE, in order
  std::vector<LogFile> files;
  std::int32_t format_version = kLogFormatVersion;

  friend bool operator==(const LogHeader&, const LogHeader&) = default;
};

/// State of the cycle between two cycles: where a log begins that does not begin at the start.
struct LogState {
  std::uint64_t cycle = 0;  ///< the last one that the state has taken in
  std::string build;        ///< only this build can read it
  std::string bytes;        ///< as Cycle::SaveState writes them
};

/// Something worth knowing that is no input of a cycle, such as the text of an uploaded program.
struct LogNote {
  std::int64_t cycles_before = 0;  ///< how many cycles the log held when it was written
  std::string key;
  std::string text;

  friend bool operator==(const LogNote&, const LogNote&) = default;
};

}  // namespace contour
