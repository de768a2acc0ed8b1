#include "analysis/diagnosis/report/extended_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <vector>

#include "analysis/axis_model/read_stated_axis.h"
#include "analysis/diagnosis/causes/extensions_of.h"
#include "config/load_machine.h"
#include "config/yaml_reader.h"
#include "config/yaml_writer.h"

namespace contour::diagnosis {
namespace {

/// Line of a `file:line`, counted from 1.
std::size_t LineOf(const std::string& where) {
  std::size_t line = 0;
  const std::size_t colon = where.rfind(':');
  if (colon != std::string::npos)
    std::from_chars(where.data() + colon + 1, where.data() + where.size(), line);
  return line;
}

std::size_t LastLine(const YamlValue& value) {
  std::size_t last = LineOf(value.where);
  for (const YamlValue& item : value.items) last = std::max(last, LastLine(item));
  for (const YamlEntry& e : value.entries) last = std::max({last, LineOf(e.where), LastLine(e.value)});
  return last;
}

std::vector<std::string> LinesOf(const std::string& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// The block `extensions:` of a model whose keys begin `indent` columns in.
std::string Block(const ExtensionsConfig& extensions, std::size_t indent) {
  const std::string indentation(indent, ' ');
  std::string out = indentation + "extensions:              # found by contour diagnose\n";
  std::istringstream body(WriteYaml(extensions));
  for (std::string line; std::getline(body, line);) out += indentation + "  " + line + "\n";
  return out;
}

/// `model` is a map in block style, its keys on lines of their own; its old extensions are removed.
std::string Inserted(const std::string& file, const YamlValue& model, const ExtensionsConfig& extensions) {
  std::vector<std::string> lines = LinesOf(file);
  const std::size_t first = LineOf(model.entries.front().where);
  const std::size_t indent = lines[first - 1].find_first_not_of(' ');
  std::size_t after = LastLine(model);
  if (const YamlEntry* old = model.Find("extensions")) {
    const std::size_t from = LineOf(old->where) - 1;
    const std::size_t to = std::max(LastLine(old->value), from + 1);
    lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(from),
                lines.begin() + static_cast<std::ptrdiff_t>(to));
    after = after >= to ? after - (to - from) : from;
  }
  std::string out;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    out += lines[i] + "\n";
    if (i + 1 == after) out += Block(extensions, indent);
  }
  return out;
}

/// A flow map or list may go on for lines that hold no key of their own.
bool BlockStyle(const std::string& file, const YamlValue& model) {
  const std::vector<std::string> lines = LinesOf(file);
  for (const YamlEntry& e : model.entries) {
    const std::size_t at = LineOf(e.where);
    if (at == 0 || at > lines.size()) return false;
    const std::string& line = lines[at - 1];
    const std::size_t start = line.find_first_not_of(' ');
    if (start == std::string::npos || line.compare(start, e.key.size() + 1, e.key + ":") != 0) return false;
  }
  const std::string& last = lines[LastLine(model) - 1];
  return std::count(last.begin(), last.end(), '{') <= std::count(last.begin(), last.end(), '}') &&
         std::count(last.begin(), last.end(), '[') <= std::count(last.begin(), last.end(), ']');
}

}  // namespace

std::string ExtendedFile(const std::string& file, const std::string& axis, const Diagnosis& found,
                         const AxisLog& log) {
  if (log.linear) return "";
  if (std::none_of(found.causes.begin(), found.causes.end(),
                   [](const Cause& c) { return CanExtend(c.kind); }))
    return "";
  const YamlValue tree = ParseYamlFile(file);
  const YamlValue* model = &tree;
  ModelConfig alone;
  const YamlEntry* axes = tree.Find("axes");
  if (axes != nullptr) {
    const MachineConfig machine = LoadMachine(file);
    const std::string name = axis.empty() ? machine.axes.begin()->first : axis;
    model = &axes->value.Find(name)->value.Find("model")->value;
    alone = machine.axes.at(name).model;
  } else if (const YamlEntry* entry = tree.Find("model")) {
    model = &entry->value;
  }
  ExtensionsConfig extensions = alone.extensions;
  if (axes == nullptr)
    if (const YamlEntry* old = model->Find("extensions")) {
      std::vector<std::string> errors;
      ReadYaml(old->value, extensions, "extensions", errors);
    }
  AddCauses(found.causes, TemperatureOf(log).first_degC, extensions);
  if (model->kind == YamlValue::Kind::kMap && !model->entries.empty() && BlockStyle(file, *model))
    return Inserted(file, *model, extensions);
  if (axes == nullptr) return "";
  alone.extensions = extensions;
  return "# model of " + file + " with what contour diagnose found\n" + WriteYaml(alone);
}

}  // namespace contour::diagnosis
