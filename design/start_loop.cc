#include "design/start_loop.h"

#include <algorithm>

#include "config/loop_axis.h"
#include "design/loop_report.h"
#include "drivers/cia402/mode_for.h"

namespace contour {
namespace {

/// Where no loop keeps the limits on all of the doubt, one that is stable there with this peak at most may
/// still begin: commissioning wants certainty, not accuracy.
constexpr double kMostPeakFarOff = 10.0;
constexpr double kMostPeakAsStated = 3.0;
/// A loop that only holds against a force, without taking it up, leaves the axis beside its path by all the
/// friction that a catalogue does not know.
constexpr double kMostLeftAtStart = 0.5;

std::string WhyNotCertain(const LoopVerdict& verdict) {
  LoopVerdict wide = verdict;
  for (std::size_t i = 0; i < kMemberKinds; ++i) {
    const bool stated = static_cast<MemberKind>(i) == MemberKind::kAsStated;
    wide.worst[i].limit = std::max(verdict.worst[i].limit, stated ? kMostPeakAsStated : kMostPeakFarOff);
  }
  return WhatIsWrong(wide);
}

}  // namespace

StartLoop FindStartLoop(const LoopAxis& axis, double period_s, int threads, const CatalogueDoubt& doubt) {
  LoopSearchOptions options;
  options.threads = threads;
  options.members = StartSet(axis, doubt);
  options.most_left = kMostLeftAtStart;
  StartLoop start;
  start.found = SearchLoop(axis, period_s, options);
  start.wrong = WhyNotCertain(start.found.verdict);
  return start;
}

std::string WhyNotToStartWith(const LoopAxis& axis, const LoopTuning& tuning, double period_s,
                              const CatalogueDoubt& doubt) {
  const LoopJudge judge(axis, period_s, StartSet(axis, doubt));
  const bool scale = axis.scale_step_m.has_value();
  return WhyNotCertain(judge.Judge(DesignLoop(axis.axis, tuning, period_s, scale)));
}

std::string WhyLoopsMayNotStart(const MachineConfig& machine) {
  if (!KnowsTwoInertias(machine.machine.controller, machine.control.friction)) return {};
  const double period_s = 1e-6 * machine.machine.cycle_us;
  for (const auto& [name, axis] : machine.axes) {
    if (ModeFor(machine.machine.controller, axis.drive) != DriveMode::kCst || !axis.loop) continue;
    const std::string wrong = WhyNotToStartWith(LoopAxisOf(axis), *axis.loop, period_s, DoubtOf(axis.model));
    if (!wrong.empty())
      return "axes." + name + ".loop: found one that is not stable for all that the model leaves open (" +
             wrong +
             "), expected one to commission with: contour tune --from-model FILE --catalogue --out FILE, "
             "then contourd with that file; where there is none, contourd with drive.mode: csp on all axes, "
             "which is commissioned with no loop to begin with";
  }
  return {};
}

}  // namespace contour
