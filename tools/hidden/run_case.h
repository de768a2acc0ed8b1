#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tools/diagnosis/finding.h"
#include "tools/hidden/hidden_case.h"
#include "tools/hidden/judge.h"

namespace contour::hidden {

/// One question to a diagnoser.
struct Question {
  enum class Type { kClean, kEffect, kPair, kDetectable };
  Type type = Type::kEffect;
  std::vector<std::string> kinds;  ///< none, one or two
  Strength strength = Strength::kClear;
  std::uint64_t seed = 1;
  Misfit misfit = Misfit::kNone;
  double false_alarm_rate = 0.05;
  int bootstrap_runs = 0;
};
const char* Name(Question::Type type);

/// What became of it.
struct Outcome {
  Question question;
  std::vector<Hidden> hidden;
  bool usable = false;  ///< false: the effect cannot be made that strong on this machine, or it cannot be run
  std::string why_not;
  Judged judged;
  bool both = false;        ///< pairs: both were found
  double diagnose_s = 0.0;  ///< processor time of the diagnosis
  double log_s = 0.0;
  diagnosis::Diagnosis answer;  ///< without its traces
};

using Diagnoser = std::function<diagnosis::Diagnosis(const diagnosis::AxisLog&, const diagnosis::StatedAxis&,
                                                     const Question&)>;

/// The product's own.
diagnosis::Diagnosis OurDiagnoser(const diagnosis::AxisLog& log, const diagnosis::StatedAxis& stated,
                                  const Question& question);

/// Draws, hides, records, asks and judges. `directory` takes the files and must exist.
Outcome Ask(const Question& question, const Diagnoser& diagnoser, const std::filesystem::path& directory);

/// The same log for several diagnosers.
struct Exam {
  Question question;
  Setting setting;
  std::vector<Hidden> hidden;
  Recorded recorded;
};
/// Throws std::runtime_error when there is no such case (see Outcome::usable).
Exam MakeExam(const Question& question, const std::filesystem::path& directory);

}  // namespace contour::hidden
