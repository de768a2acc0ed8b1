#include "tools/validation/hidden/question.h"

#include <cstdio>
#include <utility>

namespace contour::hidden {

const char* Name(Question::Type type) {
  switch (type) {
    case Question::Type::kClean:
      return "clean";
    case Question::Type::kEffect:
      return "effect";
    case Question::Type::kPair:
      return "pair";
    case Question::Type::kDetectable:
      break;
  }
  return "detectable";
}

std::string KindsText(const Question& q) {
  std::string text;
  for (const std::string& kind : q.kinds) text += (text.empty() ? "" : "+") + kind;
  return text;
}

std::string CaseName(const Question& q) {
  std::string name = q.misfit == Misfit::kNone ? "" : std::string(Name(q.misfit)) + "_";
  name += q.type == Question::Type::kEffect ? Name(q.strength) : Name(q.type);
  if (!q.kinds.empty()) name += "_" + KindsText(q);
  char number[32];
  std::snprintf(number, sizeof number, "_%04llu", static_cast<unsigned long long>(q.seed));
  return name + (q.length == Length::kShort ? "_short" : "") + number;
}

std::vector<Question> Questions(const Plan& plan) {
  std::vector<Question> questions;
  const auto add = [&](Question::Type type, std::vector<std::string> kinds, Strength strength, Misfit misfit,
                       int index) {
    questions.push_back({type, std::move(kinds), strength,
                         plan.first_seed + static_cast<std::uint64_t>(index), misfit, plan.length});
  };
  for (const Misfit misfit : plan.misfits) {
    for (int i = 0; i < plan.clean; ++i) add(Question::Type::kClean, {}, Strength::kClear, misfit, i);
    for (int i = 0; i < plan.seeds; ++i)
      for (const std::string& kind : plan.kinds)
        for (const Strength s : plan.strengths) add(Question::Type::kEffect, {kind}, s, misfit, i);
    for (int i = 0; i < plan.detectable; ++i)
      for (const std::string& kind : plan.kinds)
        add(Question::Type::kDetectable, {kind}, Strength::kClear, misfit, i);
  }
  for (int i = 0; i < plan.pairs; ++i) {
    const auto n = static_cast<int>(plan.kinds.size());
    const std::string& a = plan.kinds[static_cast<std::size_t>((7 * i + 3) % n)];
    const std::string& b = plan.kinds[static_cast<std::size_t>((11 * i + 9) % n)];
    if (a != b) add(Question::Type::kPair, {a, b}, Strength::kClear, Misfit::kNone, i);
  }
  return questions;
}

}  // namespace contour::hidden
