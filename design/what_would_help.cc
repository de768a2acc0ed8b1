#include "design/what_would_help.h"

#include <array>
#include <cmath>
#include <optional>

#include "config/number_text.h"
#include "design/find_loop.h"
#include "design/loop_report.h"

namespace contour {
namespace {

// As fine as scales of machine tools are, where the axis has none to go by.
constexpr double kScaleStep_m = 1e-7;
// The stiffest first: where a short search finds nothing there, it hardly does between.
constexpr std::array<double, 3> kStiffer{8.0, 4.0, 2.0};
constexpr LoopSearchOptions kShortSearch{.random_starts = 30,
                                         .runs = 3,
                                         .evaluations_per_run = 300,
                                         .refinements = 1,
                                         .evaluations_per_refinement = 300,
                                         .threads = 1,
                                         .start = {},
                                         .members = {}};

enum class Works { kNot, kCreeping, kWell };

/// Behind what helps so far.
const char* Word(Works works) {
  return works == Works::kCreeping ? ", with which its table still sticks and slips where it creeps" : "";
}

}  // namespace

std::vector<std::string> WhatWouldHelp(const LoopAxis& axis, double period_s, int threads, bool searched) {
  LoopSearchOptions options = kShortSearch;
  options.threads = threads;
  const auto tried = [&](const LoopAxis& other) {
    const FoundLoop found = FindLoop(other, period_s, options);
    if (!found.wrong_creeping.empty() || !WhatIsWrong(found.verdict).empty()) return Works::kNot;
    // A loop that keeps the limits may still hunt.
    if (!WhatIsWrong(ReportOn(other, found.tuning, period_s)).empty()) return Works::kNot;
    const bool creeps = !found.verdict.worst[static_cast<std::size_t>(MemberKind::kCreeping)].name.empty();
    return creeps ? Works::kCreeping : Works::kWell;
  };
  if (!searched)
    if (const Works works = tried(axis); works != Works::kNot)
      return {std::string("another tuning: contour tune --from-model finds one") + Word(works)};
  std::vector<std::string> help{kDriveCloses};
  if (!axis.scale_step_m) {
    LoopAxis with = axis;
    with.scale_step_m = kScaleStep_m;
    if (const Works works = tried(with); works != Works::kNot)
      help.push_back(std::string("a linear scale at the table, in the loop") + Word(works));
  }
  std::string stiffer;
  for (const double factor : kStiffer) {
    LoopAxis stiff = axis;
    stiff.axis.stiffness_N_m *= factor;
    stiff.axis.damping_Ns_m *= std::sqrt(factor);
    const Works works = tried(stiff);
    if (works == Works::kNot) break;
    stiffer = "a screw of " + RoundedText(1e-6 * stiff.axis.stiffness_N_m) + " N/um instead of " +
              RoundedText(1e-6 * axis.axis.stiffness_N_m) + Word(works);
  }
  if (!stiffer.empty()) help.push_back(stiffer);
  return help;
}

}  // namespace contour
