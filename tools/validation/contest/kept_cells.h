#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "tools/validation/contest/contest_cell.h"

namespace contour {

/// Results of runs in a file, a line each as soon as the run is over: a contest may be run in pieces, and
/// when one controller has changed, only its runs need be made again.
///
/// A run is known by controller, seed, and the texts of its program and machine file. What is compiled into
/// the program is not part of that: after a change of the code it is the user who says which results still
/// hold.
class KeptCells {
 public:
  /// Reads what `file` has, if `resume`, but for the runs of controllers in `again`; otherwise begins anew.
  KeptCells(const std::filesystem::path& file, bool resume, const std::vector<std::string>& again);

  /// Null: not yet run.
  [[nodiscard]] const CellResult* Find(const ContestCell& cell) const;
  void Keep(const ContestCell& cell, const CellResult& result);

 private:
  std::map<std::string, CellResult> results_;
  std::ofstream out_;
};

/// One line of the file without its end, and back. Returns false for a line that is damaged or cut off.
std::string CellLine(const std::string& key, const CellResult& result);
bool ReadCellLine(const std::string& line, std::string& key, CellResult& result);

}  // namespace contour
