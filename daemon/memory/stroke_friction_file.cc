#include "daemon/memory/stroke_friction_file.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "config/whole_file.h"
#include "config/yaml_reader.h"
#include "config/yaml_tree.h"
#include "config/yaml_writer.h"
#include "drivers/lcm/crc32c.h"

namespace contour {
namespace {

namespace fs = std::filesystem;

constexpr int kFormat = 1;
constexpr std::string_view kChecksumKey = "crc32c: ";
/// Friction that is less than half or more than twice its mean somewhere on the stroke is a damaged screw, or
/// a damaged map.
constexpr double kLeast = 0.5;
constexpr double kMost = 2.0;

/// The file. Lists have one number per step.
struct Content {
  int format = kFormat;
  std::string machine;
  std::string axis;
  std::array<double, 2> stroke_mm{};
  double lead_mm = 0.0;
  double encoder_counts_per_rev = 0.0;
  std::vector<double> forward, backward, forward_passes, backward_passes;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("format", format, kAny, "of this file");
    v.Required("machine", machine, "its name");
    v.Required("axis", axis, "its name");
    v.Required("stroke_mm", stroke_mm, kAny, "limits of the axis");
    v.Required("lead_mm", lead_mm, kPositive, "of its screw");
    v.Required("encoder_counts_per_rev", encoder_counts_per_rev, kPositive, "of its motor");
    v.Required("forward", forward, kAny, "steps of the logarithm of the friction level from piece to piece");
    v.Required("backward", backward, kAny, "the same, found in the other direction of motion");
    v.Required("forward_passes", forward_passes, kNotNegative, "how often");
    v.Required("backward_passes", backward_passes, kNotNegative, "how often");
  }
};

Content ContentOf(const MappedAxis& axis) {
  Content c;
  c.machine = axis.machine;
  c.axis = axis.axis;
  c.stroke_mm = {1e3 * axis.stroke.lowest_m, 1e3 * axis.stroke.highest_m};
  c.lead_mm = 1e3 * axis.stroke.lead_m;
  c.encoder_counts_per_rev = axis.encoder_counts_per_rev;
  return c;
}

std::string ChecksumOf(std::string_view text) {
  std::array<char, 16> hex{};
  std::snprintf(hex.data(), hex.size(), "\"%08x\"", Crc32c(text));
  return hex.data();
}

std::string Read(const fs::path& file, const MappedAxis& axis, std::vector<StrokeFriction::Step>& steps) {
  const std::string text = ReadTextFile(file.string());
  const std::size_t last = text.rfind(kChecksumKey);
  if (last == std::string::npos || (last != 0 && text[last - 1] != '\n')) return "it is not whole";
  const std::string body = text.substr(0, last);
  if (text.substr(last) != std::string(kChecksumKey) + ChecksumOf(body) + "\n")
    return "its checksum is not that of its content";
  Content c;
  std::vector<std::string> errors;
  ReadYaml(ParseYamlText(body, file.string()), c, "", errors);
  if (!errors.empty()) return errors.front();
  const Content wanted = ContentOf(axis);
  if (c.format != wanted.format) return "it has another format";
  if (c.machine != wanted.machine || c.axis != wanted.axis) return "it was learnt on another axis";
  if (c.stroke_mm != wanted.stroke_mm || c.lead_mm != wanted.lead_mm ||
      c.encoder_counts_per_rev != wanted.encoder_counts_per_rev)
    return "the axis had another stroke, screw or encoder";
  const std::size_t n = StrokeFriction(axis.stroke).steps().size();
  if (c.forward.size() != n || c.backward.size() != n || c.forward_passes.size() != n ||
      c.backward_passes.size() != n)
    return "it has not one number for every step";
  steps.clear();
  for (std::size_t i = 0; i < n; ++i) {
    if (!(std::abs(c.forward[i]) <= StrokeFriction::kLargestStep) ||
        !(std::abs(c.backward[i]) <= StrokeFriction::kLargestStep))
      return "friction cannot change that much from one piece to the next";
    steps.push_back({c.forward[i], c.backward[i], c.forward_passes[i], c.backward_passes[i]});
  }
  for (const double relative : StrokeFriction(axis.stroke, steps).Relative())
    if (!(1.0 + relative >= kLeast && 1.0 + relative <= kMost))
      return "friction cannot vary that much along the stroke";
  return {};
}

}  // namespace

fs::path StrokeFrictionFile(const fs::path& directory, const MappedAxis& axis) {
  return directory / (axis.machine + "_" + axis.axis + "_friction.yaml");
}

void WriteStrokeFriction(const fs::path& file, const MappedAxis& axis,
                         const std::vector<StrokeFriction::Step>& steps) {
  Content c = ContentOf(axis);
  for (const StrokeFriction::Step& s : steps) {
    c.forward.push_back(s.forward);
    c.backward.push_back(s.backward);
    c.forward_passes.push_back(s.forward_passes);
    c.backward_passes.push_back(s.backward_passes);
  }
  const std::string body =
      "# Friction along the stroke of an axis, learnt by contourd. To forget it, remove the file.\n" +
      WriteYaml(c);
  std::error_code made;
  fs::create_directories(file.parent_path(), made);
  WriteWholeFile(file, body + std::string(kChecksumKey) + ChecksumOf(body) + "\n");
}

StrokeFrictionRead ReadStrokeFriction(const fs::path& file, const MappedAxis& axis) {
  StrokeFrictionRead out;
  try {
    out.refused = Read(file, axis, out.steps);
  } catch (const std::exception& e) {
    out.refused = e.what();
  }
  if (!out.refused.empty()) out.steps.clear();
  return out;
}

}  // namespace contour
