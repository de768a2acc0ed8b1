#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "daemon/program/gcode/block.h"

namespace contour {

/// Largest number of a tool, as LinuxCNC has it.
inline constexpr double kMostTools = 99999.0;

/// What G43 adds for each tool.
struct ToolTable {
  std::string name;                       ///< of the file, for messages
  std::map<int, AxisValues> offsets_m{};  ///< by tool number: X Y Z U V W

  /// Of a tool; tool 0 is none, and has no length. Null: it is not in the table.
  [[nodiscard]] const AxisValues* Find(int tool) const;
};

/// Whether a program has a G43 in it, be it in a comment.
[[nodiscard]] bool AsksForLengths(std::string_view program);

/// Reads a table of tools as LinuxCNC writes it: a tool a line, `T1 P1 Z42.5 D6 ;end mill`, lengths in
/// millimetres (LinuxCNC's are in the machine's units). T is required; P (pocket), D, I, J and Q (diameter,
/// angles, orientation) are read and not used, and A, B and C have to be 0. Throws ProgramError with file and
/// line for anything else, for a letter that comes twice in a line, and for a tool that is there twice.
ToolTable ParseToolTable(std::string_view text, const std::string& name);

/// The table of a plain file; an empty name: none. Throws ProgramError.
std::shared_ptr<const ToolTable> LoadToolTable(const std::filesystem::path& file);

}  // namespace contour
