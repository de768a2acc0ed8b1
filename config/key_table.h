#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "config/number_text.h"
#include "config/visit_traits.h"
#include "core/visit.h"

namespace contour {

/// One key of a configuration, for the reference table of `contour check --describe`.
struct KeyRow {
  std::string key;    ///< dotted; `<name>` stands for names the user chooses, `[]` for the elements of a list
  std::string type;   ///< "number", "whole number", "text", "one of ..."; "map" for a key that holds others
  std::string range;  ///< "above 0"; empty without bounds
  std::string value;  ///< the default; "required"; "-" for optional maps that are absent by default
  std::string only;   ///< "acts_on: motor" when the key exists only then
  std::string text;
};

/// Collects a row for each key that a Visit method lists. Where a struct shows other keys for another value
/// of one of its enums, those are listed too.
class KeyDescriber {
 public:
  KeyDescriber(std::string path, std::vector<KeyRow>& rows) : path_(std::move(path)), rows_(rows) {}

  template <class T>
  void Required(std::string_view key, T& /*value*/, Range range, std::string_view text) {
    Row<T>(key, range, text, "required");
  }
  template <class T>
  void Required(std::string_view key, T& /*value*/, std::string_view text) {
    Row<T>(key, kAny, text, "required");
  }
  template <class T>
  void Optional(std::string_view key, T& value, Range range, std::string_view text) {
    Row<T>(key, range, text, DefaultText(value));
  }
  template <class T>
  void Optional(std::string_view key, T& value, std::string_view text) {
    Row<T>(key, kAny, text, DefaultText(value));
  }

  /// Rows of a struct, with all its variants.
  template <visit::Struct T>
  static void Describe(const std::string& path, std::vector<KeyRow>& rows);

 private:
  /// Lets a struct's own Visit run with one of its enums set to each of its choices in turn.
  class VariantFinder;

  template <class T>
  void Row(std::string_view key, Range range, std::string_view text, std::string default_text) {
    const std::string path = path_.empty() ? std::string(key) : path_ + "." + std::string(key);
    rows_.push_back(
        {path, TypeText<T>(), Trimmed(RangeText(range)), std::move(default_text), "", std::string(text)});
    Inside<T>(path, rows_, range);
  }

  static std::string Trimmed(std::string text) { return text.starts_with(' ') ? text.substr(1) : text; }

  template <class T>
  static std::string TypeText();
  template <class T>
  static std::string DefaultText(const T& value);
  template <class T>
  static void Inside(const std::string& path, std::vector<KeyRow>& rows, Range range);

  std::string path_;
  std::vector<KeyRow>& rows_;
};

/// The table of a configuration struct.
template <visit::Struct T>
std::vector<KeyRow> DescribeKeys(const std::string& path = "") {
  std::vector<KeyRow> rows;
  KeyDescriber::Describe<T>(path, rows);
  return rows;
}

/// The table as Markdown: a section with a table for each map of keys.
std::string MarkdownReference(const std::vector<KeyRow>& rows);
/// The table as aligned text.
std::string TextTable(const std::vector<KeyRow>& rows);

template <class T>
std::string KeyDescriber::TypeText() {
  using namespace visit;
  if constexpr (std::floating_point<T>)
    return "number";
  else if constexpr (Integer<T>)
    return "whole number";
  else if constexpr (std::same_as<T, bool>)
    return "true or false";
  else if constexpr (std::same_as<T, std::string>)
    return "text";
  else if constexpr (NamedEnum<T>)
    return "one of " + std::string(Choices(T{}));
  else if constexpr (kIsOptional<T>)
    return TypeText<typename T::value_type>();
  else if constexpr (kIsVector<T>)
    return "list of " + TypeText<typename T::value_type>();
  else if constexpr (kIsArray<T>)
    return "list of " + std::to_string(std::tuple_size_v<T>) + ": " + TypeText<typename T::value_type>();
  else
    return "map";
}

template <class T>
std::string KeyDescriber::DefaultText(const T& value) {
  using namespace visit;
  if constexpr (std::floating_point<T>) {
    return NumberText(value);
  } else if constexpr (Integer<T>) {
    return std::to_string(value);
  } else if constexpr (std::same_as<T, bool>) {
    return value ? "true" : "false";
  } else if constexpr (std::same_as<T, std::string>) {
    return value.empty() ? "empty" : value;
  } else if constexpr (NamedEnum<T>) {
    return std::string(Name(value));
  } else if constexpr (kIsOptional<T>) {
    return value ? DefaultText(*value) : "none";
  } else if constexpr (kIsArray<T> || kIsVector<T>) {
    std::string text = "[";
    for (const auto& item : value) text += (text.size() == 1 ? "" : ", ") + DefaultText(item);
    return text + "]";
  } else if constexpr (kIsMap<T>) {
    return "none";
  } else {
    return "as below";
  }
}

template <class T>
void KeyDescriber::Inside(const std::string& path, std::vector<KeyRow>& rows, Range range) {
  using namespace visit;
  if constexpr (kIsOptional<T>) {
    Inside<typename T::value_type>(path, rows, range);
  } else if constexpr (kIsVector<T> || kIsArray<T>) {
    Inside<typename T::value_type>(path + "[]", rows, range);
  } else if constexpr (kIsMap<T>) {
    Inside<typename T::mapped_type>(path + ".<name>", rows, range);
  } else if constexpr (Struct<T>) {
    Describe<T>(path, rows);
  }
}

class KeyDescriber::VariantFinder {
 public:
  /// What enum to set to its nth choice; found is false when there are fewer.
  VariantFinder(std::size_t which, std::size_t choice) : which_(which), choice_(choice) {}

