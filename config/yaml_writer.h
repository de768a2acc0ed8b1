#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "config/number_text.h"
#include "config/visit_traits.h"
#include "core/visit.h"

namespace contour {

/// Text as a double-quoted YAML scalar.
std::string QuotedYaml(std::string_view text);

/// Writes a configuration struct as YAML through its Visit method: every key, defaults included, numbers so
/// that they read back as the same bits. Absent optionals are left out, and so are empty lists of maps.
class YamlWriter {
 public:
  explicit YamlWriter(std::string& out, std::size_t indent = 0) : out_(out), indent_(indent) {}

  template <class T>
  void Required(std::string_view key, T& value, Range, std::string_view) {
    Entry(key, value);
  }
  template <class T>
  void Required(std::string_view key, T& value, std::string_view) {
    Entry(key, value);
  }
  template <class T>
  void Optional(std::string_view key, T& value, Range, std::string_view) {
    Entry(key, value);
  }
  template <class T>
  void Optional(std::string_view key, T& value, std::string_view) {
    Entry(key, value);
  }

 private:
  template <class T>
  void Entry(std::string_view key, T& value) {
    using namespace visit;
    if constexpr (kIsOptional<T>) {
      if (value) Entry(key, *value);
    } else {
      if constexpr (ListOfMaps<T>()) {
        if (value.empty()) return;
      }
      out_.append(indent_, ' ');
      out_ += key;
      out_ += ':';
      Value(value);
    }
  }

  /// Left out when empty, as maps that are absent are.
  template <class T>
  static constexpr bool ListOfMaps() {
    if constexpr (visit::kIsVector<T>)
      return visit::Struct<typename T::value_type>;
    else
      return false;
  }

  template <class T>
  void Value(T& value) {
    using namespace visit;
    if constexpr (Struct<T>) {
      const std::size_t before = out_.size();
      out_ += '\n';
      YamlWriter inner(out_, indent_ + 2);
      value.Visit(inner);
      if (out_.size() == before + 1) out_.insert(before, " {}");
    } else if constexpr (kIsMap<T>) {
      out_ += value.empty() ? " {}\n" : "\n";
      YamlWriter inner(out_, indent_ + 2);
      for (auto& [key, item] : value) inner.Entry(key, item);
    } else if constexpr (kIsVector<T> || kIsArray<T>) {
      List(value);
    } else {
      out_ += ' ' + Scalar(value) + '\n';
    }
  }

  template <class T>
  void List(T& value) {
    using Item = typename T::value_type;
    if constexpr (visit::Struct<Item>) {
      // Each map on the lines after its dash.
      out_ += '\n';
      for (Item& item : value) {
        const std::size_t at = out_.size() + indent_ + 2;
        YamlWriter inner(out_, indent_ + 4);
        item.Visit(inner);
        if (at < out_.size()) out_[at] = '-';
      }
    } else {
      out_ += " [";
      for (std::size_t i = 0; i < value.size(); ++i) out_ += (i == 0 ? "" : ", ") + Scalar(value[i]);
      out_ += "]\n";
    }
  }

  template <class T>
  static std::string Scalar(const T& value) {
    using namespace visit;
    if constexpr (std::floating_point<T>)
      return NumberText(value);
    else if constexpr (std::same_as<T, bool>)
      return value ? "true" : "false";
    else if constexpr (Integer<T>)
      return std::to_string(value);
    else if constexpr (NamedEnum<T>)
      return std::string(Name(value));
    else
      return QuotedYaml(value);
  }

  std::string& out_;
  std::size_t indent_;
};

/// The whole struct as YAML.
template <visit::Struct T>
std::string WriteYaml(T value) {
  std::string out;
  YamlWriter writer(out);
  value.Visit(writer);
  return out;
}

}  // namespace contour
