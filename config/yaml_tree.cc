#include "config/yaml_tree.h"

#include <yaml-cpp/yaml.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include "config/config_error.h"

namespace contour {
namespace {

// Far beyond any machine file; they stop aliases that contain themselves or multiply.
constexpr int kMaxDepth = 32;
constexpr std::size_t kMaxNodes = 200000;
constexpr std::size_t kMaxBytes = std::size_t{64} << 20;

std::string Place(const std::string& name, const YAML::Mark& mark, const std::string& fallback) {
  return mark.is_null() ? fallback : name + ":" + std::to_string(mark.line + 1);
}

class Converter {
 public:
  explicit Converter(std::string name) : name_(std::move(name)) {}

  YamlValue Convert(const YAML::Node& node, const std::string& fallback, int depth) {
    YamlValue value;
    value.where = Place(name_, node.Mark(), fallback);
    if (depth > kMaxDepth || ++nodes_ > kMaxNodes)
      throw ConfigError({value.where + ": nested too deeply or too large for a configuration"});
    if (node.IsScalar()) {
      value.kind = YamlValue::Kind::kScalar;
      value.text = node.Scalar();
      value.quoted = node.Tag() != "?" && !node.Tag().empty();
    } else if (node.IsSequence()) {
      value.kind = YamlValue::Kind::kSequence;
      for (const YAML::Node& item : node) value.items.push_back(Convert(item, value.where, depth + 1));
    } else if (node.IsMap()) {
      ConvertMap(node, value, depth);
    }
    return value;
  }

 private:
  void ConvertMap(const YAML::Node& node, YamlValue& value, int depth) {
    value.kind = YamlValue::Kind::kMap;
    for (const auto& pair : node) {
      const std::string where = Place(name_, pair.first.Mark(), value.where);
      if (!pair.first.IsScalar()) throw ConfigError({where + ": found a key that is not plain text"});
      YamlValue inner = Convert(pair.second, where, depth + 1);
      // The parser places a map at its first key; a reader looks for it where its own name stands.
      if (inner.kind != YamlValue::Kind::kScalar) inner.where = where;
      value.entries.push_back({pair.first.Scalar(), where, std::move(inner)});
    }
  }

  std::string name_;
  std::size_t nodes_ = 0;
};

YamlValue ParseDocument(const std::string& text, const std::string& name) {
  std::vector<YAML::Node> documents;
  try {
    documents = YAML::LoadAll(text);
  } catch (const YAML::Exception& e) {
    throw ConfigError({Place(name, e.mark, name) + ": not YAML: " + e.msg});
  }
  if (documents.size() > 1) throw ConfigError({name + ": found more than one YAML document, expected one"});
  if (documents.empty()) return {};
  return Converter(name).Convert(documents.front(), name + ":1", 0);
}

std::vector<std::string> SplitKey(std::string_view dotted) {
  std::vector<std::string> parts;
  while (true) {
    const std::size_t dot = dotted.find('.');
    parts.emplace_back(dotted.substr(0, dot));
    if (dot == std::string_view::npos) return parts;
    dotted.remove_prefix(dot + 1);
  }
}

// Values of --set have no line of their own: every part of them answers with the assignment.
void SetWhere(YamlValue& value, const std::string& where) {
  value.where = where;
  for (YamlValue& item : value.items) SetWhere(item, where);
  for (YamlEntry& entry : value.entries) {
    entry.where = where;
    SetWhere(entry.value, where);
  }
}

}  // namespace

const YamlEntry* YamlValue::Find(std::string_view key) const {
  for (const YamlEntry& e : entries)
    if (e.key == key) return &e;
  return nullptr;
}

YamlEntry* YamlValue::Find(std::string_view key) {
  return const_cast<YamlEntry*>(std::as_const(*this).Find(key));
}

std::string YamlValue::Describe() const {
  switch (kind) {
    case Kind::kNull:
      return "nothing";
    case Kind::kScalar: {
      const std::string shown = text.size() > 60 ? text.substr(0, 60) + "..." : text;
      return quoted ? "the text \"" + shown + "\"" : "'" + shown + "'";
    }
    case Kind::kSequence:
      return "a list of " + std::to_string(items.size());
    case Kind::kMap:
      return "a map of keys";
  }
  return "nothing";
}

YamlValue ParseYamlText(const std::string& text, const std::string& name) {
  YamlValue root = ParseDocument(text, name);
  if (root.kind != YamlValue::Kind::kMap) {
    const std::string where = root.where.empty() ? name : root.where;
    throw ConfigError({where + ": found " + root.Describe() + " at the top, expected a map of keys"});
  }
  return root;
}

std::string ReadTextFile(const std::string& path) {
  // A pipe that nobody writes to, or a device that goes on for ever, would be read for ever.
  std::error_code unknown;
  const auto status = std::filesystem::status(path, unknown);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
      !std::filesystem::is_directory(status))
    throw ConfigError({path + ": cannot be read: found a pipe or a device, expected a file"});
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  std::string text;
  std::array<char, 4096> block{};
  bool failed = file == nullptr;
  while (!failed) {
    const std::size_t count = std::fread(block.data(), 1, block.size(), file.get());
    text.append(block.data(), count);
    if (text.size() > kMaxBytes)
      throw ConfigError({path + ": cannot be read: more than " + std::to_string(kMaxBytes >> 20) + " MiB"});
    if (count == block.size()) continue;
    failed = std::ferror(file.get()) != 0;  // a directory opens, but cannot be read
    break;
  }
  if (failed) throw ConfigError({path + ": cannot be read: " + std::strerror(errno)});
  return text;
}

YamlValue ParseYamlFile(const std::string& path) { return ParseYamlText(ReadTextFile(path), path); }

void ApplyOverride(YamlValue& root, const std::string& assignment) {
  const std::string where = "--set " + assignment;
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0)
    throw ConfigError({where + ": expected a dotted key and a value, as in --set machine.cycle_us=2000"});
  YamlValue value = ParseDocument(assignment.substr(equals + 1), where);
  SetWhere(value, where);

  YamlValue* at = &root;
  std::string path;
  for (const std::string& part : SplitKey(std::string_view(assignment).substr(0, equals))) {
    if (part.empty()) throw ConfigError({where + ": found an empty part in the key"});
    if (at->kind == YamlValue::Kind::kNull) at->kind = YamlValue::Kind::kMap;
    if (at->kind != YamlValue::Kind::kMap)
      throw ConfigError(
          {where + ": " + path + " (" + at->where + ") is " + at->Describe() + ", so it has no key " + part});
    YamlEntry* entry = at->Find(part);
    if (entry == nullptr) {
      at->entries.push_back({part, where, {}});
      entry = &at->entries.back();
      entry->value.where = where;
    }
    path += (path.empty() ? "" : ".") + part;
    at = &entry->value;
  }
  *at = std::move(value);
}

std::string WhereIs(const YamlValue& root, std::string_view dotted_key) {
  const YamlValue* at = &root;
  std::string where = root.where;
  for (const std::string& part : SplitKey(dotted_key)) {
    const YamlEntry* entry = at->Find(part);
    if (entry == nullptr) break;
    where = entry->value.kind == YamlValue::Kind::kScalar ? entry->value.where : entry->where;
    at = &entry->value;
  }
  return where;
}

std::vector<std::string> WithPlaces(const YamlValue& root, const std::vector<std::string>& messages) {
  std::vector<std::string> placed;
  for (const std::string& m : messages) placed.push_back(WhereIs(root, m.substr(0, m.find(':'))) + ": " + m);
  return placed;
}

}  // namespace contour
