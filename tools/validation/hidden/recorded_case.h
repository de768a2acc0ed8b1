#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/validation/hidden/hidden_case.h"
#include "tools/validation/hidden/question.h"

// A recorded case is a directory: log.lcm (or log.csv) and model.yaml, as a user would have them;
// machine.yaml, which made the log; and truth.json, which nobody reads but the judge.
namespace contour::hidden {

/// What truth.json says.
struct KnownCase {
  Question question;
  std::vector<Hidden> hidden;
  bool usable = false;
  std::string why_not;  ///< no such case: the effect does not get that strong there, or the machine stops
};

/// Draws, hides and records into `directory`, which must exist; `compact`: see Compact(). A case that cannot
/// be had is written too. Throws std::runtime_error when a file cannot be written.
KnownCase RecordCase(const Question& question, const std::filesystem::path& directory, bool compact);

/// Throws std::runtime_error when there is none, or it is not complete.
KnownCase ReadTruth(const std::filesystem::path& directory);

/// Has the case been recorded to its end?
bool IsRecorded(const std::filesystem::path& directory);

}  // namespace contour::hidden
