#include "config/axis_block.h"

#include <cstddef>
#include <sstream>
#include <vector>

#include "config/config_error.h"
#include "config/yaml_tree.h"

namespace contour {
namespace {

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// Of "file:line", from 0.
std::size_t LineOf(const YamlEntry& entry) {
  return std::stoul(entry.where.substr(entry.where.rfind(':') + 1)) - 1;
}

std::size_t Indent(const std::string& line) { return line.find_first_not_of(' '); }

/// Nothing but a comment, or nothing.
bool SaysNothing(const std::string& line) {
  const std::size_t at = Indent(line);
  return at == std::string::npos || line[at] == '#';
}

/// One past the last line that belongs to the key on `first`; comments and gaps after it do not.
std::size_t EndOf(const std::vector<std::string>& lines, std::size_t first) {
  const std::size_t indent = Indent(lines[first]);
  std::size_t end = first + 1;
  for (std::size_t i = first + 1; i < lines.size(); ++i) {
    if (SaysNothing(lines[i])) continue;
    if (Indent(lines[i]) <= indent) break;
    end = i + 1;
  }
  return end;
}

}  // namespace

std::string WithAxisBlock(const std::string& text, const std::string& name, const std::string& axis,
                          const std::string& key, const std::string& block) {
  const YamlValue tree = ParseYamlText(text, name);
  const YamlEntry* axes = tree.Find("axes");
  const YamlEntry* found = axes == nullptr ? nullptr : axes->value.Find(axis);
  if (found == nullptr) throw ConfigError({name + ": axes." + axis + ": missing, expected this axis"});
  std::vector<std::string> lines = Lines(text);
  const std::size_t at = LineOf(*found);
  const std::size_t first = found->value.entries.empty() ? at : LineOf(found->value.entries.front());
  if (first <= at || first >= lines.size())
    throw ConfigError({found->where + ": axes." + axis +
                       ": found a map on one line, expected one key a line to put '" + key + "' there"});
  const std::size_t indent = Indent(lines[first]);

  std::vector<std::string> put{std::string(indent, ' ') + key + ":"};
  for (const std::string& line : Lines(block)) put.push_back(std::string(indent + 2, ' ') + line);
  std::size_t from = EndOf(lines, at), to = from;
  if (const YamlEntry* old = found->value.Find(key)) {
    from = LineOf(*old);
    to = EndOf(lines, from);
  }
  const auto begin = lines.begin();
  lines.erase(begin + static_cast<std::ptrdiff_t>(from), begin + static_cast<std::ptrdiff_t>(to));
  lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(from), put.begin(), put.end());
  std::string out;
  for (const std::string& line : lines) out += line + "\n";
  return out;
}

}  // namespace contour
