#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/validation/hidden/hidden_case.h"

namespace contour::hidden {

/// One machine to record, and what is to be hidden in it.
struct Question {
  enum class Type { kClean, kEffect, kPair, kDetectable };
  Type type = Type::kEffect;
  std::vector<std::string> kinds;  ///< none, one or two
  Strength strength = Strength::kClear;
  std::uint64_t seed = 1;
  Misfit misfit = Misfit::kNone;
  Length length = Length::kLong;
};
const char* Name(Question::Type type);

/// The kinds, joined by "+".
std::string KindsText(const Question& question);

/// Name of the directory that the case is recorded in: "clean_0001", "clear_cogging_0004",
/// "maxwell_slip_moderate_stribeck_0002", "pair_cogging+backlash_0003".
std::string CaseName(const Question& question);

/// What to record.
struct Plan {
  std::vector<std::string> kinds;
  std::vector<Strength> strengths = {Strength::kClear, Strength::kModerate, Strength::kBarely};
  std::vector<Misfit> misfits = {Misfit::kNone};
  int seeds = 4, clean = 0, pairs = 0, detectable = 0;
  std::uint64_t first_seed = 1;
  Length length = Length::kLong;
};

/// Round by round, so that a run that is broken off has seen something of everything.
std::vector<Question> Questions(const Plan& plan);

}  // namespace contour::hidden
