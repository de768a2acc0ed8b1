#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/program/shapes.h"

namespace contour {

struct ToolTable;

struct GcodeSettings {
  bool block_delete = true;  ///< leave lines out that begin with a slash, as LinuxCNC does unless told
  /// Where program zero is in the machine's coordinates, for X Y Z U V W; nothing: the machine is not
  /// referenced, and G28, G30 and G53 are refused.
  std::optional<std::array<double, 6>> zero_m;
  /// Where the machine stands when the program starts, from program zero.
  std::array<double, 6> start_m{};
  /// G64 Q joins no move of this line or a later one with one of the lines before.
  int begins_at_line = 0;
  /// For G43: a table, or else the file that one is read from at the first of them. Neither: no tool has a
  /// length that is known.
  std::shared_ptr<const ToolTable> tools{};
  std::string tool_table{};
  bool joins_lines = true;  ///< false: G64 Q joins nothing
};

/// Reads RS-274 G-code as docs/programs.md lists it. `name` stands for the file in messages.
/// Throws ProgramError, with line and column, for anything else.
GcodeMoves ParseGcode(std::string_view text, const std::string& name, const GcodeSettings& settings = {});

/// The same as canonical moves, one a line: what the program asks for, whatever its modal words. Millimetres
/// from program zero.
std::string CanonicalText(std::string_view text, const std::string& name, const GcodeSettings& settings = {});

}  // namespace contour
