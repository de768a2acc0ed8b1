#include "tools/contour/export_command.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "daemon/telemetry/cycle_csv.h"
#include "daemon/telemetry/log_reader.h"

namespace contour {
namespace {

struct Options {
  std::string log;
  std::string out;
  std::vector<std::string> columns;
};

constexpr std::uint64_t kProgressEvery = 20'000;

std::uint64_t WriteRows(LogReader& reader, const CycleCsv& csv, std::ostream& out) {
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  auto entry = std::make_unique<CycleEntry>();
  std::string row = csv.Header();
  std::uint64_t cycles = 0;
  do {
    out << row;
    row.clear();
    if (!reader.Next(*entry)) break;
    csv.AppendRow(entry->output.record, entry->timing, row);
    if (++cycles % kProgressEvery == 0 && terminal) std::cerr << "\r" << cycles << " cycles" << std::flush;
  } while (out);
  if (terminal && cycles >= kProgressEvery) std::cerr << "\r\x1b[K";
  return cycles;
}

int RunExport(const Options& options) {
  LogReader reader(options.log);
  std::unique_ptr<CycleCsv> csv;
  try {
    csv = std::make_unique<CycleCsv>(reader.header().axis_names, reader.header().cycle_us, options.columns);
  } catch (const std::invalid_argument& error) {
    std::cerr << "--columns: " << error.what() << "\n";
    return kExitBadUsage;
  }
  std::ofstream out(options.out, std::ios::binary);
  const std::uint64_t cycles = WriteRows(reader, *csv, out);
  out.close();
  if (!out) throw std::runtime_error("cannot write " + options.out);
  std::cout << options.out << ": " << cycles << " cycles";
  if (reader.missing_cycles() > 0)
    std::cout << "; " << reader.missing_cycles() << " more ran and are not in the log";
  if (!reader.complete())
    std::cout << "; the log was not closed: its writer was killed, or the file cut short";
  std::cout << "\n";
  return kExitDone;
}

}  // namespace

void AddExportCommand(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("export", "A recorded log as a table, one row per cycle");
  sub->add_option("log", options->log, "Log that contourd --log wrote")->required()->check(CLI::ExistingFile);
  sub->add_option("--out", options->out, "Table to write (CSV)")->required();
  sub->add_option("--columns", options->columns, "Only these columns, in this order; NAME,NAME...")
      ->delimiter(',');
  sub->callback([options, &action] { action = [options] { return RunExport(*options); }; });
}

}  // namespace contour
