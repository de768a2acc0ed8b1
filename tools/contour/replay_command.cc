#include "tools/contour/replay_command.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "daemon/telemetry/cycle_csv.h"
#include "tools/contour/text_table.h"
#include "tools/replay/replay_run.h"

namespace contour {
namespace {

using nlohmann::json;

struct Options {
  std::string log;
  double tolerance = 0.0;
  bool json = false;
  std::string table;
  std::uint64_t every = 1;
  std::vector<std::string> set;
};

constexpr std::uint64_t kProgressEvery = 10'000;

/// What the replayed cycles gave out, as a table.
class Table {
 public:
  Table(const std::string& file, std::uint64_t every, const LogHeader& header)
      : name_(file),
        every_(every),
        csv_(header.axis_names, header.cycle_us),
        stream_(file, std::ios::binary) {
    stream_ << csv_.Header();
  }
  void Add(const CycleEntry& entry) {
    if (entry.input.cycle % every_ != 0) return;
    row_.clear();
    csv_.AppendRow(entry.output.record, {}, row_);
    stream_ << row_;
  }
  void Close() {
    stream_.close();
    if (!stream_) throw std::runtime_error("cannot write " + name_);
  }

 private:
  std::string name_;
  std::uint64_t every_;
  CycleCsv csv_;
  std::ofstream stream_;
  std::string row_;
};

json Number(double value) { return std::isfinite(value) ? json(value) : json("inf"); }

json ToJson(const QuantityDifference& d) {
  return {{"quantity", d.quantity},
          {"first_cycle", d.cycle},
          {"recorded", d.recorded},
          {"replayed", d.replayed},
          {"cycles", d.cycles},
          {"largest_difference", d.largest ? Number(*d.largest) : json(nullptr)},
          {"largest_difference_cycle", d.largest ? json(d.largest_cycle) : json(nullptr)},
          {"largest_value", d.largest ? json(d.scale) : json(nullptr)},
          {"within_tolerance", d.within_tolerance}};
}

json ToJson(const ReplayReport& r) {
  json differences = json::array();
  for (const QuantityDifference& d : r.differences) differences.push_back(ToJson(d));
  return {
      {"verdict", Name(r.verdict)},
      {"cycles", r.cycles},
      {"first_cycle", r.first_cycle},
      {"last_cycle", r.last_cycle},
      {"log_closed", r.closed},
      {"same_build", r.recorded_build == r.replayed_build},
      {"recorded_build", r.recorded_build},
      {"replayed_build", r.replayed_build},
      {"tolerance", r.tolerance},
      {"damaged_cycle", r.damaged_cycle && *r.damaged_cycle != 0 ? json(*r.damaged_cycle) : json(nullptr)},
      {"message", r.message},
      {"first_difference", differences.empty() ? json(nullptr) : differences.front()},
      {"differences", differences}};
}

std::string Short(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string DifferencesText(const ReplayReport& r) {
  if (r.differences.empty()) return {};
  const QuantityDifference& first = r.differences.front();
  std::string text = "first difference at cycle " + std::to_string(first.cycle) + ": " + first.quantity +
                     " was " + first.recorded + " and is now " + first.replayed + "\n";
  TextColumns table;
  table.Add({"quantity", "differs from cycle", "in cycles", "by at most", "at cycle", "of at most", ""});
  for (const QuantityDifference& d : r.differences)
    table.Add({d.quantity, std::to_string(d.cycle), std::to_string(d.cycles),
               d.largest ? Short(*d.largest) : "-", d.largest ? std::to_string(d.largest_cycle) : "-",
               d.largest ? Short(d.scale) : "-", d.within_tolerance ? "within tolerance" : ""});
  return text + table.Text();
}

std::string VerdictText(const ReplayReport& r) {
  const std::string range = std::to_string(r.cycles) + " cycles, " + std::to_string(r.first_cycle) + " to " +
                            std::to_string(r.last_cycle);
  switch (r.verdict) {
    case ReplayVerdict::kSame:
      return range + ": the same, every output bit for bit\n";
    case ReplayVerdict::kWithinTolerance:
      return range + ": not the same bits, but within the tolerance of " + Short(r.tolerance) +
             " of each quantity's largest value\n";
    case ReplayVerdict::kDiffers:
      return range + ": differs\n";
    case ReplayVerdict::kNoOutputs:
      return range + ": the log holds inputs only; there was nothing to compare with\n";
    case ReplayVerdict::kDamaged:
    case ReplayVerdict::kIncomplete:
    case ReplayVerdict::kCutShort:
      break;
  }
  const char* before = r.verdict == ReplayVerdict::kCutShort ? "within the tolerance\n" : "differs\n";
  return r.message + "\n" + "before that, " + range + ": " +
         (r.differences.empty() ? "the same, every output bit for bit\n" : before);
}

std::string ReportText(const ReplayReport& r) {
  std::string text = VerdictText(r) + DifferencesText(r);
  if (r.recorded_build != r.replayed_build)
    text += "recorded by another build: " + r.recorded_build +
            "\n             this build is: " + r.replayed_build + "\n";
  if (!r.closed && r.verdict == ReplayVerdict::kDiffers)
    text += "the log was not closed: its writer was killed, or the file cut short\n";
  return text;
}

int RunReplay(const Options& options) {
  LogReader log(options.log);
  std::unique_ptr<Table> table;
  if (!options.table.empty()) table = std::make_unique<Table>(options.table, options.every, log.header());
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  std::uint64_t cycles = 0;
  ReplayOptions replay;
  replay.tolerance = options.tolerance;
  replay.set = options.set;
  replay.observer = [&](const CycleEntry& entry) {
    if (table) table->Add(entry);
    if (++cycles % kProgressEvery == 0 && terminal) std::cerr << "\r" << cycles << " cycles" << std::flush;
  };
  const ReplayReport report = Replay(log, replay);
  if (terminal && cycles >= kProgressEvery) std::cerr << "\r\x1b[K";
  if (table) table->Close();
  std::cout << (options.json ? ToJson(report).dump(2) + "\n" : ReportText(report));
  return Passed(report.verdict) ? kExitDone : kExitFailed;
}

}  // namespace

void AddReplayCommand(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("replay", "Run a recorded log through the cycle again and compare");
  sub->add_option("log", options->log, "Log of contourd --log, contour simulate --log, or a flight record")
      ->required()
      ->check(CLI::ExistingFile);
  sub->add_option("--tolerance", options->tolerance,
                  "Allowed difference of a measure, as a share of its largest value in the log; states and "
                  "counts must be equal in any case")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  sub->add_option(
         "--set", options->set,
         "KEY=VALUE: what another configuration would have computed from the same inputs; repeatable")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  sub->add_flag("--json", options->json, "For programs: the whole comparison, as JSON");
  sub->add_option("--table", options->table, "Write what the cycle gives out now to this table (CSV)");
  sub->add_option("--every", options->every, "Rows of the table: every so many cycles")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  sub->footer(
      "Exit status: 0 the same (or within the tolerance), 1 differs, is damaged, incomplete or cut short.");
  sub->callback([options, &action] { action = [options] { return RunReplay(*options); }; });
}

}  // namespace contour
