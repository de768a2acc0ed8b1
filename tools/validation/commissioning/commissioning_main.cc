// Commissions emulated machines from catalogue data in virtual time, and says whether the intervals of what
// is written hold the truth. docs/laboratory/commissioning.md has its tables.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "analysis/axis_model/read_stated_axis.h"
#include "analysis/identification/result_files.h"
#include "analysis/identification/usable.h"
#include "tools/validation/commissioning/commissioning_case.h"
#include "tools/validation/commissioning/commissioning_circles.h"

namespace contour {
namespace {

constexpr double kOf95 = 1.96;

/// Of all cases with one effect on one machine, or of one parameter.
struct Tally {
  int cases = 0, written = 0, intervals = 0, holding = 0;
  double worst_rel = 0.0;
};

struct Tallies {
  Tally of_case;
  std::map<std::string, Tally> of_key;
  int circles = 0, better = 0;
};

struct Options {
  std::vector<std::string> machines{"base", "t30", "m100"};
  std::vector<std::string> effects{"none", "cogging3", "cogging6", "wobble", "motor_friction", "side_mode"};
  std::string mode = "cst";
  std::vector<std::string> set;
  unsigned first = 1, seeds = 2;
  int threads = 1;
  bool quiet = false;
  bool circles = false, stay = false;
  std::string scratch = "out/commissionings";
};

void Compare(const EmulatedMachineFile& file, const std::string& axis, const identify::Identification& id,
             bool quiet, Tallies& tallies) {
  const auto truth = Truth(file, axis, id.fit.axis.variation.low_m, id.fit.axis.variation.high_m);
  const auto found = Found(id);
  for (const auto& [key, is] : truth) {
    const auto at = found.find(key);
    if (at == found.end()) {
      if (!quiet) std::printf("  %-22s not identified\n", key.c_str());
      continue;
    }
    const identify::FittedParameter& p = at->second;
    const double z = std::log(p.value / is) / p.sigma;
    const bool holds = std::fabs(z) < kOf95;
    if (!quiet)
      std::printf("  %-22s %12.5g truth %12.5g  error %+6.2f %%  sigma %5.2f %%  z %+5.1f%s\n", key.c_str(),
                  p.value, is, 100.0 * (p.value / is - 1.0), 100.0 * p.sigma, z, holds ? "" : "  <<");
    for (Tally* t : {&tallies.of_case, &tallies.of_key[key]}) {
      t->intervals += 1;
      t->holding += holds ? 1 : 0;
      t->worst_rel = std::max(t->worst_rel, std::fabs(p.value / is - 1.0));
    }
  }
}

std::string Row(const std::string& name, const Tally& t) {
  char text[160];
  std::snprintf(text, sizeof text,
                "%-26s written %3d of %3d, intervals that hold %4d of %4d (%.1f %%), worst %.1f %%\n",
                name.c_str(), t.written, t.cases, t.holding, t.intervals,
                100.0 * t.holding / std::max(1, t.intervals), 100.0 * t.worst_rel);
  return text;
}

/// Commissions one axis; its model goes into `after`.
void RunAxis(const EmulatedMachineFile& file, const CommissioningCase& c, const std::string& axis,
             const Options& options, KnownTorqueLoops& known, EmulatedMachineFile& after, Tallies& tallies) {
  const Recorded as = AsRecorded(file, c, known);
  const EmulatedMachineFile& recorded = as.file;
  if (c.mode == "csp" || as.how != c.mode) std::printf("  recorded in %s\n", as.how.c_str());
  const VirtualCommissioning run = Commission(recorded, axis, "full");
  identify::IdentifyOptions how;
  how.threads = options.threads;
  const identify::Identification id =
      identify::Identify(diagnosis::ToStatedAxis(recorded.machine, axis), {run.log}, how);
  if (!options.quiet)
    std::printf(
        "  axis %s: %.1f s, following error up to %.0f um, %.3f Nm; error of prediction %.3g nm, typical "
        "%.3g "
        "(encoder %.3g), unsettled %.2f; unexplained %.3g N beside noise of %.3g N; on the motor %.3f, "
        "swinging %.3f at %.1f Hz\n",
        axis.c_str(), run.machine_time_s, 1e6 * run.largest_following_error_m, run.largest_torque_Nm,
        1e9 * id.fit.error_rms_m, 1e9 * id.fit.error_typical_m, 1e9 * id.encoder.noise_m, id.fit.unsettled,
        id.unexplained.structure_N, id.unexplained.noise_N, id.fit.axis.motor_friction_share,
        id.fit.axis.side.share, id.fit.axis.side.frequency_Hz);
  for (const std::string& n : id.notes) std::printf("  note: %s\n", n.c_str());
  const std::string why = identify::WhyUnusable(id);
  Tallies shown;  // what is refused is shown, but not counted
  Compare(file, axis, id, options.quiet, why.empty() ? tallies : shown);
  if (!why.empty()) throw std::runtime_error(why);
  after.machine.axes.at(axis).model = identify::ToModel(id, file.machine.axes.at(axis).model);
}

/// Empty when the models would have been written.
std::string RunCase(const CommissioningCase& c, const Options& options, KnownLoops& known,
                    KnownTorqueLoops& for_record, Tallies& tallies) {
  try {
    const EmulatedMachineFile file = MachineOf(c, known);
    EmulatedMachineFile after = file;
    for (const auto& [name, axis] : file.machine.axes)
      if (options.circles || name == c.axis) RunAxis(file, c, name, options, for_record, after, tallies);
    if (!options.circles) return {};
    after = WithFoundLoops(after);
    for (const char* program : {"circle_100um", "circle_10mm"}) {
      const double was_um = Peak_um(file, program, options.scratch);
      const double is_um = Peak_um(after, program, options.scratch);
      std::printf("  %s: %.3f um before, %.3f after\n", program, was_um, is_um);
      tallies.circles += 1;
      // A circle that was not drawn at all before is better now.
      tallies.better += is_um < was_um || (std::isnan(was_um) && std::isfinite(is_um)) ? 1 : 0;
    }
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return {};
}

int Run(const Options& options) {
  std::map<std::string, Tally> of_effect;
  Tallies tallies;
  KnownLoops known;
  KnownTorqueLoops for_record;
  Tally all;
  for (const std::string& machine : options.machines)
    for (unsigned seed = options.first; seed < options.first + options.seeds; ++seed)
      for (const std::string& effect : options.effects) {
        CommissioningCase c{machine, effect, seed};
        c.mode = options.mode;
        c.stay = options.stay;
        c.set = options.set;
        tallies.of_case = {};
        std::printf("%s %s seed %u\n", machine.c_str(), effect.c_str(), seed);
        const std::string refused = RunCase(c, options, known, for_record, tallies);
        Tally& t = tallies.of_case;
        t.cases = 1;
        t.written = refused.empty() ? 1 : 0;
        if (!refused.empty()) std::printf("  not written: %s\n", refused.c_str());
        std::fflush(stdout);
        for (Tally* sum : {&all, &of_effect[machine + " " + effect]}) {
          sum->cases += t.cases;
          sum->written += t.written;
          sum->intervals += t.intervals;
          sum->holding += t.holding;
          sum->worst_rel = std::max(sum->worst_rel, t.worst_rel);
        }
      }
  std::printf("\n");
  for (const auto& [name, t] : of_effect) std::printf("%s", Row(name, t).c_str());
  std::printf("\n");
  for (const auto& [key, t] : tallies.of_key)
    std::printf("%-26s %4d of %4d hold, worst %.2f %%\n", key.c_str(), t.holding, t.intervals,
                100.0 * t.worst_rel);
  std::printf("%s", Row("all", all).c_str());
  if (options.circles) std::printf("%d of %d circles better than before\n", tallies.better, tallies.circles);
  return 0;
}

}  // namespace
}  // namespace contour

int main(int argc, char** argv) {
  CLI::App app{"Commissions emulated machines from catalogue data in virtual time."};
  contour::Options options;
  app.add_option("--machines", options.machines, "base, or machines of config/family");
  app.add_option(
      "--effects", options.effects,
      "none, cogging3, cogging6, ripple, wobble, motor_friction, side_mode, counterbalance, torque_noise");
  app.add_option("--mode", options.mode,
                 "Of the drives: cst, or csp (recorded in torque mode where there are loops for it)")
      ->capture_default_str();
  app.add_flag("--stay", options.stay, "In csp while an axis is recorded, whatever there is");
  app.add_option("--set", options.set, "Put KEY=VALUE on top of each machine's file; any number of times")
      ->allow_extra_args(false);
  app.add_option("--seeds", options.seeds, "How many");
  app.add_option("--first", options.first, "The first of them");
  app.add_option("--threads", options.threads, "Of identification");
  app.add_flag("--circles", options.circles, "Both axes, then circles as before and after");
  app.add_option("--scratch", options.scratch, "Directory for the circles' files")->capture_default_str();
  app.add_flag("--quiet", options.quiet, "Without the parameters of each case");
  CLI11_PARSE(app, argc, argv);
  return contour::Run(options);
}
