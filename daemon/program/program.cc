#include "daemon/program/program.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>

#include "config/yaml_reader.h"
#include "daemon/program/gcode_parser.h"

namespace contour {
namespace {

constexpr std::string_view kShapes =
    "circle, square, diamond, line, sine, hold, creep, multisine, sweep, reversals, torque_steps";

/// An entry taken out of the tree, so that the rest is the shape's own keys.
std::optional<YamlEntry> Take(YamlValue& root, std::string_view key) {
  const auto entry = std::find_if(root.entries.begin(), root.entries.end(),
                                  [&](const YamlEntry& e) { return e.key == key; });
  if (entry == root.entries.end()) return std::nullopt;
  YamlEntry taken = *entry;
  root.entries.erase(entry);
  return taken;
}

template <class Shape>
Shape Read(const YamlValue& root) {
  std::vector<std::string> errors;
  Shape shape;
  ReadYaml(root, shape, "", errors);
  if (!errors.empty()) throw ProgramError(errors);
  return shape;
}

void CheckFeed(const Feed& feed, const YamlValue& root, const std::string& name) {
  if (feed.feed_mm_min && feed.frequency_hz) {
    throw ProgramError(WhereIs(root, "frequency_hz") +
                       ": frequency_hz: feed_mm_min is given as well, expected one of the two");
  }
  if (!feed.feed_mm_min && !feed.frequency_hz) {
    throw ProgramError(name + ": feed_mm_min or frequency_hz: missing, expected one of the two");
  }
}

void CheckAxes(const PlaneAxes& axes, const YamlValue& root) {
  if (!axes.empty() && (axes.size() != 2 || axes[0] == axes[1])) {
    throw ProgramError(WhereIs(root, "axes") + ": axes: expected two different axes");
  }
}

template <class Shape>
Shape ReadPlane(const YamlValue& root, const std::string& name) {
  Shape shape = Read<Shape>(root);
  CheckFeed(shape.feed, root, name);
  CheckAxes(shape.axes, root);
  return shape;
}

template <class Shape>
Shape ReadPolygon(const YamlValue& root, const std::string& name) {
  for (const YamlEntry& entry : root.entries) {
    if (entry.key == "corners" && entry.value.text == "continuous")
      throw ProgramError(entry.where +
                         ": corners: continuous is velocity_jump now, an experiment beyond the axes' limits; "
                         "without corners they are blended within the machine's path_tolerance_mm");
  }
  auto shape = ReadPlane<Shape>(root, name);
  if (shape.corners && shape.corner_tolerance_mm) {
    throw ProgramError(WhereIs(root, "corner_tolerance_mm") +
                       ": corner_tolerance_mm: corners is given as well, expected one of the two");
  }
  return shape;
}

LineShape ReadLine(const YamlValue& root, const std::string& name) {
  auto shape = Read<LineShape>(root);
  CheckAxes(shape.axes, root);
  if (shape.dx_mm == 0.0 && shape.dy_mm == 0.0) {
    throw ProgramError(name + ": dx_mm, dy_mm: both are zero, expected a line with a length");
  }
  return shape;
}

SineShape ReadSine(const YamlValue& root, const std::string& name) {
  auto shape = Read<SineShape>(root);
  CheckFeed(shape.feed, root, name);
  return shape;
}

CreepShape ReadCreep(const YamlValue& root) {
  auto shape = Read<CreepShape>(root);
  if (shape.velocities_mm_s.empty()) {
    throw ProgramError(WhereIs(root, "velocities_mm_s") + ": velocities_mm_s: expected at least one speed");
  }
  if (shape.stroke_mm == 0.0) {
    throw ProgramError(WhereIs(root, "stroke_mm") + ": stroke_mm: found 0, expected a way");
  }
  return shape;
}

template <class Shape>
Shape ReadBand(const YamlValue& root) {
  auto shape = Read<Shape>(root);
  if (!(shape.frequency_max_hz > shape.frequency_min_hz)) {
    throw ProgramError(WhereIs(root, "frequency_max_hz") +
                       ": frequency_max_hz: expected more than frequency_min_hz");
  }
  return shape;
}

ReversalsShape ReadReversals(const YamlValue& root) {
  auto shape = Read<ReversalsShape>(root);
  if (shape.amplitudes_mm.empty()) {
    throw ProgramError(WhereIs(root, "amplitudes_mm") + ": amplitudes_mm: expected at least one amplitude");
  }
  return shape;
}

TorqueStepsShape ReadTorqueSteps(const YamlValue& root) {
  auto shape = Read<TorqueStepsShape>(root);
  if (shape.torques_Nm.empty()) {
    throw ProgramError(WhereIs(root, "torques_Nm") + ": torques_Nm: expected at least one torque");
  }
  for (const double torque_Nm : shape.torques_Nm) {
    if (torque_Nm == 0.0)
      throw ProgramError(WhereIs(root, "torques_Nm") + ": torques_Nm: found 0, expected a torque");
  }
  return shape;
}

TorqueSignal ReadTorque(const YamlEntry& entry) {
  std::vector<std::string> errors;
  TorqueSignal signal;
  ReadYaml(entry.value, signal, "torque", errors);
  if (!errors.empty()) throw ProgramError(errors);
  const std::string where = entry.where + ": torque: ";
  if (signal.kind == TorqueSignalKind::kPulses) {
    if (!(4.0 * signal.width_s <= signal.period_s))
      throw ProgramError(where + "four times width_s does not fit into period_s");
  } else if (!(signal.frequency_min_hz > 0.0) || !(signal.frequency_max_hz > signal.frequency_min_hz)) {
    throw ProgramError(where + "expected frequency_min_hz and a higher frequency_max_hz");
  }
  signal.highest_where = WhereIs(entry.value, "frequency_max_hz");
  return signal;
}

Program ReadProgram(YamlValue root, const std::string& name);

std::vector<Program> ReadParts(const YamlEntry& entry, const std::string& name) {
  if (entry.value.kind != YamlValue::Kind::kSequence || entry.value.items.empty()) {
    throw ProgramError(entry.where + ": " + entry.key + ": found " + entry.value.Describe() +
                       ", expected a list of programs");
  }
  std::vector<Program> parts;
  for (const YamlValue& item : entry.value.items) {
    if (item.kind != YamlValue::Kind::kMap) {
      throw ProgramError(item.where + ": " + entry.key + ": found " + item.Describe() +
                         ", expected a program with a shape");
    }
    parts.push_back(ReadProgram(item, item.where.empty() ? name : item.where));
  }
  return parts;
}

/// `repeats:` of a sequence, all that may stand beside its list.
struct SequenceKeys {
  int repeats = 1;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("repeats", repeats, kPolygonCount, "how often to go through the list");
  }
};

struct NoKeys {
  template <class Visitor>
  void Visit(Visitor&) {}
};

Program ReadShape(const YamlEntry& entry, const YamlValue& root, const std::string& name) {
  const std::string& shape = entry.value.text;
  if (shape == "circle") return {name, ReadPlane<CircleShape>(root, name)};
  if (shape == "square") return {name, ReadPolygon<SquareShape>(root, name)};
  if (shape == "diamond") return {name, ReadPolygon<DiamondShape>(root, name)};
  if (shape == "line") return {name, ReadLine(root, name)};
  if (shape == "sine") return {name, ReadSine(root, name)};
  if (shape == "hold") return {name, Read<HoldShape>(root)};
  if (shape == "creep") return {name, ReadCreep(root)};
  if (shape == "multisine") return {name, ReadBand<MultisineShape>(root)};
  if (shape == "sweep") return {name, ReadBand<SweepShape>(root)};
  if (shape == "reversals") return {name, ReadReversals(root)};
  if (shape == "torque_steps") return {name, ReadTorqueSteps(root)};
  throw ProgramError(entry.where + ": shape: found " + entry.value.Describe() + ", expected one of " +
                     std::string(kShapes));
}

/// A program or a part of one: `shape:` with its keys, `sequence:` or `together:`; each with a `torque:`.
Program ReadProgram(YamlValue root, const std::string& name) {
  const std::optional<YamlEntry> torque = Take(root, "torque");
  const std::optional<YamlEntry> sequence = Take(root, "sequence");
  const std::optional<YamlEntry> together = Take(root, "together");
  const std::optional<YamlEntry> shape = Take(root, "shape");
  if (sequence.has_value() + together.has_value() + shape.has_value() > 1)
    throw ProgramError((shape ? *shape : *together).where +
                       ": expected only one of shape, sequence and together");
  Program program;
  if (sequence) {
    program = {name, SequenceShape{ReadParts(*sequence, name), Read<SequenceKeys>(root).repeats}};
  } else if (together) {
    Read<NoKeys>(root);
    program = {name, TogetherShape{ReadParts(*together, name)}};
  } else if (shape) {
    program = ReadShape(*shape, root, name);
  } else {
    throw ProgramError(name + ": shape: missing, expected one of " + std::string(kShapes));
  }
  if (torque) program.torque = ReadTorque(*torque);
  return program;
}

Program ParseYaml(std::string_view text, const std::string& name) {
  return ReadProgram(ParseYamlText(std::string(text), name), name);
}

}  // namespace

