#include "tools/validation/contest/contest_config.h"

#include <algorithm>

#include "config/config_error.h"
#include "config/yaml_reader.h"
#include "core/controller_name.h"
#include "daemon/program/program.h"

namespace contour {
namespace {

template <class Named>
void CheckNames(const std::vector<Named>& all, const std::vector<std::string>& chosen,
                const std::string& where, std::vector<std::string>& errors) {
  for (const std::string& name : chosen) {
    if (std::none_of(all.begin(), all.end(), [&](const Named& n) { return n.name == name; }))
      errors.push_back(where + ": found '" + name + "', expected a name under the contest's own list");
  }
}

void CheckPrograms(const std::vector<ContestProgram>& programs, std::vector<std::string>& errors) {
  for (const ContestProgram& p : programs) {
    try {
      ParseProgram(p.program, p.name, ProgramFormat::kYaml);
    } catch (const ConfigError& e) {
      errors.insert(errors.end(), e.messages().begin(), e.messages().end());
    }
  }
}

void CheckController(const std::string& name, const std::string& where, std::vector<std::string>& errors) {
  ControllerName controller{};
  if (!FromName(name, controller))
    errors.push_back(where + ": found '" + name + "', expected " + std::string(Choices(controller)));
}

}  // namespace

ContestConfig LoadContest(const std::string& path) {
  const YamlValue tree = ParseYamlFile(path);
  std::vector<std::string> errors;
  ContestConfig config;
  ReadYaml(tree, config, "", errors);
  if (!errors.empty()) throw ConfigError(std::move(errors));
  CheckPrograms(config.programs, errors);
  CheckPrograms(config.tune.programs, errors);
  for (const std::string& name : config.controllers)
    CheckController(name, WhereIs(tree, "controllers") + ": controllers", errors);
  for (const ContestEntry& e : config.entries)
    CheckController(e.controller, WhereIs(tree, "entries") + ": entries", errors);
  for (const ContestEntry& e : config.entries)
    CheckNames(config.machines, e.machines, WhereIs(tree, "entries") + ": entries.machines", errors);
  for (const TunedController& c : config.tune.controllers) {
    CheckController(c.name, WhereIs(tree, "tune.controllers") + ": tune.controllers", errors);
    for (const TunedKey& k : c.keys)
      if (!(k.max > k.min)) errors.push_back(path + ": tune: " + k.key + ": max is not above min");
  }
  CheckNames(config.programs, config.shorter.programs, WhereIs(tree, "short.programs") + ": short.programs",
             errors);
  CheckNames(config.machines, config.shorter.machines, WhereIs(tree, "short.machines") + ": short.machines",
             errors);
  for (const std::int64_t seed : config.tune.seeds)
    if (std::find(config.seeds.begin(), config.seeds.end(), seed) != config.seeds.end())
      errors.push_back(WhereIs(tree, "tune.seeds") + ": tune.seeds: seed " + std::to_string(seed) +
                       " is scored by the contest");
  for (const ContestProgram& p : config.tune.programs)
    for (const ContestProgram& scored : config.programs)
      if (p.program == scored.program)
        errors.push_back(path + ": tune.programs: " + p.name + " is scored by the contest");
  if (!errors.empty()) throw ConfigError(std::move(errors));
  return config;
}

}  // namespace contour
