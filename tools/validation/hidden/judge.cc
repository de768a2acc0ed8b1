#include "tools/validation/hidden/judge.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "analysis/diagnosis/causes/catalogue.h"

namespace contour::hidden {
namespace {

using diagnosis::Cause;
using diagnosis::CauseNamed;
using diagnosis::Diagnosis;
using diagnosis::Verdict;

/// Members of an ambiguity set that still counts as an answer.
constexpr std::size_t kLargestSet = 2;

std::string AnswerText(const Diagnosis& d) {
  std::string text;
  for (const Cause& cause : d.causes) {
    if (cause.part_of_it) continue;
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

void CheckIntervals(const Cause& cause, const Hidden& hidden, Judged& judged) {
  judged.inside = true;
  for (const auto& [name, truth] : hidden.truth) {
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

std::vector<ToldSize> SizesOf(const Diagnosis& answer, const Hidden& hidden) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<ToldSize> sizes;
  for (const auto& [name, truth] : hidden.truth) {
    ToldSize size{name, truth, {kNone, kNone, kNone}, kNone};
    for (const Cause& cause : answer.causes) {
      if (cause.part_of_it) continue;
      const auto told = cause.parameters.find(name);
      if (cause.kind == hidden.kind && told != cause.parameters.end()) size.told = told->second;
    }
    const auto smallest = answer.smallest_detectable.find(hidden.kind);
    if (smallest != answer.smallest_detectable.end() && smallest->second.count(name) > 0)
      size.smallest = smallest->second.at(name);
    sizes.push_back(size);
  }
  return sizes;
}

bool Holds(const Cause& cause, const std::string& kind) {
  const std::set<std::string> set = SetOf(cause);
  return set.size() <= kLargestSet && set.count(kind) > 0;
}

/// Does the cause say no more than how the plant differs? Not when that kind was hidden besides.
bool NamesMisfit(const Cause& cause, const std::vector<Hidden>& hidden, Misfit misfit) {
  for (const Hidden& h : hidden)
    if (h.kind == cause.kind) return false;
  switch (misfit) {
    case Misfit::kTimingError:
    case Misfit::kDelayAndLag:
      return CauseNamed(cause.kind).about_timing;
    case Misfit::kMaxwellSlip:
      return CauseNamed(cause.kind).takes_up_mismatch;
    case Misfit::kNone:
    case Misfit::kNoiseLevel:
      break;
  }
  return false;
}

}  // namespace

bool OutsideCatalogue(const std::string& kind) { return diagnosis::FindCause(kind) == nullptr; }

std::set<std::string> SetOf(const Cause& cause) {
  std::set<std::string> set(cause.indistinguishable_from.begin(), cause.indistinguishable_from.end());
  set.insert(cause.kind);
  return set;
}

Judged Judge(const Diagnosis& answer, const std::vector<Hidden>& hidden, Misfit misfit) {
  Judged judged;
  judged.answer = AnswerText(answer);
  std::vector<Cause> causes;
  for (const Cause& cause : answer.causes)
    if (!cause.part_of_it && !NamesMisfit(cause, hidden, misfit)) causes.push_back(cause);
  judged.extra = std::max(0, static_cast<int>(causes.size()) - static_cast<int>(hidden.size()));
  if (hidden.empty()) {
    // On a plant that no model describes, what names how it differs; of a law of friction nobody has a name.
    const bool mismatch_named = std::any_of(answer.causes.begin(), answer.causes.end(),
                                            [](const Cause& cause) { return !cause.part_of_it; });
    const bool law_told = misfit == Misfit::kMaxwellSlip && answer.verdict == Verdict::kUnexplained;
    judged.right = causes.empty() && (answer.verdict == Verdict::kNothingFound || mismatch_named || law_told);
    return judged;
  }
  if (OutsideCatalogue(hidden.front().kind)) {
    judged.right = causes.empty() && answer.verdict == Verdict::kUnexplained;
    return judged;
  }
  if (!causes.empty()) judged.right = Holds(causes.front(), hidden.front().kind);
  judged.sizes = SizesOf(answer, hidden.front());
  judged.both = hidden.size() == 2 && std::all_of(hidden.begin(), hidden.end(), [&](const Hidden& h) {
                  return std::any_of(causes.begin(), causes.end(),
                                     [&](const Cause& cause) { return Holds(cause, h.kind); });
                });
  for (const Cause& cause : causes) {
    if (cause.kind != hidden.front().kind) continue;
    judged.itself = true;
    judged.gain = cause.heldout_gain;
    judged.evidence = cause.log_evidence_gain;
    CheckIntervals(cause, hidden.front(), judged);
    break;
  }
  return judged;
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
