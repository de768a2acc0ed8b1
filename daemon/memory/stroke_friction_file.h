#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/memory/stroke_friction.h"

namespace contour {

/// The axis that a map was learnt on.
struct MappedAxis {
  std::string machine;
  std::string axis;
  StrokeFriction::Stroke stroke;
  double encoder_counts_per_rev = 0.0;
};

std::filesystem::path StrokeFrictionFile(const std::filesystem::path& directory, const MappedAxis& axis);

/// Puts the steps in place of what the file held, as a whole or not at all: written beside it, forced to the
/// disk, renamed. Throws std::runtime_error with the cause.
void WriteStrokeFriction(const std::filesystem::path& file, const MappedAxis& axis,
                         const std::vector<StrokeFriction::Step>& steps);

/// What a file held, or why it is not to be used.
struct StrokeFrictionRead {
  std::vector<StrokeFriction::Step> steps;
  std::string refused;  ///< empty: it may be used
};
/// There must be a file. Refuses what is damaged, belongs to another axis or stroke, or cannot be friction.
StrokeFrictionRead ReadStrokeFriction(const std::filesystem::path& file, const MappedAxis& axis);

}  // namespace contour
