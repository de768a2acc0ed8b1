#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "analysis/metrics/run_metrics.h"

namespace contour {

/// What is known of a run besides its rows.
struct RunFacts {
  std::string controller;
  std::string program;
  std::optional<std::uint64_t> seed;  ///< of the emulated machine
  int cycle_us = 1000;
  std::uint64_t cycles = 0;                  ///< of the program
  std::optional<std::uint64_t> late_cycles;  ///< empty in virtual time
  std::uint64_t stale_cycles = 0;
};

/// The text of metrics.json, with its line end.
std::string MetricsJson(const RunFacts& facts, const RunMetrics& metrics);

/// Throws std::runtime_error when the file cannot be written.
void WriteMetrics(const std::filesystem::path& file, const RunFacts& facts, const RunMetrics& metrics);

}  // namespace contour