Program ParseProgram(std::string_view text, const std::string& name, ProgramFormat format) {
  if (format == ProgramFormat::kGcode) return {name, ParseGcode(text, name)};
  try {
    return ParseYaml(text, name);
  } catch (const ProgramError&) {
    throw;
  } catch (const ConfigError& e) {
    throw ProgramError(e.messages());
  }
}

ProgramFormat FormatOf(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  constexpr std::string_view kGcode[] = {".ngc", ".nc", ".cnc", ".gcode", ".gc", ".tap"};
  const bool gcode = std::find(std::begin(kGcode), std::end(kGcode), extension) != std::end(kGcode);
  return gcode ? ProgramFormat::kGcode : ProgramFormat::kYaml;
}

std::string ReadProgramText(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (std::filesystem::is_directory(file) || !in) throw ProgramError(file.string() + ": cannot be read");
  std::string text;
  std::error_code no_size;  // of a pipe
  if (const std::uintmax_t bytes = std::filesystem::file_size(file, no_size); !no_size) text.reserve(bytes);
  std::array<char, 65536> block{};
  do {
    in.read(block.data(), block.size());
    text.append(block.data(), static_cast<std::size_t>(in.gcount()));
  } while (in);
  if (in.bad()) throw ProgramError(file.string() + ": cannot be read");
  return text;
}

Program LoadProgram(const std::filesystem::path& file) {
  return ParseProgram(ReadProgramText(file), file.string(), FormatOf(file));
}

}  // namespace contour
