#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace contour {

struct YamlEntry;

/// One value of a YAML file with the place it came from. Unlike the parser's own nodes it keeps duplicate
/// keys and can hold values that were given on the command line.
struct YamlValue {
  enum class Kind { kNull, kScalar, kSequence, kMap };

  Kind kind = Kind::kNull;
  std::string text;     ///< scalars: as written, without quotes
  bool quoted = false;  ///< scalars: in quotes, therefore text whatever it looks like
  std::string where;    ///< "file:line" or "--set key=value"
  std::vector<YamlValue> items;
  std::vector<YamlEntry> entries;  ///< in file order

  [[nodiscard]] const YamlEntry* Find(std::string_view key) const;  ///< first of that name, or null
  [[nodiscard]] YamlEntry* Find(std::string_view key);
  /// Short description for messages: `'abc' (text)`, `a list`, `nothing`.
  [[nodiscard]] std::string Describe() const;
};

struct YamlEntry {
  std::string key;
  std::string where;
  YamlValue value;
};

/// A whole file. Throws ConfigError when it cannot be read.
std::string ReadTextFile(const std::string& path);

/// Reads a file. Throws ConfigError when it cannot be read, is not YAML, or is not a map at the top.
YamlValue ParseYamlFile(const std::string& path);

/// The same from memory; `name` stands for the file in messages.
YamlValue ParseYamlText(const std::string& text, const std::string& name);

/// Applies `dotted.key=value` (the value is YAML) on top of the tree, adding maps and keys as needed.
/// Whether the key means anything is found out when the tree is read; messages then name `--set`.
/// Throws ConfigError when it does not have that form or leads through something that is not a map.
void ApplyOverride(YamlValue& root, const std::string& assignment);

/// Where a dotted key (or the deepest existing part of it) was written; for problems found after reading.
std::string WhereIs(const YamlValue& root, std::string_view dotted_key);
/// Messages that begin with their dotted key, behind where it is written.
std::vector<std::string> WithPlaces(const YamlValue& root, const std::vector<std::string>& messages);

}  // namespace contour
