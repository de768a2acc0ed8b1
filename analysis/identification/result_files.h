#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/identification/identification.h"
#include "config/model_config.h"

namespace contour::identify {

/// The identified model next to what was stated before: values in its own units, relative standard deviations
/// under `uncertainty:` for every key that was identified. Other keys, and extensions, stay.
ModelConfig ToModel(const Identification& id, ModelConfig stated);

/// A model file as machine files and `contour identify --model` take it, with a head that says where it comes
/// from, the torque path's delay and lag among it (they are keys of `drive:`). Throws std::runtime_error.
void WriteModelFile(const std::filesystem::path& file, const ModelConfig& model, const Identification& id,
                    const std::vector<std::string>& sources);

/// Everything for pictures and for people who go on: identification.json. Throws std::runtime_error.
void WriteIdentificationJson(const std::filesystem::path& file, const Identification& id,
                             const std::vector<std::string>& sources);

/// A table for the terminal: stated, identified, 95 % interval.
std::string ResultTable(const Identification& id, const ModelConfig& before, const ModelConfig& after);

}  // namespace contour::identify
