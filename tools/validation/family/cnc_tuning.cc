#include "tools/validation/family/cnc_tuning.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <ostream>
#include <sstream>

#include "config/config_error.h"
#include "design/simplex_search.h"

namespace contour {
namespace {

/// None that the family is scored with.
constexpr std::size_t kDualLoop = 9;
constexpr double kStopped_um = 1000.0;
constexpr double kSmallest_um = 1e-3;

std::string ThreeDigits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

double ToUnit(const CncKey& k, double value) {
  return k.logarithmic ? std::log(value / k.min) / std::log(k.max / k.min)
                       : (value - k.min) / (k.max - k.min);
}
double FromUnit(const CncKey& k, double unit) {
  const double value = k.logarithmic ? k.min * std::pow(k.max / k.min, unit) : k.min + unit * (k.max - k.min);
  return std::stod(ThreeDigits(value));  // tried as it is written
}

double Cost_um(const std::string& folder, const CncTuned& tuned, char program) {
  FamilyCell cell;
  cell.setting.machine = tuned.machine;
  cell.setting.plant = tuned.plant;
  cell.setting.set = CncAssignments(tuned);
  cell.entry = {"cnc", "csp"};
  cell.program = program;
  cell.seed = kTuningSeed;
  cell.hold = false;
  const FamilyResult ran = RunFamilyCell(folder, cell);
  return ran.failure.empty() ? std::clamp(ran.peak_um, kSmallest_um, kStopped_um) : kStopped_um;
}

}  // namespace

const std::array<CncKey, 10>& CncKeys() {
  static const std::array<CncKey, 10> keys{{
      {"control.cnc.lost_motion_share", 0.0, 3.0, 1.0, false},
      {"control.cnc.lost_motion_travel_rel", 0.1, 10.0, 1.0, true},
      {"control.cnc.friction_share", 0.0, 3.0, 1.0, false},
      {"control.cnc.friction_travel_rel", 0.1, 10.0, 1.0, true},
      {"control.cnc.viscous_share", 0.0, 3.0, 1.0, false},
      {"control.cnc.pulse_share", -1.0, 1.0, 0.0, false},
      {"control.cnc.pulse_ms", 2.0, 100.0, 10.0, true},
      {"control.cnc.bend_share", -10.0, 10.0, 1.0, false},
      {"control.cnc.lead_ms", 0.0, 2.0, 0.3, false},
      {"emulator.axes.*.cascade.dual_loop_Hz", 1.0, 200.0, 15.0, true},
  }};
  return keys;
}

std::vector<std::string> CncAssignments(const CncTuned& tuned) {
  std::vector<std::string> set;
  for (std::size_t i = 0; i < CncKeys().size(); ++i)
    if (i != kDualLoop || tuned.values[i] > 0.0)
      set.push_back(std::string(CncKeys()[i].key) + "=" + ThreeDigits(tuned.values[i]));
  return set;
}

CncTuned TuneCnc(const std::string& folder, const CncTask& task) {
  CncTuned tuned{task.machine, task.plant};
  const std::size_t count = task.dual_loop ? kDualLoop + 1 : kDualLoop;
  std::vector<double> start;
  for (std::size_t i = 0; i < count; ++i) {
    const bool lost_motion = i == 0;
    const double from = lost_motion && task.dual_loop ? 0.0 : CncKeys()[i].start;  // the scale sees it
    start.push_back(ToUnit(CncKeys()[i], from));
  }
  const auto put = [&](const std::vector<double>& point) {
    for (std::size_t i = 0; i < count; ++i) tuned.values[i] = FromUnit(CncKeys()[i], point[i]);
  };
  const auto cost = [&](const std::vector<double>& point) {
    put(point);
    const double now_um = Cost_um(folder, tuned, task.program);
    if (tuned.evaluations++ == 0) tuned.before_um = now_um;
    return std::log(now_um);
  };
  const SearchResult found = SimplexSearch(cost, start, task.evaluations_per_key * static_cast<int>(count));
  put(found.best);
  tuned.after_um = std::exp(found.cost);
  return tuned;
}

void WriteCncTuned(std::ostream& out, const std::vector<CncTuned>& tuned) {
  out << "machine,plant,before_um,after_um,evaluations";
  for (const CncKey& k : CncKeys())
    out << ',' << std::string(k.key).substr(std::string(k.key).rfind('.') + 1);
  out << '\n';
  for (const CncTuned& t : tuned) {
    out << t.machine << ',' << kFamilyPlants[static_cast<std::size_t>(t.plant)] << ','
        << ThreeDigits(t.before_um) << ',' << ThreeDigits(t.after_um) << ',' << t.evaluations;
    for (const double value : t.values) out << ',' << ThreeDigits(value);
    out << '\n';
  }
}

std::vector<CncTuned> ReadCncTuned(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw ConfigError({path + ": cannot be read; contour_family --tune-cnc writes it"});
  std::vector<CncTuned> all;
  std::string line;
  std::getline(in, line);
  for (int number = 2; std::getline(in, line); ++number) {
    CncTuned t;
    std::istringstream cells(line);
    std::vector<std::string> parts;
    for (std::string part; std::getline(cells, part, ',');) parts.push_back(part);
    const auto plant = parts.size() < 2 ? kFamilyPlants.end()
                                        : std::find(kFamilyPlants.begin(), kFamilyPlants.end(), parts[1]);
    bool good = parts.size() == 5 + t.values.size() && plant != kFamilyPlants.end();
    const auto read = [&](std::size_t i, auto& value) {
      const char* end = parts[i].data() + parts[i].size();
      const auto done = std::from_chars(parts[i].data(), end, value);
      good = good && done.ec == std::errc{} && done.ptr == end;
    };
    if (good) {
      t.machine = parts[0];
      t.plant = static_cast<FamilyPlant>(plant - kFamilyPlants.begin());
      read(2, t.before_um);
      read(3, t.after_um);
      read(4, t.evaluations);
      for (std::size_t i = 0; i < t.values.size(); ++i) read(5 + i, t.values[i]);
    }
    if (!good)
      throw ConfigError({path + ":" + std::to_string(number) + ": found '" + line +
                         "', expected machine, ideal or rough, two costs, evaluations and " +
                         std::to_string(t.values.size()) + " numbers"});
    all.push_back(t);
  }
  return all;
}

const CncTuned* FindCncTuned(const std::vector<CncTuned>& tuned, const FamilySetting& setting) {
  const auto found = std::find_if(tuned.begin(), tuned.end(), [&](const CncTuned& t) {
    return t.machine == setting.machine && t.plant == setting.plant;
  });
  return found == tuned.end() ? nullptr : &*found;
}

}  // namespace contour
