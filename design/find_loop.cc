#include "design/find_loop.h"

#include <algorithm>

#include "design/creep.h"

namespace contour {
namespace {

/// Refining takes a loop back within limits that it breaks by some tenths; where it breaks one by half, after
/// as many evaluations as a refinement has, there is none.
constexpr double kHopelessExcess = 0.5;

/// Of what friction does to the axis, held by its bristles or on the falling slope, something breaks its
/// limit, be it what is farthest beyond or not.
bool FrictionForbids(const LoopAxis& axis, const LoopTuning& tuning, double period_s) {
  std::vector<LoopMember> set = UncertaintySet(axis);
  // The first is the axis as stated, which a judge goes by.
  set.erase(std::remove_if(set.begin() + 1, set.end(), [](const LoopMember& m) { return !HasBristle(m); }),
            set.end());
  const bool scale = axis.scale_step_m.has_value();
  return !Acceptable(LoopJudge(axis, period_s, set).Judge(DesignLoop(axis.axis, tuning, period_s, scale)));
}

/// A loop that keeps the limits, and does not bring its table to rest.
bool Hunts(const LoopAxis& axis, const FoundLoop& found, double period_s) {
  if (!WhatIsWrong(found.verdict).empty() || TakesUp(found.verdict.step)) return false;
  return !WhatIsWrong(ReportOn(axis, found.tuning, period_s)).empty();
}

}  // namespace

FoundLoop FindLoop(const LoopAxis& axis, double period_s, const LoopSearchOptions& options) {
  LoopSearchOptions strict = options;
  strict.hopeless_excess = kHopelessExcess;
  FoundLoop found = SearchLoop(axis, period_s, strict);
  bool hunts = Hunts(axis, found, period_s);
  if (hunts) {
    // Of all loops within the limits the one that errs least over 200 ms only holds against a force.
    strict.most_left = kMostLeft;
    FoundLoop other = SearchLoop(axis, period_s, strict);
    other.evaluations += found.evaluations;
    if (!WhatIsWrong(other.verdict).empty() || Hunts(axis, other, period_s)) {
      found.evaluations = other.evaluations;
    } else {
      found = other;
      hunts = false;
    }
  }
  if (!hunts && (WhatIsWrong(found.verdict).empty() || !FrictionForbids(axis, found.tuning, period_s)))
    return found;
  LoopSearchOptions creeping = strict;
  creeping.members = CreepingSet(axis);
  creeping.most_left = kMostLeft;
  FoundLoop other = SearchLoop(axis, period_s, creeping);
  found.evaluations += other.evaluations;
  const LoopReport report = ReportOn(axis, other.tuning, period_s);
  // Of a loop that does not even keep what is left of the limits the report has the strict verdict.
  found.wrong_creeping = report.stick_slip ? WhatIsWrong(report) : WhatIsWrong(other.verdict);
  if (!WhatIsWrong(report).empty()) return found;
  other.evaluations = found.evaluations;
  return other;
}

std::string WhyRefused(const FoundLoop& found, const LoopReport& report) {
  std::string why = WhatIsWrong(report);
  if (!why.empty() && !found.wrong_creeping.empty())
    why += "; and of those whose table may stick and slip where it creeps, " + found.wrong_creeping;
  return why;
}

}  // namespace contour
