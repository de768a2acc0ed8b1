#include "tools/contour/identification_report.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <stdexcept>

#include "analysis/identification/identification.h"
#include "analysis/identification/result_files.h"
#include "analysis/identification/usable.h"
#include "analysis/parallel/parallel_for.h"

namespace contour {
namespace {

/// The script that draws, beside a build in its source tree; empty when this program lives elsewhere.
std::filesystem::path PlotScript() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return {};
  // build/release/bin/contour
  const std::filesystem::path script =
      program.parent_path().parent_path().parent_path().parent_path() / "tools/plots/plot_identification.py";
  return std::filesystem::exists(script, error) ? script : std::filesystem::path{};
}

std::string Quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

void Draw(const std::filesystem::path& directory) {
  const std::filesystem::path script = PlotScript();
  // The system's own interpreter has the packages; one that comes first in PATH need not.
  std::error_code error;
  const std::string python =
      std::filesystem::exists("/usr/bin/python3", error) ? "/usr/bin/python3" : "python3";
  const std::string command = python + " " + Quoted(script.string()) + " " + Quoted(directory.string());
  if (script.empty()) {
    std::cout << "pictures: tools/plots/plot_identification.py " << directory.string() << "\n";
    return;
  }
  std::cout << std::flush;
  if (std::system(command.c_str()) != 0)  // NOLINT(concurrency-mt-unsafe): one thread, a command of our own
    std::cerr << "the pictures could not be drawn; the model is written: " << command << "\n";
}

}  // namespace

ModelConfig IdentifyAndReport(const IdentificationJob& job) {
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  identify::IdentifyOptions options;
  options.threads = ThreadsOf(job.threads);
  options.progress = [&](const std::string& doing, double share) {
    if (terminal) std::fprintf(stderr, "\r\x1b[Kidentifying  %3.0f %%  %s", 100.0 * share, doing.c_str());
  };
  identify::Identification id = identify::Identify(job.stated, job.logs, options);
  if (terminal) std::fputs("\r\x1b[K", stderr);
  const double cycles = id.seconds / id.period_s;
  id.missing_share = std::max(id.missing_share, static_cast<double>(job.lost_cycles) / std::max(1.0, cycles));
  if (const std::string why = identify::WhyUnusable(id); !why.empty())
    throw std::runtime_error("no model was written: " + why);
  const ModelConfig model = identify::ToModel(id, job.model);
  identify::WriteModelFile(job.out, model, id, job.sources);
  std::cout << identify::ResultTable(id, job.model, model) << "wrote " << job.out.string() << "\n";
  if (job.report.empty()) return model;
  std::error_code error;
  std::filesystem::create_directories(job.report, error);
  if (error) throw std::runtime_error("cannot make " + job.report.string() + ": " + error.message());
  identify::WriteIdentificationJson(job.report / "identification.json", id, job.sources);
  Draw(job.report);
  return model;
}

}  // namespace contour
