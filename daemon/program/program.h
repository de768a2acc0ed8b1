#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "config/config_error.h"
#include "daemon/program/shapes.h"

namespace contour {

enum class ProgramFormat { kYaml, kGcode };

/// A program that cannot be read or cannot run on this machine. Each message is one line and begins with the
/// file and, where there is one, the line.
class ProgramError : public ConfigError {
 public:
  explicit ProgramError(const std::string& message) : ConfigError({message}) {}
  explicit ProgramError(std::vector<std::string> messages) : ConfigError(std::move(messages)) {}
};

/// What is to be drawn, in its own coordinates: it begins wherever the machine stands when it starts.
struct Program {
  std::string name;  ///< file or other origin, for messages and metrics.json
  std::variant<CircleShape, SquareShape, DiamondShape, LineShape, SineShape, HoldShape, CreepShape,
               MultisineShape, SweepShape, ReversalsShape, TorqueStepsShape, SequenceShape, TogetherShape,
               GcodeMoves>
      shape;
  std::optional<TorqueSignal> torque{};  ///< added while it runs
};

/// Reads a program from text; `name` stands for the file in messages. Throws ProgramError.
Program ParseProgram(std::string_view text, const std::string& name, ProgramFormat format);

/// A file's text. Throws ProgramError.
std::string ReadProgramText(const std::filesystem::path& file);

/// Reads a program from a file, in the format of its name. Throws ProgramError.
Program LoadProgram(const std::filesystem::path& file);

/// G-code when the name ends in .ngc, .nc, .cnc, .gcode, .gc or .tap, in small letters or capitals, YAML
/// otherwise.
ProgramFormat FormatOf(const std::filesystem::path& file);

}  // namespace contour
