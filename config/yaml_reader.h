#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "config/config_error.h"
#include "config/visit_traits.h"
#include "config/yaml_tree.h"
#include "core/visit.h"

namespace contour {

/// Reads one map of a YAML tree into a struct through its Visit method (core/visit.h). Strict both ways: a
/// key that the struct does not know is an error, and so is a required key that is missing. Nothing is thrown
/// while reading; all errors of a file are collected, so that they can be mended in one go.
class YamlReader {
 public:
  /// `path` is the dotted key of `map`, empty at the top. `errors` outlives the reader.
  YamlReader(const YamlValue& map, std::string path, std::vector<std::string>& errors)
      : map_(map), path_(std::move(path)), errors_(errors) {}

  template <class T>
  void Required(std::string_view key, T& value, Range range, std::string_view text) {
    if (const YamlEntry* entry = Take(key))
      ReadValue(entry->value, value, range, Dotted(key), errors_);
    else
      missing_.push_back({std::string(key), Expected<T>(range), std::string(text)});
  }
  template <class T>
  void Required(std::string_view key, T& value, std::string_view text) {
    Required(key, value, kAny, text);
  }
  template <class T>
  void Optional(std::string_view key, T& value, Range range, std::string_view /*text*/) {
    if (const YamlEntry* entry = Take(key)) ReadValue(entry->value, value, range, Dotted(key), errors_);
  }
  template <class T>
  void Optional(std::string_view key, T& value, std::string_view text) {
    Optional(key, value, kAny, text);
  }

  /// Call after Visit: reports missing, unknown and duplicate keys.
  void Finish();

  /// Reads any supported value; `path` is its dotted key.
  template <class T>
  static void ReadValue(const YamlValue& from, T& value, Range range, const std::string& path,
                        std::vector<std::string>& errors);

 private:
  struct Missing {
    std::string key;
    std::string expected;
    std::string text;
  };

  template <class T>
  static std::string Expected(Range range);
  static std::string ExpectedNumber(Range range, bool whole);
  static void ReadNumber(const YamlValue& from, double& value, Range range, const std::string& path,
                         std::vector<std::string>& errors);
  static void ReadInteger(const YamlValue& from, std::int64_t& value, Range range, const std::string& path,
                          std::vector<std::string>& errors);
  static void ReadBool(const YamlValue& from, bool& value, const std::string& path,
                       std::vector<std::string>& errors);
  static void ReadText(const YamlValue& from, std::string& value, const std::string& path,
                       std::vector<std::string>& errors);
  static void WrongType(const YamlValue& from, const std::string& path, const std::string& expected,
                        std::vector<std::string>& errors);
  /// A key with nothing behind it, as when all below it is commented out, is an empty map.
  static bool IsMap(const YamlValue& value) {
    return value.kind == YamlValue::Kind::kMap || value.kind == YamlValue::Kind::kNull;
  }
  static std::string Join(const std::string& path, std::string_view key);
  static bool CheckDuplicates(const YamlValue& map, const std::string& path,
                              std::vector<std::string>& errors);

  const YamlEntry* Take(std::string_view key);
  [[nodiscard]] std::string Dotted(std::string_view key) const { return Join(path_, key); }
  void ReportUnknown(const YamlEntry& entry);

  const YamlValue& map_;
  std::string path_;
  std::vector<std::string>& errors_;
  std::vector<std::string> known_;
  std::vector<Missing> missing_;
};

/// Reads a whole tree into a struct; adds to `errors`.
template <visit::Struct T>
void ReadYaml(const YamlValue& from, T& value, const std::string& path, std::vector<std::string>& errors) {
  YamlReader::ReadValue(from, value, kAny, path, errors);
}

template <class T>
std::string YamlReader::Expected(Range range) {
  using namespace visit;
  if constexpr (std::floating_point<T>) {
    return ExpectedNumber(range, false);
  } else if constexpr (Integer<T>) {
    return ExpectedNumber(range, true);
  } else if constexpr (std::same_as<T, bool>) {
    return "true or false";
  } else if constexpr (std::same_as<T, std::string>) {
    return "text";
  } else if constexpr (NamedEnum<T>) {
    return "one of " + std::string(Choices(T{}));
  } else if constexpr (kIsOptional<T>) {
    return Expected<typename T::value_type>(range);
  } else if constexpr (kIsVector<T>) {
    return "a list, each " + Expected<typename T::value_type>(range);
  } else if constexpr (kIsArray<T>) {
    return "a list of " + std::to_string(std::tuple_size_v<T>) + ", each " +
           Expected<typename T::value_type>(range);
  } else {
    return "a map of keys";
  }
}

template <class T>
void YamlReader::ReadValue(const YamlValue& from, T& value, Range range, const std::string& path,
                           std::vector<std::string>& errors) {
  using namespace visit;
  if constexpr (std::floating_point<T>) {
    double number = 0.0;
    const std::size_t before = errors.size();
    ReadNumber(from, number, range, path, errors);
    if (errors.size() == before) value = static_cast<T>(number);
  } else if constexpr (Integer<T>) {
    // The type's own bounds apply as well, so that the cast below cannot change the value.
    using Limits = std::numeric_limits<T>;
    if (range.min < static_cast<double>(Limits::min())) range.min = static_cast<double>(Limits::min());
    if (range.max > static_cast<double>(Limits::max())) range.max = static_cast<double>(Limits::max());
    std::int64_t number = 0;
    const std::size_t before = errors.size();
    ReadInteger(from, number, range, path, errors);
    if (errors.size() == before) value = static_cast<T>(number);
  } else if constexpr (std::same_as<T, bool>) {
    ReadBool(from, value, path, errors);
  } else if constexpr (std::same_as<T, std::string>) {
    ReadText(from, value, path, errors);
  } else if constexpr (NamedEnum<T>) {
    if (from.kind != YamlValue::Kind::kScalar || !FromName(from.text, value))
      WrongType(from, path, Expected<T>(range), errors);
  } else if constexpr (kIsOptional<T>) {
    typename T::value_type inner{};
    ReadValue(from, inner, range, path, errors);
    value = inner;
  } else if constexpr (kIsVector<T> || kIsArray<T>) {
    if (from.kind != YamlValue::Kind::kSequence) return WrongType(from, path, Expected<T>(range), errors);
    if constexpr (kIsVector<T>)
      value.assign(from.items.size(), {});
    else if (from.items.size() != value.size())
      return WrongType(from, path, Expected<T>(range), errors);
    for (std::size_t i = 0; i < from.items.size(); ++i)
      ReadValue(from.items[i], value[i], range, path + "[" + std::to_string(i) + "]", errors);
  } else if constexpr (kIsMap<T>) {
    if (!IsMap(from)) return WrongType(from, path, Expected<T>(range), errors);
    CheckDuplicates(from, path, errors);
    value.clear();
    for (const YamlEntry& e : from.entries)
      ReadValue(e.value, value[e.key], range, Join(path, e.key), errors);
  } else if constexpr (Struct<T>) {
    if (!IsMap(from)) return WrongType(from, path, Expected<T>(range), errors);
    YamlReader reader(from, path, errors);
    value.Visit(reader);
    reader.Finish();
  } else {
    static_assert(kUnsupported<T>, "core/visit.h lists the member types that can be configured");
  }
}

}  // namespace contour
