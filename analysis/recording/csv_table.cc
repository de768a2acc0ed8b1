#include "analysis/recording/csv_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "analysis/recording/csv_records.h"
#include "config/config_error.h"

namespace contour::diagnosis {
namespace {

constexpr std::size_t kLinesLookedAt = 20;

std::optional<double> Parsed(std::string_view field) {
  if (field.size() > 1 && field.front() == '+') field.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
  if (error != std::errc{} || end != field.data() + field.size() || !std::isfinite(number)) return {};
  return number;
}

bool IsNone(std::string_view field) {
  return field.empty() || field == "nan" || field == "NaN" || field == "NA";
}

/// With a decimal comma, if there is exactly one and no point.
std::string WithPoint(std::string_view field) {
  std::string text(field);
  if (std::count(text.begin(), text.end(), ',') == 1 && text.find('.') == std::string::npos)
    std::replace(text.begin(), text.end(), ',', '.');
  return text;
}

bool IsNumber(std::string_view field, char separator) {
  return Parsed(field).has_value() || (separator != ',' && Parsed(WithPoint(field)).has_value());
}

using Lines = std::vector<std::vector<std::string>>;

/// The first lines of a table as a separator cuts them, the header among them.
Lines FirstLines(const std::string& file, std::string_view text, char separator) {
  Lines lines;
  CsvRecords records(file, text, 0, 1);
  std::vector<std::string_view> fields;
  Unquoted unquoted;
  while (lines.size() < kLinesLookedAt && !records.Peek().empty()) {
    records.Take(separator, fields, unquoted);
    lines.emplace_back(fields.begin(), fields.end());
  }
  return lines;
}

bool AllAlike(const Lines& lines) {
  return !lines.empty() && lines[0].size() > 1 &&
         std::all_of(lines.begin(), lines.end(), [&](const auto& l) { return l.size() == lines[0].size(); });
}

/// The one that cuts all lines into the same number of fields; a semicolon first, since where both do, the
/// comma is a decimal one. Where none does, the header's.
char SeparatorOf(const std::string& file, std::string_view text) {
  std::vector<char> in_header;
  for (const char separator : {';', ',', '\t', ' '}) {
    try {
      const Lines lines = FirstLines(file, text, separator);
      if (AllAlike(lines)) return separator;
      if (!lines.empty() && lines[0].size() > 1) in_header.push_back(separator);
    } catch (const ConfigError&) {
      continue;  // what stands behind a quoted field is another's separator
    }
  }
  if (std::find(in_header.begin(), in_header.end(), ',') != in_header.end()) return ',';
  return in_header.empty() ? ',' : in_header.front();
}

/// Whether it is written so: a field that is a number with a comma only.
bool HasDecimalComma(const Lines& lines, char separator) {
  if (separator == ',') return false;
  for (const auto& line : lines)
    for (const std::string& field : line)
      if (!Parsed(field) && Parsed(WithPoint(field))) return true;
  return false;
}

bool AllNumbers(const std::vector<std::string>& fields, char separator) {
  bool any = false;
  for (const std::string& f : fields) {
    if (!IsNumber(f, separator) && !IsNone(f)) return false;
    any = any || !IsNone(f);
  }
  return any;
}

bool NoNumbers(const std::vector<std::string>& fields, char separator) {
  return std::none_of(fields.begin(), fields.end(), [&](const auto& f) { return IsNumber(f, separator); }) &&
         std::any_of(fields.begin(), fields.end(), [](const auto& f) { return !IsNone(f); });
}

/// Names of a table that has none of its own.
std::vector<std::string> NamesFor(const std::string& file, std::string_view comment, std::size_t columns,
                                  char separator) {
  for (const char cut : {separator, ',', ';', '\t', ' '}) {
    const Lines names = FirstLines(file, comment, cut);
    if (names.size() == 1 && names[0].size() == columns && NoNumbers(names[0], cut)) return names[0];
  }
  std::vector<std::string> numbers;
  for (std::size_t i = 1; i <= columns; ++i) numbers.push_back(std::to_string(i));
  return numbers;
}

/// Text in bytes, its lines ended by line feeds; what it must be for the rest to read it.
void MakePlain(const std::string& file, std::string& text) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw ConfigError({file + ": is written in UTF-16; save it as UTF-8 (plain CSV)"});
  if (text.find('\0') != std::string::npos)
    throw ConfigError({file + ": is no text (it holds zero bytes), expected a table (CSV) in UTF-8"});
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  // Of old spreadsheets.
  if (text.find('\n') == std::string::npos) std::replace(text.begin(), text.end(), '\r', '\n');
}

}  // namespace

CsvTable::CsvTable(std::string file) : file_(std::move(file)) {
  std::ifstream in(file_, std::ios::binary);
  std::stringstream content;
  if (in) content << in.rdbuf();
  if (!in) throw ConfigError({file_ + ": cannot be read"});
  text_ = content.str();
  MakePlain(file_, text_);
  CsvRecords records(file_, text_, 0, 1);
  if (records.Peek().empty())
    throw ConfigError({file_ + ": is empty, expected a line of column names and rows of numbers"});
  separator_ = SeparatorOf(file_, text_);
  const Lines lines = FirstLines(file_, text_, separator_);
  decimal_comma_ = HasDecimalComma(lines, separator_);
  if (AllNumbers(lines[0], separator_)) {
    header_ = NamesFor(file_, records.comment(), lines[0].size(), separator_);
  } else {
    std::vector<std::string_view> fields;
    Unquoted unquoted;
    header_ = lines[0];
    records.Take(separator_, fields, unquoted);
    // Units below the names.
    if (lines.size() > 2 && NoNumbers(lines[1], separator_) && AllNumbers(lines[2], separator_)) {
      records.Peek();
      records.Take(separator_, fields, unquoted);
    }
  }
  body_ = records.at();
  body_line_ = records.line();
}

void CsvTable::ForEachRow(const RowReader& reader) const {
  std::vector<std::string_view> fields;
  Unquoted unquoted;
  CsvRecords records(file_, text_, body_, body_line_);
  while (!records.Peek().empty()) {
    const std::size_t line = records.line();
    records.Take(separator_, fields, unquoted);
    if (fields.size() != header_.size())
      throw ConfigError({file_ + ":" + std::to_string(line) + ": found " + std::to_string(fields.size()) +
                         " fields, expected " + std::to_string(header_.size()) + " as in the header"});
    reader(line, fields);
  }
}

double CsvTable::Number(std::string_view field, std::size_t line, std::size_t column) const {
  if (decimal_comma_ && field.find(',') != std::string_view::npos)
    return NumberOf(WithPoint(field), file_, line, header_[column]);
  return NumberOf(field, file_, line, header_[column]);
}

double NumberOf(std::string_view field, const std::string& file, std::size_t line, std::string_view column) {
  if (IsNone(field)) return std::numeric_limits<double>::quiet_NaN();
  if (const auto number = Parsed(field)) return *number;
  throw ConfigError({file + ":" + std::to_string(line) + ": " + std::string(column) + ": found '" +
                     std::string(field) + "', expected a number"});
}

}  // namespace contour::diagnosis
