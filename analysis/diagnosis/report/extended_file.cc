#include "analysis/diagnosis/report/extended_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string_view>
#include <vector>

#include "analysis/axis_model/extension_keys.h"
#include "analysis/axis_model/fitted_config.h"
#include "analysis/axis_model/read_stated_axis.h"
#include "analysis/diagnosis/causes/extensions_of.h"
#include "config/load_machine.h"
#include "config/number_text.h"
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

/// Text, `indent` columns in.
std::string Indented(const std::string& text, std::size_t indent) {
  std::string out;
  std::istringstream body(text);
  for (std::string line; std::getline(body, line);) out += std::string(indent, ' ') + line + "\n";
  return out;
}

/// The block `extensions:` of a model whose keys begin `indent` columns in.
std::string Block(const ExtensionsConfig& extensions, std::size_t indent) {
  return std::string(indent, ' ') + "extensions:              # found by contour diagnose\n" +
         Indented(WriteYaml(extensions), indent + 2);
}

std::string UncertaintyBlock(const std::map<std::string, double>& uncertainty, std::size_t indent) {
  std::string text;
  for (const auto& [key, sigma] : uncertainty) text += key + ": " + NumberText(sigma) + "\n";
  return std::string(indent, ' ') + "uncertainty:             # as the log has it, one standard deviation\n" +
         Indented(text, indent + 2);
}

/// The value of a key on a line, whether it stands there alone or among others.
void ReplaceNumber(std::string& line, const std::string& key, const std::string& number) {
  for (std::size_t at = line.find(key + ":"); at != std::string::npos; at = line.find(key + ":", at + 1)) {
    if (at > 0 && line[at - 1] != ' ' && line[at - 1] != '{' && line[at - 1] != ',') continue;
    const std::size_t from = line.find_first_not_of(' ', at + key.size() + 1);
    if (from == std::string::npos) return;
    const std::size_t to = std::min(line.find_first_of(",} #", from), line.size());
    line.replace(from, to - from, number);
    return;
  }
}

/// Numbers that `now` has others of.
void ReplaceNumbers(const YamlValue& before, const YamlValue& now, std::vector<std::string>& lines) {
  for (const YamlEntry& e : before.entries) {
    const YamlEntry* other = now.Find(e.key);
    if (other == nullptr || e.key == "extensions" || e.key == "uncertainty") continue;
    ReplaceNumbers(e.value, other->value, lines);
    const std::size_t line = LineOf(e.where);
    if (e.value.kind == YamlValue::Kind::kScalar && e.value.text != other->value.text && line > 0 &&
        line <= lines.size())
      ReplaceNumber(lines[line - 1], e.key, other->value.text);
  }
}

/// Takes an entry's lines out; `after` is a line behind which something is to be put.
void Remove(const YamlValue& model, std::string_view key, std::vector<std::string>& lines,
            std::size_t& after) {
  const YamlEntry* old = model.Find(key);
  if (old == nullptr) return;
  const std::size_t from = LineOf(old->where) - 1;
  const std::size_t to = std::max(LastLine(old->value), from + 1);
  // Numbers of lines stay those of the file: what is removed is empty, and passed over at the end.
  for (std::size_t i = from; i < to; ++i) lines[i] = "\n";
  if (after == to) after = from;
}

/// `model` is a map in block style, its keys on lines of their own; its old extensions are removed. `now`:
/// the numbers that it has from here on; null: its own.
std::string Inserted(const std::string& file, const YamlValue& model, const ExtensionsConfig& extensions,
                     const ModelConfig* now) {
  std::vector<std::string> lines = LinesOf(file);
  const std::size_t first = LineOf(model.entries.front().where);
  const std::size_t indent = lines[first - 1].find_first_not_of(' ');
  std::size_t after = LastLine(model);
  Remove(model, "extensions", lines, after);
  if (now != nullptr) {
    Remove(model, "uncertainty", lines, after);
    ReplaceNumbers(model, ParseYamlText(WriteYaml(*now), "fitted"), lines);
  }
  std::string out;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i] != "\n") out += lines[i] + "\n";
    if (i + 1 != after) continue;
    if (now != nullptr) out += UncertaintyBlock(now->uncertainty, indent);
    const std::string block = Block(extensions, indent);
    if (block.find('\n') + 1 < block.size()) out += block;
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

/// What the number is that a cause adds: for those who read the file.
std::string Sizes(const std::vector<Cause>& causes) {
  std::string out;
  for (const Cause& c : causes) {
    if (!CanExtend(c.kind)) continue;
    out += "#   " + c.kind + ":";
    for (const auto& [name, p] : c.parameters)
      out += " " + name + " " + RoundedText(p.value) + " (" + RoundedText(p.low) + " to " +
             RoundedText(p.high) + ")";
    out += "\n";
  }
  return out.empty() ? out : "# Causes that were fitted with the numbers, with their 95 % intervals:\n" + out;
}

/// Numbers that extensions stood for are in the fitted ones already.
void DropNumbers(ExtensionsConfig& e) {
  e.asymmetric_coulomb.reset();
  e.stribeck.reset();
  e.compliance.reset();
}

/// A model alone, written anew with the fitted numbers.
std::string FittedLooseFile(const std::string& file, const Diagnosis& found, const AxisLog& log) {
  YamlValue tree = ParseYamlFile(file);
  LooseAxisFile content = ReadLooseFile(tree);
  const YamlEntry* entry = tree.Find("model");
  const ExtensionUnits units = UnitsOf(entry != nullptr ? entry->value : tree);
  ExtensionsConfig& e = content.model.extensions;
  if (!e.torque_constant) {
    DropNumbers(e);
    e.input_delay.reset();
    e.current_lag.reset();
    e.constant_torque.reset();
    IntoConfig(*found.fitted, content);
  }
  AddCauses(found.in_model, TemperatureOf(log).first_degC, e);
  return "# Written by contour diagnose from " + log.source + "\n# and the model " + file +
         ".\n# uncertainty: relative, one standard deviation, as the log has it.\n" +
         RenamedToFile(units, Sizes(found.in_model)) + TextOf(content, units);
}

}  // namespace

std::string ExtendedFile(const std::string& file, const std::string& axis, const Diagnosis& found,
                         const AxisLog& log) {
  const std::vector<Cause>& causes = found.fitted ? found.in_model : found.causes;
  if (!found.fitted && (log.linear || std::none_of(causes.begin(), causes.end(),
                                                   [](const Cause& c) { return CanExtend(c.kind); })))
    return "";
  const YamlValue tree = ParseYamlFile(file);
  const YamlValue* model = &tree;
  ModelConfig alone;
  const YamlEntry* axes = tree.Find("axes");
  if (axes == nullptr && found.fitted) return FittedLooseFile(file, found, log);
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
  // Behind a torque constant of their own the numbers are not those of the file.
  const bool numbers = found.fitted && axes != nullptr && !extensions.torque_constant;
  if (numbers) {
    DropNumbers(extensions);
    IntoConfig(*found.fitted, alone);
    // The only place that a machine file has for it.
    if (extensions.constant_torque) extensions.constant_torque->torque_Nm = FiveDigits(found.fitted->offset);
  }
  AddCauses(causes, TemperatureOf(log).first_degC, extensions);
  if (model->kind == YamlValue::Kind::kMap && !model->entries.empty() && BlockStyle(file, *model))
    return Inserted(file, *model, extensions, numbers ? &alone : nullptr);
  if (axes == nullptr) return "";
  alone.extensions = extensions;
  return "# model of " + file + " with what contour diagnose found\n" + WriteYaml(alone);
}

}  // namespace contour::diagnosis
