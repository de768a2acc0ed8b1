#include "analysis/recording/csv_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <deque>
#include <fstream>
#include <limits>
#include <sstream>
#include <utility>

#include "config/config_error.h"

namespace contour::diagnosis {
namespace {

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view Trimmed(std::string_view text) {
  while (!text.empty() && IsBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsBlank(text.back())) text.remove_suffix(1);
  return text;
}

/// Fields that are not in the text as they are meant.
using Unquoted = std::deque<std::string>;

std::string WithoutDoubledQuotes(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    out.push_back(text[i]);
    if (text[i] == '"') ++i;
  }
  return out;
}

/// Cuts text into records of fields, as RFC 4180 has them: a field that begins with a quote ends at the next
/// one that is not doubled, and may hold separators, line ends and doubled quotes.
class Records {
 public:
  Records(const std::string& file, std::string_view text, std::size_t at, std::size_t line)
      : file_(file), text_(text), at_(at), line_(line) {}

  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] std::size_t line() const { return line_; }

  /// The line that comes next; none but empty ones and comments is left where it is empty. They are passed.
  std::string_view Peek() {
    while (at_ < text_.size()) {
      const std::string_view line = text_.substr(at_, std::min(text_.find('\n', at_), text_.size()) - at_);
      const std::string_view content = Trimmed(line);
      if (!content.empty() && content.front() != '#') return line;
      at_ = std::min(at_ + line.size() + 1, text_.size());
      ++line_;
    }
    return {};
  }

  /// The fields of the record that comes next, behind Peek().
  void Take(char separator, std::vector<std::string_view>& fields, Unquoted& unquoted) {
    fields.clear();
    unquoted.clear();
    for (;;) {
      while (at_ < text_.size() && IsBlank(text_[at_]) && text_[at_] != separator) ++at_;
      const bool quoted = at_ < text_.size() && text_[at_] == '"';
      fields.push_back(quoted ? Quoted(separator, unquoted) : Plain(separator));
      if (at_ >= text_.size()) return;
      if (text_[at_++] == '\n') {
        ++line_;
        return;
      }
    }
  }

 private:
  std::string_view Plain(char separator) {
    const std::size_t from = at_;
    while (at_ < text_.size() && text_[at_] != separator && text_[at_] != '\n') ++at_;
    return Trimmed(text_.substr(from, at_ - from));
  }

  std::string_view Quoted(char separator, Unquoted& unquoted) {
    const std::size_t opened = line_, from = ++at_;
    bool doubled = false;
    for (;; ++at_) {
      if (at_ >= text_.size())
        throw ConfigError(
            {file_ + ":" + std::to_string(opened) + ": a field begins with a quote and never ends"});
      if (text_[at_] == '\n') ++line_;
      if (text_[at_] != '"') continue;
      if (at_ + 1 >= text_.size() || text_[at_ + 1] != '"') break;
      doubled = true;
      ++at_;
    }
    const std::string_view content = text_.substr(from, at_ - from);
    ++at_;
    if (const std::string_view rest = Plain(separator); !rest.empty())
      throw ConfigError({file_ + ":" + std::to_string(line_) + ": found '" + std::string(rest) +
                         "' behind a quoted field, expected a separator"});
    return doubled ? unquoted.emplace_back(WithoutDoubledQuotes(content)) : content;
  }

  const std::string& file_;
  std::string_view text_;
  std::size_t at_, line_;
};

/// Of a header line: a comma outside quotes, or else a semicolon where there is one.
char SeparatorOf(std::string_view line) {
  bool quoted = false, semicolon = false;
  for (const char c : line) {
    quoted = quoted != (c == '"');
    if (quoted) continue;
    if (c == ',') return ',';
    semicolon = semicolon || c == ';';
  }
  return semicolon ? ';' : ',';
}

}  // namespace

CsvTable::CsvTable(std::string file) : file_(std::move(file)) {
  std::ifstream in(file_, std::ios::binary);
  std::stringstream content;
  if (in) content << in.rdbuf();
  if (!in) throw ConfigError({file_ + ": cannot be read"});
  text_ = content.str();
  if (text_.starts_with("\xEF\xBB\xBF")) text_.erase(0, 3);
  Records records(file_, text_, 0, 1);
  const std::string_view line = records.Peek();
  if (line.empty())
    throw ConfigError({file_ + ": is empty, expected a line of column names and rows of numbers"});
  separator_ = SeparatorOf(line);
  std::vector<std::string_view> names;
  Unquoted unquoted;
  records.Take(separator_, names, unquoted);
  header_.assign(names.begin(), names.end());
  body_ = records.at();
  body_line_ = records.line();
}

void CsvTable::ForEachRow(const RowReader& reader) const {
  std::vector<std::string_view> fields;
  Unquoted unquoted;
  Records records(file_, text_, body_, body_line_);
  while (!records.Peek().empty()) {
    const std::size_t line = records.line();
    records.Take(separator_, fields, unquoted);
    if (fields.size() != header_.size())
      throw ConfigError({file_ + ":" + std::to_string(line) + ": found " + std::to_string(fields.size()) +
                         " fields, expected " + std::to_string(header_.size()) + " as in the header"});
    reader(line, fields);
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
