#include "design/loop_choice.h"

#include <array>
#include <cstdio>
#include <stdexcept>

#include "config/config_error.h"
#include "config/friction_choice.h"
#include "design/creep.h"
#include "design/loop_report.h"
#include "design/loop_search.h"
#include "design/what_would_help.h"
#include "drivers/cia402/mode_for.h"

namespace contour {
namespace {

// Of regulator and observer: slower ones bear more.
constexpr std::array<double, 5> kSofter{1.0, 0.85, 0.7, 0.5, 0.35};

// Evaluations of a search that begins there: some tenths of a second.
constexpr int kPolish = 80;

/// With three digits, as it stands in a file; the loop is judged as it is written.
class Writer {
 public:
  template <class... T>
  void Required(std::string_view key, double& value, T...) {
    Put(key, value);
  }
  template <class... T>
  void Optional(std::string_view key, double& value, T...) {
    Put(key, value);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void Put(std::string_view key, double& value) {
    char number[32];
    std::snprintf(number, sizeof number, "%.3g", value);
    value = std::stod(number);
    text_ += (text_.empty() ? "" : ", ") + std::string(key) + ": " + number;
  }
  std::string text_;
};

}  // namespace

std::optional<LoopTuning> ChooseLoop(const LoopAxis& axis, double period_s) {
  const bool scale = axis.scale_step_m.has_value();
  const LoopJudge judge(axis, period_s);
  // The second kind only holds against a force, as long as a step is looked at.
  std::optional<LoopTuning> best, holding;
  double least_m = 0.0, holding_m = 0.0;
  for (LoopTuning known : LoopsOfOtherAxes(period_s)) {
    for (const double softer : kSofter) {
      LoopTuning tuning = known;
      tuning.regulator_Hz *= softer;
      tuning.disturbance_Hz *= softer;
      Writer rounding;
      tuning.Visit(rounding);
      try {
        const LoopVerdict verdict = judge.Judge(DesignLoop(axis.axis, tuning, period_s, scale));
        if (!Acceptable(verdict)) continue;
        const double error_m = StepError_m(verdict);
        if (!TakesUp(verdict.step)) {
          if (!holding || error_m < holding_m) {
            holding = tuning;
            holding_m = error_m;
          }
          continue;
        }
        if (!best || error_m < least_m) {
          best = tuning;
          least_m = error_m;
        }
        break;  // softer forms of it only answer a force more slowly
      } catch (const std::invalid_argument&) {
        continue;
      }
    }
  }
  LoopSearchOptions brief;
  brief.random_starts = 0;
  brief.runs = brief.refinements = 1;
  brief.evaluations_per_run = brief.evaluations_per_refinement = kPolish;
  brief.start = best;
  FoundLoop found = SearchLoop(axis, period_s, brief);
  if (!TakesUp(found.verdict.step)) {
    brief.most_left = kMostLeft;
    found = SearchLoop(axis, period_s, brief);
  }
  Writer rounding;
  found.tuning.Visit(rounding);
  found.verdict = judge.Judge(DesignLoop(axis.axis, found.tuning, period_s, scale));
  if (Acceptable(found.verdict) && TakesUp(found.verdict.step) &&
      (!best || StepError_m(found.verdict) < least_m))
    best = found.tuning;
  // A slow axis that comes to rest all the same has that one.
  if (!best && holding && WhatIsWrong(ReportOn(axis, *holding, period_s)).empty()) return holding;
  return best;
}

std::string WhyNoLoop(const std::string& name, const std::vector<std::string>& help) {
  std::string text = "axes." + name +
                     ".loop: missing, and none of the loops that are tried without one keeps its limits; "
                     "expected what `contour tune --from-model` writes after a search; what would help:";
  for (const std::string& one : help) text += " " + one + ";";
  text.pop_back();
  return text;
}

std::string LoopAssignment(const std::string& name, LoopTuning tuning, const std::string& key) {
  Writer writer;
  tuning.Visit(writer);
  return "axes." + name + "." + key + "={" + writer.text() + "}";
}

bool MayUseFilter(const MachineConfig& machine) {
  return !machine.control.friction_stated && FilterServes(machine);
}

std::vector<std::string> LoopsThatAreMissing(const MachineConfig& machine, const std::string& file,
                                             const std::function<void()>& begins) {
  std::vector<std::string> assignments, errors;
  if (!KnowsTwoInertias(machine.machine.controller, machine.control.friction)) return assignments;
  const double period_s = 1e-6 * machine.machine.cycle_us;
  for (const auto& [name, config] : machine.axes) {
    if (config.loop || ModeFor(machine.machine.controller, config.drive) != DriveMode::kCst) continue;
    if (begins) begins();
    if (const std::optional<LoopTuning> tuning = ChooseLoop(LoopAxisOf(config), period_s)) {
      assignments.push_back(LoopAssignment(name, *tuning));
    } else if (MayUseFilter(machine)) {
      return {kUseFilter};
    } else {
      errors.push_back(file + ": " + WhyNoLoop(name, {kDriveCloses, kWhoTries}));
    }
  }
  if (errors.empty()) return assignments;
  throw ConfigError(std::move(errors));
}

}  // namespace contour
