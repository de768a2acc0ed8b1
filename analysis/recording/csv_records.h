#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace contour::diagnosis {

/// Fields that are not in the text as they are meant.
using Unquoted = std::deque<std::string>;

/// Cuts text into records of fields, as RFC 4180 has them: a field that begins with a quote ends at the next
/// one that is not doubled, and may hold separators, line ends and doubled quotes. A blank as separator
/// stands for any run of blanks.
class CsvRecords {
 public:
  CsvRecords(const std::string& file, std::string_view text, std::size_t at, std::size_t line)
      : file_(file), text_(text), at_(at), line_(line) {}

  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] std::size_t line() const { return line_; }
  /// The last comment that was passed, without its mark; empty: none.
  [[nodiscard]] std::string_view comment() const { return comment_; }

  /// The line that comes next; none but empty ones and comments is left where it is empty. They are passed.
  std::string_view Peek();
  /// The fields of the record that comes next, behind Peek().
  void Take(char separator, std::vector<std::string_view>& fields, Unquoted& unquoted);

 private:
  std::string_view Plain(char separator);
  std::string_view Quoted(char separator, Unquoted& unquoted);

  const std::string& file_;
  std::string_view text_;
  std::size_t at_, line_;
  std::string_view comment_;
};

/// Without blanks at either end.
std::string_view TrimmedField(std::string_view text);

}  // namespace contour::diagnosis
