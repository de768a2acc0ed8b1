#include "tools/improve/experiments.h"

#include <algorithm>

#include "analysis/text/format_text.h"
#include "config/config_error.h"

namespace contour::improve {
namespace {

using diagnosis::Cause;
using diagnosis::Diagnosis;
using diagnosis::Verdict;

/// A cause with less of all the evidence does not decide what a path looks like: evidence goes with the
/// square of a force, so that it is less than a third of what was missing.
constexpr double kMatters = 0.1;

bool Matters(const Cause& cause, const Diagnosis& found) {
  double all = 0.0;
  for (const Cause& c : found.causes) all += std::max(c.log_evidence_gain, 0.0);
  return cause.log_evidence_gain >= kMatters * all;
}

bool Has(const std::vector<ProgramText>& programs, const std::string& text) {
  return std::any_of(programs.begin(), programs.end(), [&](const ProgramText& p) { return p.text == text; });
}

}  // namespace

std::string WhatIsOpen(const Diagnosis& found) {
  switch (found.verdict) {
    case Verdict::kInsufficientData:
      return "the record is too short";
    case Verdict::kNothingFound:
      return "nothing was found on this path";
    case Verdict::kUnexplained:
      return "something is there that no known cause explains";
    case Verdict::kAmbiguous:
    case Verdict::kCauseFound:
      break;
  }
  for (const Cause& c : found.causes) {
    if (!Matters(c, found)) continue;
    if (!c.indistinguishable_from.empty()) return c.kind + " may be another cause";
    if (!(c.heldout_gain_low > 0.0)) return c.kind + " gains nothing for certain on unseen data";
  }
  return "";
}

std::vector<ProgramText> DecidingPrograms(const Diagnosis& found, const std::vector<ProgramText>& done) {
  std::vector<ProgramText> out;
  for (const Cause& c : found.causes) {
    if (c.indistinguishable_from.empty() || !Matters(c, found)) continue;
    if (c.deciding_program.empty() || Has(done, c.deciding_program) || Has(out, c.deciding_program)) continue;
    out.push_back({"what decides on " + c.kind, c.deciding_program, ProgramFormat::kYaml});
  }
  return out;
}

std::vector<ProgramText> NotYetRun(const std::vector<ProgramText>& programs,
                                   const std::vector<ProgramText>& done) {
  std::vector<ProgramText> out;
  for (const ProgramText& p : programs)
    if (!Has(done, p.text)) out.push_back(p);
  return out;
}

std::vector<Placed> Runnable(const std::vector<ProgramText>& programs, const WorkingSpace& space,
                             const PerAxis<PlanLimits>& limits, const PerAxis<double>& middle_m,
                             double time_s, std::vector<std::string>& left_out) {
  std::vector<Placed> out;
  for (const ProgramText& program : programs) {
    try {
      Placed placed = Place(program, space, limits, middle_m);
      if (placed.duration_s > time_s) {
        left_out.push_back(FormatText("%s: takes %.0f s, and %.0f s are left", program.name.c_str(),
                                      placed.duration_s, time_s));
        continue;
      }
      time_s -= placed.duration_s;
      out.push_back(std::move(placed));
    } catch (const ConfigError& e) {
      left_out.emplace_back(e.what());
    }
  }
  return out;
}

}  // namespace contour::improve
