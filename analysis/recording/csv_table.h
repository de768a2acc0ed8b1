#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace contour::diagnosis {

/// A text table, read row by row, as programs write it. Fields are separated by commas, semicolons, tabs or
/// blanks, whichever cuts all lines alike, and may be quoted as RFC 4180 has it: "a, b", "a ""b""". Lines
/// that begin with '#' or '%' and empty lines are skipped. Where the first line holds nothing but numbers
/// there is no header: then the last comment before it is one, if it has as many names; else columns are
/// called by their number from 1. A line of units below the header is skipped.
class CsvTable {
 public:
  /// Sees the fields of one row, which live until it returns; `line` counts from 1.
  using RowReader = std::function<void(std::size_t line, const std::vector<std::string_view>& fields)>;

  /// Reads file and header. Throws ConfigError when there is none.
  explicit CsvTable(std::string file);

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const std::vector<std::string>& header() const { return header_; }
  /// All rows in order. Throws ConfigError naming the line of a row that has not as many fields as the
  /// header.
  void ForEachRow(const RowReader& reader) const;
  /// Number in a field of that column, NaN where it is empty; 1,5 is 1.5 where the table writes it so. Throws
  /// ConfigError naming file, line and column.
  [[nodiscard]] double Number(std::string_view field, std::size_t line, std::size_t column) const;

 private:
  std::string file_;
  std::string text_;
  std::size_t body_ = 0;       ///< first byte after the header
  std::size_t body_line_ = 1;  ///< and its line
  char separator_ = ',';
  bool decimal_comma_ = false;
  std::vector<std::string> header_;
};

/// A number, or NaN for an empty field. Throws ConfigError naming file, line and column.
double NumberOf(std::string_view field, const std::string& file, std::size_t line, std::string_view column);

}  // namespace contour::diagnosis
