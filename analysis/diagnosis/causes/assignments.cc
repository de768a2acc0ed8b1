#include "analysis/diagnosis/causes/assignments.h"

#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

template <class Items, class TextOf>
std::string Joined(const Items& items, TextOf&& text_of) {
  std::string out;
  for (const auto& item : items) out += (out.empty() ? "" : ", ") + text_of(item);
  return out;
}

std::string Entry(std::string_view key, const std::string& value) { return std::string(key) + ": " + value; }

}  // namespace

MapEntry::MapEntry(std::string_view key, double number) : text(Entry(key, NumberText(number))) {}

MapEntry::MapEntry(std::string_view key, const std::vector<double>& numbers)
    : text(Entry(key, "[" + Joined(numbers, NumberText) + "]")) {}

MapEntry::MapEntry(std::string_view key, const std::vector<std::string>& maps)
    : text(Entry(key, "[" + Joined(maps, [](const std::string& map) { return map; }) + "]")) {}

MapEntry::MapEntry(std::string_view key, std::string_view word) : text(Entry(key, std::string(word))) {}

std::string MapText(std::initializer_list<MapEntry> entries) {
  return "{" + Joined(entries, [](const MapEntry& e) { return e.text; }) + "}";
}

std::string SetEffect(std::string_view effect, std::initializer_list<MapEntry> entries) {
  return "effects." + std::string(effect) + "=" + MapText(entries);
}

std::string SetKey(std::string_view key, double number) {
  return std::string(key) + "=" + NumberText(number);
}

}  // namespace contour::diagnosis
