#include "analysis/recording/csv_records.h"

#include <algorithm>

#include "config/config_error.h"

namespace contour::diagnosis {
namespace {

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool IsMark(char c) { return c == '#' || c == '%'; }

std::string WithoutDoubledQuotes(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    out.push_back(text[i]);
    if (text[i] == '"') ++i;
  }
  return out;
}

}  // namespace

std::string_view TrimmedField(std::string_view text) {
  while (!text.empty() && IsBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsBlank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view CsvRecords::Peek() {
  while (at_ < text_.size()) {
    const std::string_view line = text_.substr(at_, std::min(text_.find('\n', at_), text_.size()) - at_);
    std::string_view content = TrimmedField(line);
    if (!content.empty() && !IsMark(content.front())) return line;
    while (!content.empty() && IsMark(content.front())) content.remove_prefix(1);
    if (!content.empty()) comment_ = content;
    at_ = std::min(at_ + line.size() + 1, text_.size());
    ++line_;
  }
  return {};
}

void CsvRecords::Take(char separator, std::vector<std::string_view>& fields, Unquoted& unquoted) {
  fields.clear();
  unquoted.clear();
  for (;;) {
    while (at_ < text_.size() && IsBlank(text_[at_]) && (text_[at_] != separator || separator == ' ')) ++at_;
    const bool ended = at_ >= text_.size() || text_[at_] == '\n';
    const bool quoted = !ended && text_[at_] == '"';
    // Blanks at the end of a line separate nothing.
    if (!(separator == ' ' && ended && !fields.empty()))
      fields.push_back(quoted ? Quoted(separator, unquoted) : Plain(separator));
    if (at_ >= text_.size()) return;
    if (text_[at_++] == '\n') {
      ++line_;
      return;
    }
  }
}

std::string_view CsvRecords::Plain(char separator) {
  const std::size_t from = at_;
  const auto ends = [&](char c) {
    return c == '\n' || c == separator || (separator == ' ' && (c == '\t' || c == '\r'));
  };
  while (at_ < text_.size() && !ends(text_[at_])) ++at_;
  return TrimmedField(text_.substr(from, at_ - from));
}

std::string_view CsvRecords::Quoted(char separator, Unquoted& unquoted) {
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

}  // namespace contour::diagnosis
