#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace contour {

enum class FindingLevel {
  kGood,     ///< as real time wants it
  kAdvice,   ///< goes without, better with
  kChange,   ///< real time will suffer, or be refused
  kUnknown,  ///< this computer does not tell
};
std::string_view Name(FindingLevel level);

/// One thing examined on a computer.
struct Finding {
  std::string what;  ///< short name, for programs: "kernel", "throttling", ...
  FindingLevel level = FindingLevel::kUnknown;
  std::string found;   ///< what it is now, a sentence
  std::string change;  ///< what to do, as one would type it; empty when there is nothing to do
};

struct ExaminationRequest {
  std::filesystem::path root = "/";  ///< where /proc, /sys and /boot are looked for
  int cpu = -1;                      ///< of the cycle's thread; -1: not bound
  int priority = 80;
  std::vector<std::string> interfaces;  ///< CAN interfaces; empty: all there are
};

/// Looks at everything that decides whether a computer can run a cycle in time. Changes nothing.
std::vector<Finding> Examine(const ExaminationRequest& request);

}  // namespace contour
