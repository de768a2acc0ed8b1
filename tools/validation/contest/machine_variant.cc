#include "tools/validation/contest/machine_variant.h"

#include <charconv>
#include <sstream>

#include "config/config_error.h"

namespace contour {
namespace {

constexpr std::string_view kEveryAxis = "axes.*.";

std::vector<std::string> ForEveryAxis(const YamlValue& file, const std::string& assignment) {
  const std::size_t star = assignment.substr(0, assignment.find('=')).find(kEveryAxis);
  if (star == std::string::npos) return {assignment};
  const YamlEntry* axes = file.Find("axes");
  if (axes == nullptr) throw ConfigError({assignment + ": the machine file has no axes"});
  std::vector<std::string> out;
  for (const YamlEntry& axis : axes->value.entries)
    out.push_back(assignment.substr(0, star) + "axes." + axis.key + "." +
                  assignment.substr(star + kEveryAxis.size()));
  return out;
}

std::string Scaled(const YamlValue& file, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0 || assignment[equals - 1] != '*') return assignment;
  const std::string key = assignment.substr(0, equals - 1);
  double factor = 0.0;
  const char* end = assignment.data() + assignment.size();
  const auto read = std::from_chars(assignment.data() + equals + 1, end, factor);
  if (read.ec != std::errc{} || read.ptr != end)
    throw ConfigError({assignment + ": the factor is no number"});
  char text[32];
  const auto written = std::to_chars(text, text + sizeof text, NumberAt(file, key) * factor);
  return key + "=" + std::string(text, written.ptr);
}

}  // namespace

double NumberAt(const YamlValue& machine_file, const std::string& dotted_key) {
  const YamlValue* at = &machine_file;
  std::istringstream parts(dotted_key);
  for (std::string part; std::getline(parts, part, '.');) {
    const YamlEntry* entry = at->Find(part);
    if (entry == nullptr) throw ConfigError({dotted_key + ": the machine file does not state it"});
    at = &entry->value;
  }
  double value = 0.0;
  const char* end = at->text.data() + at->text.size();
  const auto read = std::from_chars(at->text.data(), end, value);
  if (read.ec != std::errc{} || read.ptr != end)
    throw ConfigError({at->where + ": " + dotted_key + ": found " + at->Describe() + ", expected a number"});
  return value;
}

std::vector<std::string> ExpandAssignments(const YamlValue& machine_file,
                                           const std::vector<std::string>& assignments) {
  std::vector<std::string> out;
  for (const std::string& assignment : assignments)
    for (const std::string& one : ForEveryAxis(machine_file, assignment))
      out.push_back(Scaled(machine_file, one));
  return out;
}

}  // namespace contour
