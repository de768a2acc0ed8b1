#include "tools/validation/contest/contest_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace contour {
namespace {

std::string Number(double value) {
  if (!std::isfinite(value)) return "stopped";
  char text[32];
  std::snprintf(text, sizeof text, value < 0.0995 ? "%.3f" : value < 9.95 ? "%.2f" : "%.0f", value);
  return text;
}

/// Heats of one program on one machine.
struct Row {
  std::string program;
  std::string machine;
  std::vector<const Heat*> heats;

  [[nodiscard]] double Median_um(std::size_t controller) const {
    std::vector<double> peaks;
    for (const Heat* h : heats) peaks.push_back(h->results[controller].peak_um);
    return Median(peaks);
  }
};

std::vector<Row> Rows(const std::vector<Heat>& heats) {
  std::vector<Row> rows;
  for (const Heat& h : heats) {
    if (rows.empty() || rows.back().program != h.program || rows.back().machine != h.machine)
      rows.push_back({h.program, h.machine, {}});
    rows.back().heats.push_back(&h);
  }
  return rows;
}

void WriteTable(std::ostream& out, const std::vector<Row>& rows) {
  std::string program;
  for (const Row& row : rows) {
    const auto& controllers = row.heats.front()->controllers;
    if (row.program != program) {
      program = row.program;
      out << "\n### " << program << "\n\n| machine |";
      for (const ControllerName c : controllers) out << " " << Name(c) << " |";
      out << "\n| --- |";
      for (std::size_t i = 0; i < controllers.size(); ++i) out << " ---: |";
      out << "\n";
    }
    std::vector<double> peaks;
    for (std::size_t i = 0; i < controllers.size(); ++i) peaks.push_back(row.Median_um(i));
    const double best = *std::min_element(peaks.begin(), peaks.end());
    out << "| " << row.machine << " |";
    for (std::size_t i = 0; i < peaks.size(); ++i) {
      const bool unstable = std::any_of(row.heats.begin(), row.heats.end(),
                                        [&](const Heat* h) { return Unstable(*h, controllers[i]); });
      const std::string text = Number(peaks[i]) + (unstable ? " (!)" : "");
      out << " " << (peaks[i] == best ? "**" + text + "**" : text) << " |";
    }
    out << "\n";
  }
}

std::string Where(const Heat& h) { return h.program + ", " + h.machine + ", seed " + std::to_string(h.seed); }

void WriteLosses(std::ostream& out, const Verdict& verdict) {
  out << "\n## Where `full` loses\n\nRuns in which it is more than 10 %, and more than one count of the "
         "finest encoder "
         "(4.8 nm), behind the best, the worst first.\n\n";
  if (verdict.losses.empty()) {
    out << "None.\n";
    return;
  }
  out << "| program | machine | seed | full | best | by | ratio |\n| --- | --- | ---: | ---: | ---: | --- | "
         "---: "
         "|\n";
  for (const Loss& l : verdict.losses)
    out << "| " << l.heat->program << " | " << l.heat->machine << " | " << l.heat->seed << " | "
        << Number(l.full_um) << " | " << Number(l.best_um) << " | " << Name(l.best) << " | "
        << Number(l.ratio()) << " |\n";
}

void WriteRivals(std::ostream& out, const Verdict& verdict) {
  if (verdict.rivals.empty()) return;
  out << "\n## Are the rivals well tuned?\n\nNominal machine, median of the seeds, against the figures that "
         "a "
         "numerical prototype of each reached.\nA ratio to a rival counts only where the rival reaches its "
         "figure within 15 %.\n\n| controller | program | expected um | reached um | |\n| --- | --- | ---: | "
         "---: | --- |\n";
  for (const RivalCheck& r : verdict.rivals) {
    const char* text = "not reached";
    if (r.reached == Reached::kYes) text = "reached";
    if (r.reached == Reached::kBelow) text = "below it";
    out << "| " << r.expected.controller << " | " << r.expected.program << " | " << r.expected.peak_um
        << " | " << Number(r.peak_um) << " | " << text << " |\n";
  }
}

}  // namespace

void WriteContestCsv(std::ostream& out, const std::vector<Heat>& heats) {
  out << "program,machine,seed,controller,table_peak_um,table_rms_um,encoder_peak_um,circular_deviation_um,"
         "unstable,failure\n";
  const auto number = [&](double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    out << ',' << (std::isfinite(value) ? text : "");
  };
  for (const Heat& h : heats) {
    for (std::size_t i = 0; i < h.results.size(); ++i) {
      const CellResult& r = h.results[i];
      out << h.program << ',' << h.machine << ',' << h.seed << ',' << Name(h.controllers[i]);
      number(r.peak_um);
      number(r.rms_um);
      number(r.encoder_peak_um);
      number(r.circular_deviation_um.value_or(INFINITY));
      std::string failure = r.failure;
      std::replace(failure.begin(), failure.end(), ',', ';');
      out << ',' << (Unstable(h, h.controllers[i]) ? 1 : 0) << ',' << failure << "\n";
    }
  }
}

std::string VerdictText(const Verdict& v) {
  char text[700];
  std::snprintf(
      text, sizeof text,
      "full is best or within 10 %% of the best in %zu of %zu runs (%.1f %%; aim 95 %%): %s\n"
      "full is unstable in %zu (aim 0): %s\n"
      "full is worse than twice the best in %zu (aim 0): %s\n"
      "A difference below one count of the finest encoder (4.8 nm) counted as none; where it counts, "
      "full is best or within 10 %% in %zu, and worse than twice the best in %zu\n",
      v.near_best, v.heats, 100.0 * v.near_best_share(), v.near_best_share() >= 0.95 ? "met" : "missed",
      v.unstable.size(), v.unstable.empty() ? "met" : "missed", v.twice, v.twice == 0 ? "met" : "missed",
      v.strictly_near_best, v.strictly_twice);
  std::string out = text;
  for (const Heat* h : v.unstable) {
    const std::string& failure = h->Of(ControllerName::kFull)->failure;
    out += "unstable: " + Where(*h) + (failure.empty() ? "" : ": " + failure) + "\n";
  }
  return out;
}

void WriteContestMarkdown(std::ostream& out, const std::vector<Heat>& heats, const Verdict& verdict,
                          const std::string& command) {
  out << "# Contest\n\nMade by `" << command
      << "`; do not edit. Programs and machines: [config/contest.yaml](../../config/contest.yaml).\n\n"
         "Every controller on every program and machine, through the daemon's own cycle in virtual time. All "
         "work "
         "with the same machine file,\nwhose model is wrong on purpose, each in the mode of the drives that "
         "`entries:` says. Figures: largest contour error at "
         "the table "
         "in um, median of the seeds; the best in bold; (!) where a seed\nwas unstable: the machine stopped, "
         "the "
         "error grew from turn to turn, or it was more than ten times the median of the other "
         "controllers.\n\n"
         "## Aims\n\n";
  const std::string text = VerdictText(verdict);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    out << "- " << text.substr(at, end - at) << "\n";
    at = end + 1;
  }
  WriteLosses(out, verdict);
  WriteRivals(out, verdict);
  out << "\n## The table\n";
  WriteTable(out, Rows(heats));
}

}  // namespace contour
