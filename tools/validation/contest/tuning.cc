#include "tools/validation/contest/tuning.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <sstream>

#include "config/config_error.h"
#include "config/load_machine.h"
#include "config/yaml_writer.h"
#include "design/simplex_search.h"
#include "tools/validation/contest/contest_plan.h"
#include "tools/validation/contest/machine_variant.h"
#include "tools/validation/contest/run_cells.h"

namespace contour {
namespace {

constexpr double kStopped_um = 1000.0;
constexpr double kGrowingFactor = 10.0;
constexpr double kSmallest_um = 1e-3;
constexpr std::string_view kEveryAxis = "axes.*.";

std::string ThreeDigits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// A point of the unit box as assignments.
std::vector<std::string> AssignmentsAt(const TunedController& controller, const std::vector<double>& point) {
  std::vector<std::string> set;
  for (std::size_t i = 0; i < point.size(); ++i) {
    const TunedKey& k = controller.keys[i];
    set.push_back(k.key + "=" + ThreeDigits(k.min * std::pow(k.max / k.min, point[i])));
  }
  return set;
}

/// A key of a machine file with what is below it.
struct Node {
  std::map<std::string, Node> below;
  std::string value;

  void Put(const std::string& dotted, const std::string& text) {
    Node* at = this;
    std::istringstream parts(dotted);
    for (std::string part; std::getline(parts, part, '.');) at = &at->below[part];
    at->value = text;
  }
  void Write(std::string& out, std::size_t indent) const {
    for (const auto& [key, node] : below) {
      out += std::string(indent, ' ') + key + ":" + (node.value.empty() ? "" : " " + node.value) + "\n";
      node.Write(out, indent + 2);
    }
  }
};

}  // namespace

double TuningCost_um(const std::vector<CellResult>& results) {
  double sum = 0.0;
  for (const CellResult& r : results) {
    double cost = kStopped_um;
    if (!r.failed()) {
      cost = std::max(kSmallest_um, std::sqrt(r.peak_um * r.rms_um)) * (Growing(r) ? kGrowingFactor : 1.0);
      cost = std::min(cost, kStopped_um);
    }
    sum += std::log(cost);
  }
  return std::exp(sum / static_cast<double>(std::max<std::size_t>(1, results.size())));
}

double PresentValue(const std::string& machine_file, const std::string& key) {
  const YamlValue file = OpenMachineFile(machine_file, {});
  const std::string assignment = ExpandAssignments(file, {key + "=0"}).front();
  const std::string plain = assignment.substr(0, assignment.find('='));
  EmulatedMachineFile machine = LoadEmulatedMachine(machine_file);
  const std::string complete =
      plain.starts_with("emulator.") ? WriteYaml(machine.emulator) : WriteYaml(machine.machine);
  const std::string prefix = "emulator.";
  return NumberAt(ParseYamlText(complete, machine_file),
                  plain.starts_with(prefix) ? plain.substr(prefix.size()) : plain);
}

TunedResult TuneController(const TuneConfig& config, const TunedController& controller,
                           const std::string& machine_file, int evaluations, unsigned workers,
                           const std::function<void(int, double)>& done) {
  TunedResult result;
  result.controller = controller.name;
  std::vector<double> start;
  for (const TunedKey& k : controller.keys) {
    const double before = PresentValue(machine_file, k.key);
    result.values.push_back({k.key, before, before});
    start.push_back(std::log(before / k.min) / std::log(k.max / k.min));
  }
  const YamlValue file = OpenMachineFile(machine_file, {});
  const auto cost_of = [&](const std::vector<std::string>& set) {
    const auto cells = PlanCells(config.programs, config.machines, config.seeds, {controller.name},
                                 machine_file, ExpandAssignments(file, set));
    result.runs += cells.size();
    return TuningCost_um(RunCells(cells, workers));
  };
  double best_um = std::numeric_limits<double>::infinity();
  const auto cost = [&](const std::vector<double>& point) {
    const double now_um = cost_of(AssignmentsAt(controller, point));
    if (result.evaluations++ == 0) result.cost_before_um = now_um;
    best_um = std::min(best_um, now_um);
    if (done) done(result.evaluations, best_um);
    return std::log(now_um);
  };
  const SearchResult found = SimplexSearch(cost, start, evaluations);
  result.cost_after_um = std::exp(found.cost);
  const std::vector<std::string> set = AssignmentsAt(controller, found.best);
  for (std::size_t i = 0; i < set.size(); ++i)
    result.values[i].after = std::stod(set[i].substr(set[i].find('=') + 1));
  return result;
}

std::string TunedYaml(const std::vector<TunedResult>& results, const std::vector<std::string>& axes) {
  Node root;
  for (const TunedResult& r : results) {
    for (const TunedValue& v : r.values) {
      const std::size_t star = v.key.find(kEveryAxis);
      if (star == std::string::npos) {
        root.Put(v.key, ThreeDigits(v.after));
        continue;
      }
      for (const std::string& axis : axes)
        root.Put(v.key.substr(0, star) + "axes." + axis + "." + v.key.substr(star + kEveryAxis.size()),
                 ThreeDigits(v.after));
    }
  }
  std::string out;
  root.Write(out, 0);
  return out;
}

}  // namespace contour
