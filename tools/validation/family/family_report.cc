#include "tools/validation/family/family_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "tools/validation/contest/contest_verdict.h"

namespace contour {
namespace {

std::string Fixed(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}
std::string FourDigits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string Quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

/// Runs of one controller on one machine, by program.
struct Group {
  std::map<char, std::vector<const FamilyResult*>> programs;

  /// Median of the seeds; infinite when the machine stopped with any of them.
  [[nodiscard]] double Peak_um(char letter) const {
    std::vector<double> peaks;
    for (const FamilyResult* r : programs.at(letter)) {
      if (!r->failure.empty()) return std::numeric_limits<double>::infinity();
      peaks.push_back(r->peak_um);
    }
    return Median(peaks);
  }

  [[nodiscard]] std::string Text() const {
    std::string peaks;
    double hold = 0.0;
    bool refused = true;
    for (const auto& [letter, runs] : programs) {
      std::vector<double> peak;
      bool stopped = false;
      for (const FamilyResult* r : runs) {
        refused = refused && r->refused;
        stopped = stopped || !r->failure.empty();
        peak.push_back(r->peak_um / r->wind_up_um);
        hold = std::max(hold, r->hold_pp_um / r->wind_up_um);
      }
      peaks += (peaks.empty() ? "" : " / ") + (stopped ? "stopped" : Fixed(Median(peak)));
    }
    return refused ? "refused" : peaks + " (" + Fixed(hold) + ")";
  }
};

void AddOnce(std::vector<std::string>& all, const std::string& name) {
  if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
}

std::string RowName(const FamilyCell& c) {
  return c.setting.machine + (c.setting.variation.empty() ? "" : " " + c.setting.variation);
}

/// A mode of `full`, and `cnc`, on one machine.
struct Pairing {
  std::map<std::string, Group> full;  ///< by mode
  Group cnc;

  [[nodiscard]] bool complete() const { return !full.empty() && !cnc.programs.empty(); }
  [[nodiscard]] std::string BetterMode() const {
    const auto& drawn = cnc.programs;
    const char letter = drawn.contains('C') ? 'C' : drawn.begin()->first;
    return std::min_element(full.begin(), full.end(),
                            [&](const auto& a, const auto& b) {
                              return a.second.Peak_um(letter) < b.second.Peak_um(letter);
                            })
        ->first;
  }
};

}  // namespace

void WriteFamilyCsv(std::ostream& out, const std::vector<FamilyCell>& cells,
                    const std::vector<FamilyResult>& results) {
  out << "machine,plant,model,law,variation,controller,mode,program,seed,wind_up_um,peak_um,rms_um,hold_pp_"
         "um,friction_inside_rel,friction_std_over_error,disturbance_inside_rel,disturbance_std_over_error,"
         "stiffness_error_stds,stiffness_error_rel,stiffness_std_rel,failure\n";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const FamilyCell& c = cells[i];
    const FamilyResult& r = results[i];
    out << c.setting.machine << ',' << kFamilyPlants[static_cast<std::size_t>(c.setting.plant)] << ','
        << kFamilyModels[static_cast<std::size_t>(c.setting.model)] << ','
        << (c.setting.maxwell_slip ? "maxwell_slip" : "lugre") << ',' << c.setting.variation << ','
        << c.entry.controller << ',' << c.entry.mode << ',' << c.program << ',' << c.seed << ','
        << FourDigits(r.wind_up_um) << ',' << FourDigits(r.peak_um) << ',' << FourDigits(r.rms_um) << ','
        << FourDigits(r.hold_pp_um) << ',' << FourDigits(r.friction_inside_rel) << ','
        << FourDigits(r.friction_std_over_error) << ',' << FourDigits(r.disturbance_inside_rel) << ','
        << FourDigits(r.disturbance_std_over_error) << ',' << FourDigits(r.stiffness_error_stds) << ','
        << FourDigits(r.stiffness_error_rel) << ',' << FourDigits(r.stiffness_std_rel) << ','
        << Quoted(r.failure) << '\n';
  }
}

void WriteFamilyTable(std::ostream& out, const std::vector<FamilyCell>& cells,
                      const std::vector<FamilyResult>& results) {
  std::vector<std::string> rows, columns;
  std::map<std::string, double> wind_up_um;
  std::map<std::pair<std::string, std::string>, Group> groups;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const FamilyCell& c = cells[i];
    const std::string row =
        c.setting.machine + (c.setting.variation.empty() ? "" : " " + c.setting.variation);
    const std::string column = c.entry.controller + " " + c.entry.mode;
    AddOnce(rows, row);
    AddOnce(columns, column);
    wind_up_um[row] = results[i].wind_up_um;
    groups[{row, column}].programs[c.program].push_back(&results[i]);
  }
  out << "| | F/K um |";
  for (const std::string& column : columns) out << ' ' << column << " |";
  out << "\n|---|---|";
  for (std::size_t i = 0; i < columns.size(); ++i) out << "---|";
  out << '\n';
  for (const std::string& row : rows) {
    out << "| " << row << " | " << Fixed(wind_up_um[row]) << " |";
    for (const std::string& column : columns) out << ' ' << groups[{row, column}].Text() << " |";
    out << '\n';
  }
}

void WriteFamilyRatios(std::ostream& out, const std::vector<FamilyCell>& cells,
                       const std::vector<FamilyResult>& results) {
  std::vector<std::string> rows;
  std::map<std::string, Pairing> pairings;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const FamilyCell& c = cells[i];
    Pairing& pairing = pairings[RowName(c)];
    AddOnce(rows, RowName(c));
    if (c.entry.controller == "full")
      pairing.full[c.entry.mode].programs[c.program].push_back(&results[i]);
    else if (c.entry.controller == "cnc")
      pairing.cnc.programs[c.program].push_back(&results[i]);
  }
  std::erase_if(rows, [&](const std::string& row) { return !pairings[row].complete(); });
  if (rows.empty()) return;
  std::map<char, std::vector<double>> ratios;
  out << "\n| cnc over full | full in | ratio, program by program |\n|---|---|---|\n";
  for (const std::string& row : rows) {
    const Pairing& pairing = pairings[row];
    const std::string mode = pairing.BetterMode();
    std::string text;
    for (const auto& [letter, runs] : pairing.cnc.programs) {
      const double full_um = pairing.full.at(mode).Peak_um(letter), cnc_um = pairing.cnc.Peak_um(letter);
      const bool both_stopped = std::isinf(full_um) && std::isinf(cnc_um);
      ratios[letter].push_back(both_stopped ? 1.0 : cnc_um / full_um);
      text += (text.empty() ? "" : " / ") + Fixed(ratios[letter].back());
    }
    out << "| " << row << " | " << mode << " | " << text << " |\n";
  }
  out << "| median | |";
  std::string medians;
  for (auto& [letter, values] : ratios) medians += (medians.empty() ? " " : " / ") + Fixed(Median(values));
  out << medians << " |\n";
}

}  // namespace contour
