#pragma once

#include <filesystem>
#include <string>

#include "tools/improve/improve_sequence.h"

namespace contour::improve {

/// Truth files of an emulated machine, as contourd wrote them with the old model and with the best of the new
/// ones; empty without them. They are told and never decided by.
struct TruthFiles {
  std::filesystem::path before, after;
};

/// improve.json: what was drawn, found, fitted and decided. Numbers that are not known are null.
std::string ImproveJson(const ImproveResult& result, const ImproveRequest& request, const TruthFiles& truth);

/// For people: errors before and after, and what became of the model.
std::string ImproveText(const ImproveResult& result, const ImproveRequest& request);

/// The last drawing of a series as a table: time, and for each axis reference, encoder and scale, in m.
void WriteDrawing(const std::filesystem::path& file, const Drawing& drawing,
                  const std::vector<std::string>& axes);

}  // namespace contour::improve
