#include "daemon/start_file.h"

#include "config/config_error.h"
#include "config/load_machine.h"
#include "daemon/loaded_model.h"
#include "daemon/recording_mode.h"
#include "design/loop_choice.h"
#include "design/loop_judgement.h"

namespace contour {
namespace {

LoopDemand DemandOf(const DaemonOptions& options) {
  // What commissions is judged by who asks for it, on a set of its own (design/start_set.h). Of a loop to
  // begin with (contour tune --catalogue) no more can be had than that it is stable for all that is not
  // known.
  return options.torque_loops.empty() ? LoopDemand::kStability : LoopDemand::kStabilityAsStated;
}

}  // namespace

std::vector<std::string> OverridesOf(const DaemonOptions& options) {
  std::vector<std::string> set = options.set;
  if (!options.controller.empty()) set.push_back("machine.controller=" + options.controller);
  if (!options.buses.empty()) {
    const std::vector<std::string> names = BusNames(LoadMachine(options.config, set));
    if (options.buses.size() != names.size())
      throw ConfigError({"--bus: found " + std::to_string(options.buses.size()) +
                         " interfaces, expected one for each of the " + std::to_string(names.size()) +
                         " buses of " + options.config});
    for (std::size_t i = 0; i < names.size(); ++i)
      set.push_back("buses." + names[i] + ".interface=" + options.buses[i]);
  }
  for (const std::string& model : options.models) set.push_back(ModelOverride(model));
  for (const std::string& assignment :
       RecordingOverrides({options.torque_loops, options.torque_models, options.csp_axes}))
    set.push_back(assignment);
  return set;
}

MaybeEmulatedMachineFile LoadFile(const DaemonOptions& options, const std::vector<std::string>& overrides) {
  for (const auto& [name, bus] : LoadMachine(options.config, overrides).buses)
    if (bus.interface == "loopback") return LoadMaybeEmulatedMachine(options.config, overrides);
  // Whatever stands under emulator: is none of the daemon's business on a real bus.
  return {LoadMachine(options.config, overrides), false, {}};
}

std::vector<std::string> RequireLoops(const DaemonOptions& options,
                                      const std::vector<std::string>& overrides) {
  const LoopVerdicts verdicts = JudgeStatedLoops(LoadMachine(options.config, overrides), DemandOf(options));
  if (!verdicts.refused.empty())
    throw ConfigError(WithPlaces(OpenMachineFile(options.config, overrides), verdicts.refused));
  return verdicts.warned;
}

StartLoops LoopsOfStart(const DaemonOptions& options, const std::vector<std::string>& overrides,
                        const std::function<void()>& begins) {
  StartLoops loops;
  loops.chosen = LoopsThatAreMissing(LoadMachine(options.config, overrides), options.config, begins);
  std::vector<std::string> with_chosen = overrides;
  with_chosen.insert(with_chosen.end(), loops.chosen.begin(), loops.chosen.end());
  loops.warned = RequireLoops(options, with_chosen);
  return loops;
}

}  // namespace contour
