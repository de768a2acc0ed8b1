#include "tools/hidden/judge.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/hidden/hide_effect.h"

namespace contour::hidden {
namespace {

using diagnosis::Cause;
using diagnosis::Diagnosis;
using diagnosis::Verdict;

/// Members of an ambiguity set that still counts as an answer.
constexpr std::size_t kLargestSet = 2;

std::string AnswerText(const Diagnosis& d) {
  std::string text;
  for (const Cause& cause : d.causes) {
    std::string one = cause.kind;
    for (const std::string& other : cause.indistinguishable_from) one += "|" + other;
    text += (text.empty() ? "" : " + ") + one;
  }
  if (!text.empty()) return text;
  switch (d.verdict) {
    case Verdict::kNothingFound:
      return "nothing_found";
    case Verdict::kUnexplained:
      return "unexplained";
    case Verdict::kInsufficientData:
      return "insufficient_data";
    case Verdict::kCauseFound:
    case Verdict::kAmbiguous:
      break;
  }
  return "no_cause";
}

void CheckIntervals(const Cause& cause, const Hidden& hidden, const Setting& setting, Judged& judged) {
  judged.inside = true;
  for (const auto& [name, truth] : TruthOf(hidden, setting)) {
    const auto at = cause.parameters.find(name);
    char text[200];
    if (at == cause.parameters.end()) {
      std::snprintf(text, sizeof text, "%s missing; ", name.c_str());
    } else if (truth >= at->second.low && truth <= at->second.high) {
      continue;
    } else {
      std::snprintf(text, sizeof text, "%s %.4g not in %.4g [%.4g, %.4g]; ", name.c_str(), truth,
                    at->second.value, at->second.low, at->second.high);
    }
    judged.inside = false;
    judged.outside += text;
  }
}

}  // namespace

std::set<std::string> SetOf(const Cause& cause) {
  std::set<std::string> set(cause.indistinguishable_from.begin(), cause.indistinguishable_from.end());
  set.insert(cause.kind);
  return set;
}

Judged Judge(const Diagnosis& answer, const std::vector<Hidden>& hidden, const Setting& setting) {
  Judged judged;
  judged.answer = AnswerText(answer);
  if (hidden.empty()) {
    judged.right = answer.verdict == Verdict::kNothingFound;
    judged.extra = static_cast<int>(answer.causes.size());
    return judged;
  }
  if (!answer.causes.empty()) {
    const std::set<std::string> first = SetOf(answer.causes.front());
    judged.right = first.size() <= kLargestSet && first.count(hidden.front().kind) > 0;
  }
  judged.extra = std::max(0, static_cast<int>(answer.causes.size()) - static_cast<int>(hidden.size()));
  for (const Cause& cause : answer.causes) {
    if (cause.kind != hidden.front().kind) continue;
    judged.gain = cause.heldout_gain;
    CheckIntervals(cause, hidden.front(), setting, judged);
    break;
  }
  return judged;
}

bool BothFound(const Diagnosis& answer, const std::vector<Hidden>& hidden) {
  return std::all_of(hidden.begin(), hidden.end(), [&](const Hidden& h) {
    return std::any_of(answer.causes.begin(), answer.causes.end(), [&](const Cause& cause) {
      const std::set<std::string> set = SetOf(cause);
      return set.size() <= kLargestSet && set.count(h.kind) > 0;
    });
  });
}

int LowestCredible(int n, double p, double chance) {
  // Add up the binomial distribution from below.
  double below = 0.0;
  for (int k = 0; k <= n; ++k) {
    const double log_term = std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) +
                            k * std::log(p) + (n - k) * std::log1p(-p);
    below += std::exp(log_term);
    if (below >= chance) return k;
  }
  return n;
}

}  // namespace contour::hidden
