#include "config/key_table.h"

#include <array>
#include <cstddef>

#include "config/key_hints.h"

namespace contour {
namespace {

std::string Unit(const KeyRow& row) {
  if (row.type == "map" || row.type == "text" || row.type == "true or false") return "";
  return UnitText(SplitUnit(row.key.substr(row.key.rfind('.') + 1)).unit);
}

std::string Explanation(const KeyRow& row) {
  return row.only.empty() ? row.text : row.text + " (only with " + row.only + ")";
}

std::string Type(const KeyRow& row) { return row.range.empty() ? row.type : row.type + " " + row.range; }

std::string Padded(std::string text, std::size_t width) {
  if (text.size() < width) text.append(width - text.size(), ' ');
  return text;
}

}  // namespace

std::string MarkdownTable(const std::vector<KeyRow>& rows) {
  std::string table = "| key | unit | value | default | meaning |\n|---|---|---|---|---|\n";
  for (const KeyRow& row : rows)
    table += "| `" + row.key + "` | " + Unit(row) + " | " + Type(row) + " | " + row.value + " | " +
             Explanation(row) + " |\n";
  return table;
}

std::string TextTable(const std::vector<KeyRow>& rows) {
  std::vector<std::array<std::string, 5>> cells{{"KEY", "UNIT", "VALUE", "DEFAULT", "MEANING"}};
  for (const KeyRow& row : rows)
    cells.push_back({row.key, Unit(row), Type(row), row.value, Explanation(row)});
  std::array<std::size_t, 5> widths{};
  for (const auto& line : cells)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  std::string table;
  for (const auto& line : cells) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) table += Padded(line[i], widths[i] + 2);
    table += line.back() + "\n";
  }
  return table;
}

}  // namespace contour
