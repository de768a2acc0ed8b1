#include "tools/contour/emps_command.h"

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "analysis/diagnosis/report/draw.h"
#include "analysis/parallel/parallel_for.h"
#include "tools/contour/terminal_progress.h"
#include "tools/validation/emps/emps_report.h"

namespace contour {
namespace {

struct Options {
  std::string emps;
  std::string out = "docs/laboratory";
  int threads = 0;
};

int RunEmps(const Options& options) {
  if (!emps::HasRecordings(options.emps)) {
    std::cout << "skipped: no emps_train.csv and emps_pulses.csv in " << options.emps
              << " (A. Janot, M. Gautier, M. Brunot: EMPS, nonlinearbenchmark.org)\n";
    return kExitDone;
  }
  const std::filesystem::path out = options.out;
  TerminalProgress progress;
  emps::ReportOptions report;
  report.emps = options.emps;
  report.out = out;
  report.threads = ThreadsOf(options.threads);
  report.progress = [&](std::string_view doing, double share) { progress.Show(doing, share); };
  emps::WriteEmpsReport(report);
  const std::filesystem::path data = out / "emps_data.csv";
  diagnosis::Draw("plot_emps.py", {data.string(), out.string()});
  std::filesystem::remove(data);
  std::cout << "wrote " << (out / "emps.md").string() << " and its pictures\n";
  return kExitDone;
}

}  // namespace

void AddEmpsCommand(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub =
      app.add_subcommand("emps", "Diagnosis of the EMPS recordings, a real axis, as docs/laboratory/emps.md");
  sub->add_option("--emps", options->emps, "Directory with emps_train.csv and emps_pulses.csv")->required();
  sub->add_option("--out", options->out, "Directory for emps.md and its pictures");
  sub->add_option("--threads", options->threads, "Cores to use; 0: all")->check(CLI::Range(0, 256));
  sub->callback([options, &action] { action = [options] { return RunEmps(*options); }; });
}

}  // namespace contour
