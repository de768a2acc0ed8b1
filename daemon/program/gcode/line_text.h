#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/program/gcode/source_place.h"

namespace contour {

/// One line as RS274/NGC reads it: without blanks, in lower case, each comment in parentheses as a single
/// '(', nothing after a semicolon. Remembers where its characters stood, and how far it has been read.
class LineText {
 public:
  explicit LineText(const std::string& name) : name_(&name) {}

  /// Throws ProgramError for a comment that is nested or not closed.
  void Assign(std::string_view line, int number);

  [[nodiscard]] bool AtEnd() const { return at_ == text_.size(); }
  /// The next character; 0 at the end.
  [[nodiscard]] char Peek() const { return AtEnd() ? '\0' : text_[at_]; }
  char Take() { return AtEnd() ? '\0' : text_[at_++]; }
  bool TakeIf(char c) {
    const bool is = Peek() == c;
    if (is) ++at_;
    return is;
  }
  bool TakeIf(std::string_view word) {
    const bool is = Rest().starts_with(word);
    if (is) at_ += word.size();
    return is;
  }
  [[nodiscard]] std::string_view Rest() const { return std::string_view(text_).substr(at_); }
  void Skip(std::size_t characters) { at_ += characters; }

  [[nodiscard]] int number() const { return number_; }
  /// Of the next character.
  [[nodiscard]] SourcePlace place() const { return At(at_); }
  /// Of the character that was taken last.
  [[nodiscard]] SourcePlace place_before() const { return At(at_ == 0 ? 0 : at_ - 1); }
  [[noreturn]] void Fail(const std::string& what) const { Refuse(place(), what); }

 private:
  [[nodiscard]] SourcePlace At(std::size_t at) const {
    return {name_, number_, at < columns_.size() ? columns_[at] : end_column_};
  }

  const std::string* name_;
  int number_ = 0;
  int end_column_ = 1;
  std::string text_;
  std::vector<int> columns_;
  std::size_t at_ = 0;
};

}  // namespace contour
