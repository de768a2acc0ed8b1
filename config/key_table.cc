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

std::string MarkdownReference(const std::vector<KeyRow>& rows) {
  // A section for each map; a key belongs to the innermost map that is listed.
  struct Section {
    const KeyRow* map = nullptr;
    std::string table;
  };
  std::vector<Section> sections;
  for (const KeyRow& row : rows) {
    if (row.type == "map") {
      sections.push_back({&row, ""});
      continue;
    }
    Section* home = nullptr;
    for (Section& s : sections)
      if (row.key.starts_with(s.map->key + ".") &&
          (home == nullptr || s.map->key.size() > home->map->key.size()))
        home = &s;
    if (home == nullptr) home = &sections.emplace_back(Section{&row, ""});
    const std::string shown = home->map == &row ? row.key : row.key.substr(home->map->key.size() + 1);
    home->table += "| `" + shown + "` | " + Unit(row) + " | " + Type(row) + " | " + row.value + " | " +
                   Explanation(row) + " |\n";
  }
  std::string text;
  for (const Section& s : sections) {
    const bool required = s.map->value == "required";
    text += "## `" + s.map->key + "`\n\n" + Explanation(*s.map) + (required ? " (required)" : "") + "\n\n";
    if (!s.table.empty())
      text += "| key | unit | value | default | meaning |\n|---|---|---|---|---|\n" + s.table + "\n";
  }
  return text;
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
