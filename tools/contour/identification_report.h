#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/identification/identification.h"
#include "analysis/recording/axis_log.h"
#include "config/model_config.h"

namespace contour {

/// What identify and commission have in common once the records are there.
struct IdentificationJob {
  diagnosis::StatedAxis stated;
  ModelConfig model;  ///< as stated
  std::vector<diagnosis::AxisLog> logs;
  std::vector<std::string> sources;  ///< named in the files
  std::filesystem::path out;         ///< the model
  std::filesystem::path report;      ///< directory; empty: none
  int threads = 0;                   ///< 0: one per processor
  std::uint64_t lost_cycles = 0;     ///< that a record should have and has not
  std::string to_try;                ///< told with a refusal: what else may help
  bool shaken = false;               ///< for its screw
  std::string for_screw;             ///< what shows more of it
};

/// Identifies, with progress on a terminal.
identify::Identification IdentifyWithProgress(const IdentificationJob& job);

/// Writes the model, and with a report directory identification.json and its pictures; prints the table of
/// results. Throws std::runtime_error, with nothing written, where the result must not be used (WhyUnusable).
/// Gives the model.
ModelConfig Report(const IdentificationJob& job, const identify::Identification& id);

}  // namespace contour
