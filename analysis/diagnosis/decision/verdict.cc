#include "analysis/diagnosis/decision/verdict.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/decision/hypothesis.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"

namespace contour::diagnosis {
namespace {

std::string StructureText(const Problem& problem, const RemainingStructure& left) {
  const bool linear = problem.log.linear;
  std::array<char, 200> size{};
  std::snprintf(size.data(), size.size(), "chi^2 falls by %.0f where %.0f is chance; most at %s: %+.3g %s",
                left.drop, left.bins, left.at.c_str(), linear ? left.amount : 1e3 * left.amount,
                linear ? "N" : "mN m");
  return "What is left depends on " + left.over + " (" + size.data() +
         "). To see more of it: " + ExperimentOn(problem, left.quantity);
}

std::string NearestText(const std::vector<Cause>& causes) {
  std::string text = "Of the known causes these come nearest, are part of it, and leave too much: ";
  for (const Cause& c : causes) text += (&c == causes.data() ? "" : ", ") + c.kind;
  return text + ".";
}

/// Whether the unseen part of the log says plainly that the model is worse with it. A factor on all forces
/// moves nothing that it could harm.
bool DoesHarm(const Cause& c) { return c.heldout_gain_high < 0.0 && !CauseNamed(c.kind).common_factor; }

/// Of those that do; empty where none does.
std::string HarmfulText(const std::vector<Cause>& causes) {
  std::string kinds;
  for (const Cause& c : causes)
    if (!Outside(c.kind) && DoesHarm(c)) kinds += (kinds.empty() ? "" : ", ") + c.kind;
  return kinds.empty() ? kinds
                       : "Part of what is missing looks like " + kinds +
                             ", but parts of the log that its fit has not seen are worse with it.";
}

/// Those that ended at a bound of what is allowed are told in a note, and go.
void TakeOutNoSize(Diagnosis& out) {
  std::string kinds;
  for (const Cause& c : out.causes) {
    if (!c.no_size) continue;
    kinds += (kinds.empty() ? "" : ", ") + c.kind;
    for (Candidate& candidate : out.candidates)
      if (candidate.kind == c.kind) candidate.accepted = false;
  }
  if (kinds.empty()) return;
  std::erase_if(out.causes, [](const Cause& c) { return c.no_size; });
  out.notes.push_back("Part of what is missing looks like " + kinds +
                      ", but ends at the bound of what such a cause may be, and the log says nothing of its "
                      "size: no name is given to it.");
}

}  // namespace

void Conclude(const Problem& problem, const std::vector<RemainingStructure>& left, Diagnosis& out) {
  const bool something = left[0].score > left[0].asked;
  double beyond = 0.0, named = 0.0;
  for (const RemainingStructure& one : left)
    if (one.score > one.asked && !(one.series && !out.causes.empty()))
      beyond = std::max(beyond, one.drop - one.bins);
  // A shape that was fitted, but is none of the catalogue, is no explanation either.
  // Nor is what has no size.
  for (const Cause& c : out.causes)
    (Outside(c.kind) || c.no_size ? beyond : named) += 2.0 * c.log_evidence_gain;
  const bool scale = !out.causes.empty() && CauseNamed(out.causes[0].kind).judged_at_scale;
  const bool unexplained =
      beyond > (scale ? kHypotheses.may_matter_share : kScreening.little_share) * (named + beyond);
  for (const Cause& c : out.causes)
    if (Outside(c.kind))
      out.notes.push_back("Something is missing that none of the known causes fits; nearest: " +
                          c.kind.substr(kOutside.size()) + ".");
  TakeOutNoSize(out);
  const std::string harmful = HarmfulText(out.causes);
  std::erase_if(out.causes, [](const Cause& c) { return Outside(c.kind) || DoesHarm(c); });
  // What explained far more than chance was something, if not that.
  const bool refused = out.causes.empty() && !harmful.empty();
  if (refused) out.notes.push_back(harmful);
  // What is told as found was excited.
  std::erase_if(out.not_excited, [&](const std::string& kind) {
    return std::any_of(out.causes.begin(), out.causes.end(), [&](const Cause& c) { return c.kind == kind; });
  });
  if (something) out.notes.push_back(StructureText(problem, left[0]));
  if (unexplained || refused) {
    if (!out.causes.empty()) out.notes.push_back(NearestText(out.causes));
    out.verdict = Verdict::kUnexplained;
    for (Cause& c : out.causes) c.part_of_it = true;
    for (Candidate& c : out.candidates) c.accepted = false;
  } else if (out.causes.empty()) {
    out.verdict = Verdict::kNothingFound;
  } else {
    out.verdict = out.causes[0].indistinguishable_from.empty() ? Verdict::kCauseFound : Verdict::kAmbiguous;
  }
}

}  // namespace contour::diagnosis
