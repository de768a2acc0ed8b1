#include "tools/contour/identification_report.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <stdexcept>

#include "analysis/identification/result_files.h"
#include "analysis/identification/usable.h"
#include "analysis/parallel/parallel_for.h"
#include "design/catalogue_doubt.h"
#include "tools/contour/draw_pictures.h"

namespace contour {
identify::Identification IdentifyWithProgress(const IdentificationJob& job) {
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
  return id;
}

ModelConfig Report(const IdentificationJob& job, const identify::Identification& id) {
  if (const std::string why = identify::WhyUnusable(id); !why.empty())
    throw std::runtime_error("no model was written: " + why + (job.to_try.empty() ? "" : "; " + job.to_try));
  ModelConfig model = identify::ToModel(id, job.model);
  const std::string no_screw = identify::WhyNoScrew(id, job.shaken);
  if (!no_screw.empty()) LeaveScrewOpen(model, job.model, id.wind_up.found);
  identify::WriteModelFile(job.out, model, id, job.sources);
  std::cout << identify::ResultTable(id, job.model, model);
  if (!no_screw.empty()) std::cout << "warning: " << no_screw << "; " << job.for_screw << "\n";
  std::cout << "wrote " << job.out.string() << "\n";
  if (job.report.empty()) return model;
  std::error_code error;
  std::filesystem::create_directories(job.report, error);
  if (error) throw std::runtime_error("cannot make " + job.report.string() + ": " + error.message());
  identify::WriteIdentificationJson(job.report / "identification.json", id, job.sources);
  DrawPictures("plot_identification.py", job.report);
  return model;
}

}  // namespace contour
