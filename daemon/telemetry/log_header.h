#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace contour {

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

  friend bool operator==(const LogHeader&, const LogHeader&) = default;
};

/// Something worth knowing that is no input of a cycle, such as the text of an uploaded program.
struct LogNote {
  std::int64_t cycles_before = 0;  ///< how many cycles the log held when it was written
  std::string key;
  std::string text;

  friend bool operator==(const LogNote&, const LogNote&) = default;
};

}  // namespace contour