  template <class T>
  void Required(std::string_view key, T& value, Range, std::string_view) {
    Set(key, value);
  }
  template <class T>
  void Required(std::string_view key, T& value, std::string_view) {
    Set(key, value);
  }
  template <class T>
  void Optional(std::string_view key, T& value, Range, std::string_view) {
    Set(key, value);
  }
  template <class T>
  void Optional(std::string_view key, T& value, std::string_view) {
    Set(key, value);
  }

  [[nodiscard]] bool enum_found() const { return enum_found_; }
  [[nodiscard]] bool choice_found() const { return choice_found_; }
  [[nodiscard]] const std::string& condition() const { return condition_; }

 private:
  template <class T>
  void Set(std::string_view key, T& value) {
    if constexpr (visit::NamedEnum<T>) {
      if (seen_++ != which_) return;
      enum_found_ = true;
      // Choices are words between commas and "or"; FromName knows which are names.
      std::string word;
      std::size_t n = 0;
      for (const char c : std::string(Choices(value)) + " ") {
        if (std::string_view(", |/").find(c) == std::string_view::npos) {
          word += c;
          continue;
        }
        T candidate{};
        if (!word.empty() && word != "or" && FromName(word, candidate) && n++ == choice_) {
          value = candidate;
          choice_found_ = true;
          condition_ = std::string(key) + ": " + word;
        }
        word.clear();
      }
    }
  }

  std::size_t which_;
  std::size_t choice_;
  std::size_t seen_ = 0;
  bool enum_found_ = false;
  bool choice_found_ = false;
  std::string condition_;
};

template <visit::Struct T>
void KeyDescriber::Describe(const std::string& path, std::vector<KeyRow>& rows) {
  T value;
  const std::size_t first = rows.size();
  KeyDescriber plain(path, rows);
  value.Visit(plain);
  for (std::size_t which = 0;; ++which) {
    for (std::size_t choice = 0;; ++choice) {
      T variant;
      VariantFinder finder(which, choice);
      variant.Visit(finder);
      if (!finder.enum_found()) return;
      if (!finder.choice_found()) break;
      std::vector<KeyRow> more;
      KeyDescriber again(path, more);
      variant.Visit(again);
      for (KeyRow& row : more) {
        const auto same = [&](const KeyRow& r) { return r.key == row.key; };
        if (std::any_of(rows.begin() + static_cast<std::ptrdiff_t>(first), rows.end(), same)) continue;
        row.only = finder.condition();
        rows.push_back(std::move(row));
      }
    }
  }
}

}  // namespace contour
