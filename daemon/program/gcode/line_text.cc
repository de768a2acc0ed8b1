#include "daemon/program/gcode/line_text.h"

namespace contour {

void LineText::Assign(std::string_view line, int number) {
  number_ = number;
  text_.clear();
  columns_.clear();
  at_ = 0;
  end_column_ = static_cast<int>(line.size()) + 1;
  for (std::size_t i = 0; i < line.size() && line[i] != ';'; ++i) {
    const char c = line[i];
    if (c == ' ' || c == '\t' || c == '\r') continue;
    text_ += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    columns_.push_back(static_cast<int>(i) + 1);
    if (c != '(') continue;
    const std::size_t end = line.find_first_of("()", i + 1);
    if (end == std::string_view::npos) Refuse({name_, number, columns_.back()}, "comment is not closed");
    if (line[end] == '(') Refuse({name_, number, static_cast<int>(end) + 1}, "a comment inside a comment");
    i = end;
  }
}

}  // namespace contour
