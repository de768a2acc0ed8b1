#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "daemon/program/shapes.h"

namespace contour {

enum class ProgramFormat { kYaml, kGcode };

/// A program that cannot be read or cannot run on this machine. what() is one line, beginning with the file
/// and, where there is one, the line.
class ProgramError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What is to be drawn, in its own coordinates: it begins wherever the machine stands when it starts.
struct Program {
  std::string name;  ///< file or other origin, for messages and metrics.json
  std::variant<CircleShape, SquareShape, DiamondShape, LineShape, SineShape, HoldShape, CreepShape,
               MultisineShape, SweepShape, GcodeMoves>
      shape;
};

/// Reads a program from text; `name` stands for the file in messages. Throws ProgramError.
Program ParseProgram(std::string_view text, const std::string& name, ProgramFormat format);

/// Reads a program from a file: G-code when the name ends in .ngc, .nc or .gcode, YAML otherwise.
/// Throws ProgramError.
Program LoadProgram(const std::filesystem::path& file);

/// The format that LoadProgram takes a file of this name for.
ProgramFormat FormatOf(const std::filesystem::path& file);

}  // namespace contour
