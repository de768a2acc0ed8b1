#include "tools/faults/report.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <map>
#include <tuple>

#include "core/reason.h"

namespace contour::faults {
namespace {

__attribute__((format(printf, 1, 2))) std::string Text(const char* format, ...) {
  char text[512];
  va_list values;
  va_start(values, format);
  std::vsnprintf(text, sizeof text, format, values);
  va_end(values);
  return text;
}

std::string Joined(const std::vector<std::string>& parts, const char* between) {
  std::string text;
  for (const std::string& p : parts) text += (text.empty() ? "" : between) + p;
  return text;
}

/// Feeds of a band; the widest limit of the axes counts.
std::string BandText(const Cell& cell, const std::vector<double>& highest_mm_s) {
  if (!Moves(cell.phase)) return "-";
  const double highest = *std::max_element(highest_mm_s.begin(), highest_mm_s.end());
  const auto edge = [&](std::size_t band) {
    const double share = static_cast<double>(band) / static_cast<double>(kFeedBands);
    return kLowestFeed_mm_s * std::pow(highest / kLowestFeed_mm_s, share);
  };
  return Text("%.2g-%.3g", edge(cell.band), edge(cell.band + 1));
}

}  // namespace

std::vector<Cell> Cells(const std::vector<RunResult>& results, const std::vector<double>& highest_mm_s) {
  std::map<std::tuple<Fault, Phase, std::size_t>, Cell> cells;
  for (const RunResult& r : results) {
    const std::size_t band = Moves(r.c.phase) ? BandOf(r.c.feed_mm_s, highest_mm_s[r.c.axis]) : 0;
    Cell& cell = cells[{r.c.fault, r.c.phase, band}];
    cell.fault = r.c.fault;
    cell.phase = r.c.phase;
    cell.band = band;
    if (cell.runs == 0 || r.DepartureShare() > cell.farthest.DepartureShare()) cell.farthest = r;
    ++cell.runs;
    if (!r.violations.empty()) ++cell.failed;
    if (!r.stopped) continue;
    ++cell.stopped;
    if (r.time_s >= cell.time_s) {
      cell.time_s = r.time_s;
      cell.time_bound_s = r.time_bound_s;
    }
    const std::string reason(Name(r.reason));
    if (std::find(cell.reasons.begin(), cell.reasons.end(), reason) == cell.reasons.end())
      cell.reasons.push_back(reason);
  }
  std::vector<Cell> list;
  for (auto& [key, cell] : cells) list.push_back(std::move(cell));
  return list;
}

std::string TableText(const std::vector<Cell>& cells, const std::vector<double>& highest_mm_s) {
  std::string text =
      Text("%-24s %-12s %-12s %5s %5s %5s %12s %12s %9s %9s  %s\n", "fault", "phase", "feed mm/s", "runs",
           "stops", "fails", "departure mm", "at most mm", "time ms", "at most", "reasons");
  for (const Cell& c : cells)
    text += Text("%-24s %-12s %-12s %5zu %5zu %5zu %12.4f %12.4f %9.1f %9.1f  %s\n",
                 std::string(Name(c.fault)).c_str(), std::string(Name(c.phase)).c_str(),
                 BandText(c, highest_mm_s).c_str(), c.runs, c.stopped, c.failed, 1e3 * c.farthest.departure_m,
                 1e3 * c.farthest.departure_bound_m, 1e3 * c.time_s, 1e3 * c.time_bound_s,
                 Joined(c.reasons, ", ").c_str());
  return text;
}

std::string TableMarkdown(const std::vector<Cell>& cells, const std::vector<double>& highest_mm_s) {
  std::string text =
      "| fault | phase | feed mm/s | runs | stops | fails | worst departure mm | at most mm | worst time ms "
      "| "
      "at most ms | reasons |\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Cell& c : cells)
    text += Text("| %s | %s | %s | %zu | %zu | %zu | %.4f | %.4f | %.1f | %.1f | %s |\n",
                 std::string(Name(c.fault)).c_str(), std::string(Name(c.phase)).c_str(),
                 BandText(c, highest_mm_s).c_str(), c.runs, c.stopped, c.failed, 1e3 * c.farthest.departure_m,
                 1e3 * c.farthest.departure_bound_m, 1e3 * c.time_s, 1e3 * c.time_bound_s,
                 Joined(c.reasons, ", ").c_str());
  return text;
}

std::string TableCsv(const std::vector<Cell>& cells) {
  std::string text =
      "fault,phase,band,runs,stops,fails,departure_mm,departure_bound_mm,feed_mm_s,time_s,time_bound_s,"
      "reasons\n";
  for (const Cell& c : cells)
    text += Text("%s,%s,%zu,%zu,%zu,%zu,%.6f,%.6f,%.4g,%.5f,%.5f,%s\n", std::string(Name(c.fault)).c_str(),
                 std::string(Name(c.phase)).c_str(), c.band, c.runs, c.stopped, c.failed,
                 1e3 * c.farthest.departure_m, 1e3 * c.farthest.departure_bound_m, c.farthest.c.feed_mm_s,
                 c.time_s, c.time_bound_s, Joined(c.reasons, " ").c_str());
  return text;
}

std::string RunsCsv(const std::vector<RunResult>& results) {
  std::string text =
      "fault,phase,mode,axis,feed_mm_s,stopped,reason,warned,departure_mm,departure_bound_mm,time_s,"
      "time_bound_s,violations\n";
  for (const RunResult& r : results)
    text += Key(r.c) +
            Text(",%.3g,%d,%s,%d,%.6f,%.6f,%.5f,%.5f,\"", r.c.feed_mm_s, r.stopped ? 1 : 0,
                 std::string(Name(r.reason)).c_str(), r.warned ? 1 : 0, 1e3 * r.departure_m,
                 1e3 * r.departure_bound_m, r.time_s, r.time_bound_s) +
            Joined(r.violations, "; ") + "\"\n";
  return text;
}

std::string Failures(const std::vector<RunResult>& results, const std::string& config, std::uint64_t seed,
                     const std::string& without) {
  std::string text;
  for (const RunResult& r : results) {
    if (r.violations.empty()) continue;
    text += Key(r.c) + Text(" at %.3g mm/s: ", r.c.feed_mm_s) + Joined(r.violations, "; ") +
            "\n  contour_faults --config " + config + " --only " + Key(r.c) +
            Text(" --feed %.3g --seed %llu --runs 1", r.c.feed_mm_s, static_cast<unsigned long long>(seed)) +
            (without.empty() ? "" : " --without " + without) + "\n";
  }
  return text;
}

}  // namespace contour::faults
