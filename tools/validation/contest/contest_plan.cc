#include "tools/validation/contest/contest_plan.h"

#include <algorithm>

#include "config/config_error.h"
#include "config/load_machine.h"
#include "tools/validation/contest/machine_variant.h"

namespace contour {
namespace {

template <class Named>
std::vector<std::string> Names(const std::vector<Named>& all) {
  std::vector<std::string> names;
  for (const Named& n : all) names.push_back(n.name);
  return names;
}

void CheckAmong(const std::vector<std::string>& known, const std::vector<std::string>& chosen,
                const std::string& option) {
  for (const std::string& name : chosen) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    std::string list;
    for (const std::string& k : known) list += (list.empty() ? "" : ", ") + k;
    throw ConfigError({"contour: " + option + ": found '" + name + "', expected some of " + list});
  }
}

template <class Named>
std::vector<Named> Chosen(const std::vector<Named>& all, const std::vector<std::string>& names) {
  std::vector<Named> out;
  std::copy_if(all.begin(), all.end(), std::back_inserter(out),
               [&](const Named& n) { return std::find(names.begin(), names.end(), n.name) != names.end(); });
  return out;
}

// FNV-1a, 64 bits; a byte that no text has ends each of them.
std::uint64_t Stamp(const std::vector<std::string>& texts) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&](unsigned char byte) { hash = (hash ^ byte) * 0x100000001b3u; };
  for (const std::string& text : texts) {
    for (const char c : text) add(static_cast<unsigned char>(c));
    add(0xff);
  }
  return hash;
}

/// The assignments with which a controller enters on a machine; a later entry has the last word.
std::vector<std::string> EntryOf(const std::string& controller, const std::string& machine,
                                 const std::vector<ContestEntry>& entries, const YamlValue& tree) {
  std::vector<std::string> set;
  for (const ContestEntry& e : entries) {
    const bool here =
        e.machines.empty() || std::find(e.machines.begin(), e.machines.end(), machine) != e.machines.end();
    if (e.controller != controller || !here) continue;
    for (std::string& one : ExpandAssignments(tree, e.set)) set.push_back(std::move(one));
  }
  return set;
}

std::string ProgramText(const ContestProgram& program) {
  return program.passes == 1 ? program.program : program.program + " x" + std::to_string(program.passes);
}

std::uint64_t Stamp(const std::string& program, const std::string& machine_file,
                    const std::vector<std::string>& set) {
  const MachineSource source = ReadSource(machine_file, set);
  std::vector<std::string> texts{program, source.text};
  for (const auto& [name, text] : source.files) texts.push_back(text);
  texts.insert(texts.end(), set.begin(), set.end());
  return Stamp(texts);
}

}  // namespace

ContestChoice DefaultChoice(const ContestConfig& config, bool shorter) {
  if (shorter)
    return {config.controllers, config.shorter.programs, config.shorter.machines, config.shorter.seeds};
  return {config.controllers, Names(config.programs), Names(config.machines), config.seeds};
}

void CheckControllers(const ContestConfig& config, const std::vector<std::string>& controllers,
                      const std::string& option) {
  CheckAmong(config.controllers, controllers, option);
}

void CheckChoice(const ContestConfig& config, const ContestChoice& choice) {
  CheckControllers(config, choice.controllers, "--controllers");
  CheckAmong(Names(config.programs), choice.programs, "--programs");
  CheckAmong(Names(config.machines), choice.machines, "--machines");
}

std::vector<std::string> Assignments(const std::string& machine_file, const ContestMachine& machine,
                                     const ContestProgram& program) {
  const YamlValue tree = OpenMachineFile(machine_file, {});
  std::vector<std::string> out = ExpandAssignments(tree, machine.set);
  for (std::string& one : ExpandAssignments(tree, program.set)) out.push_back(std::move(one));
  return out;
}

std::vector<ContestCell> PlanCells(const std::vector<ContestProgram>& programs,
                                   const std::vector<ContestMachine>& machines,
                                   const std::vector<std::int64_t>& seeds,
                                   const std::vector<std::string>& controllers,
                                   const std::string& machine_file, const std::vector<std::string>& extra,
                                   const std::vector<ContestEntry>& entries) {
  const YamlValue tree = OpenMachineFile(machine_file, {});
  std::vector<ContestCell> cells;
  for (const ContestProgram& p : programs) {
    const Program program = ParseProgram(p.program, p.name, ProgramFormat::kYaml);
    for (const ContestMachine& m : machines) {
      std::vector<ContestCell> contestants;
      for (const std::string& c : controllers) {
        std::vector<std::string> set = EntryOf(c, m.name, entries, tree);
        for (std::string& one : Assignments(machine_file, m, p)) set.push_back(std::move(one));
        set.insert(set.end(), extra.begin(), extra.end());
        ContestCell cell{ControllerName::kFull,
                         p.name,
                         m.name,
                         0,
                         program,
                         static_cast<int>(p.passes),
                         std::make_shared<const EmulatedMachineFile>(LoadEmulatedMachine(machine_file, set)),
                         Stamp(ProgramText(p), machine_file, set)};
        FromName(c, cell.controller);
        contestants.push_back(std::move(cell));
      }
      for (const std::int64_t seed : seeds) {
        for (ContestCell cell : contestants) {
          cell.seed = static_cast<std::uint64_t>(seed);
          cells.push_back(std::move(cell));
        }
      }
    }
  }
  return cells;
}

std::vector<ContestCell> PlanCells(const ContestConfig& config, const ContestChoice& choice,
                                   const std::string& machine_file, const std::vector<std::string>& extra) {
  return PlanCells(Chosen(config.programs, choice.programs), Chosen(config.machines, choice.machines),
                   choice.seeds, choice.controllers, machine_file, extra, config.entries);
}

}  // namespace contour
