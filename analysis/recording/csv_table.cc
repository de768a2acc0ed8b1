#include "analysis/recording/csv_table.h"

#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <utility>

#include "config/config_error.h"

namespace contour::diagnosis {
namespace {

std::string_view Trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t' || text.front() == '"'))
    text.remove_prefix(1);
  while (!text.empty() &&
         (text.back() == ' ' || text.back() == '\t' || text.back() == '\r' || text.back() == '"'))
    text.remove_suffix(1);
  return text;
}

void Split(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  for (;;) {
    const std::size_t end = line.find(separator);
    fields.push_back(Trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

bool Skipped(std::string_view line) {
  const std::string_view text = Trimmed(line);
  return text.empty() || text.front() == '#';
}

/// The line at `at` without its end; `at` moves behind it.
std::string_view TakeLine(std::string_view text, std::size_t& at) {
  const std::size_t end = std::min(text.find('\n', at), text.size());
  const std::string_view line = text.substr(at, end - at);
  at = std::min(end + 1, text.size());
  return line;
}

}  // namespace

CsvTable::CsvTable(std::string file) : file_(std::move(file)) {
  std::ifstream in(file_, std::ios::binary);
  std::stringstream content;
  if (in) content << in.rdbuf();
  if (!in) throw ConfigError({file_ + ": cannot be read"});
  text_ = content.str();
  if (text_.starts_with("\xEF\xBB\xBF")) text_.erase(0, 3);
  while (body_ < text_.size()) {
    const std::string_view line = TakeLine(text_, body_);
    ++body_line_;
    if (Skipped(line)) continue;
    separator_ =
        line.find(',') == std::string_view::npos && line.find(';') != std::string_view::npos ? ';' : ',';
    std::vector<std::string_view> names;
    Split(line, separator_, names);
    header_.assign(names.begin(), names.end());
    return;
  }
  throw ConfigError({file_ + ": is empty, expected a line of column names and rows of numbers"});
}

void CsvTable::ForEachRow(const RowReader& reader) const {
  std::vector<std::string_view> fields;
  std::size_t at = body_;
  for (std::size_t number = body_line_; at < text_.size(); ++number) {
    const std::string_view line = TakeLine(text_, at);
    if (Skipped(line)) continue;
    Split(line, separator_, fields);
    if (fields.size() != header_.size())
      throw ConfigError({file_ + ":" + std::to_string(number) + ": found " + std::to_string(fields.size()) +
                         " fields, expected " + std::to_string(header_.size()) + " as in the header"});
    reader(number, fields);
  }
}

double NumberOf(std::string_view field, const std::string& file, std::size_t line, std::string_view column) {
  if (field.empty() || field == "nan" || field == "NaN" || field == "NA")
    return std::numeric_limits<double>::quiet_NaN();
  if (field.size() > 1 && field.front() == '+') field.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
  if (error != std::errc{} || end != field.data() + field.size() || !std::isfinite(number))
    throw ConfigError({file + ":" + std::to_string(line) + ": " + std::string(column) + ": found '" +
                       std::string(field) + "', expected a number"});
  return number;
}

}  // namespace contour::diagnosis
