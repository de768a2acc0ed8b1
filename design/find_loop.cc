#include "design/find_loop.h"

#include <algorithm>

#include "design/creep.h"
#include "design/loop_report.h"

namespace contour {
namespace {

/// Refining takes a loop back within limits that it breaks by some tenths; where it breaks one by half, after
/// as many evaluations as a refinement has, there is none.
constexpr double kHopelessExcess = 0.5;

/// What is nearest to its limit has to do with friction.
bool FrictionForbids(const LoopAxis& axis, const LoopVerdict& verdict) {
  const std::vector<LoopMember> set = CreepingSet(axis);
  return std::any_of(set.begin(), set.end(), [&](const LoopMember& m) {
    return m.name == Binding(verdict).name &&
           (m.kind == MemberKind::kHeld || m.kind == MemberKind::kCreeping);
  });
}

}  // namespace

FoundLoop FindLoop(const LoopAxis& axis, double period_s, const LoopSearchOptions& options) {
  LoopSearchOptions strict = options;
  strict.hopeless_excess = kHopelessExcess;
  FoundLoop found = SearchLoop(axis, period_s, strict);
  if (WhatIsWrong(found.verdict).empty() || !FrictionForbids(axis, found.verdict)) return found;
  LoopSearchOptions creeping = strict;
  creeping.members = CreepingSet(axis);
  creeping.most_left = kMostLeftCreeping;
  FoundLoop other = SearchLoop(axis, period_s, creeping);
  found.evaluations += other.evaluations;
  if (!WhatIsWrong(ReportOn(axis, other.tuning, period_s)).empty()) return found;
  other.evaluations = found.evaluations;
  return other;
}

}  // namespace contour
