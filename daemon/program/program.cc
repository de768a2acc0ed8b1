#include "daemon/program/program.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "config/yaml_reader.h"
#include "daemon/program/gcode_parser.h"

namespace contour {
namespace {

constexpr std::string_view kShapes = "circle, square, diamond, line, sine, hold, creep, multisine, sweep";

/// The value of `shape`, taken out of the tree, so that the rest is the shape's own keys.
YamlEntry TakeShape(YamlValue& root, const std::string& name) {
  const auto entry = std::find_if(root.entries.begin(), root.entries.end(),
                                  [](const YamlEntry& e) { return e.key == "shape"; });
  if (entry == root.entries.end()) {
    throw ProgramError(name + ": shape: missing, expected one of " + std::string(kShapes));
  }
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

Program ParseYaml(std::string_view text, const std::string& name) {
  YamlValue root = ParseYamlText(std::string(text), name);
  const YamlEntry entry = TakeShape(root, name);
  const std::string& shape = entry.value.text;
  if (shape == "circle") return {name, ReadPlane<CircleShape>(root, name)};
  if (shape == "square") return {name, ReadPlane<SquareShape>(root, name)};
  if (shape == "diamond") return {name, ReadPlane<DiamondShape>(root, name)};
  if (shape == "line") return {name, ReadLine(root, name)};
  if (shape == "sine") return {name, ReadSine(root, name)};
  if (shape == "hold") return {name, Read<HoldShape>(root)};
  if (shape == "creep") return {name, ReadCreep(root)};
  if (shape == "multisine") return {name, ReadBand<MultisineShape>(root)};
  if (shape == "sweep") return {name, ReadBand<SweepShape>(root)};
  if (shape == "torque_steps") {
    throw ProgramError(entry.where +
                       ": shape: torque_steps needs torque set-points, but programs carry positions only");
  }
  throw ProgramError(entry.where + ": shape: found " + entry.value.Describe() + ", expected one of " +
                     std::string(kShapes));
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
  const std::string extension = file.extension().string();
  const bool gcode = extension == ".ngc" || extension == ".nc" || extension == ".gcode";
  return gcode ? ProgramFormat::kGcode : ProgramFormat::kYaml;
}

Program LoadProgram(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::stringstream text;
  if (std::filesystem::is_directory(file) || !in || !(text << in.rdbuf())) {
    throw ProgramError(file.string() + ": cannot be read");
  }
  return ParseProgram(text.str(), file.string(), FormatOf(file));
}

}  // namespace contour
