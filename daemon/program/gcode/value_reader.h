#pragma once

#include <string>

#include "daemon/program/gcode/line_text.h"
#include "daemon/program/gcode/parameters.h"

namespace contour {

/// Reads what may stand behind a letter: a number, a #parameter, an [expression] or a function of one, with
/// signs before it. Angles are in degrees. Throws ProgramError with the place.
class ValueReader {
 public:
  ValueReader(LineText& text, const Parameters& parameters) : text_(text), parameters_(parameters) {}

  double Value();
  /// From '[' to ']'.
  double Bracketed();
  /// A value that has to be whole.
  int Whole(const char* what);
  /// From '<' to '>', without them.
  std::string Name();

 private:
  double Number();
  double Parameter();
  double Function();
  double Exists();
  double Expression(int least_precedence);
  double Operand();
  double Term();
  double Apply(int op, double left, double right) const;

  LineText& text_;
  const Parameters& parameters_;
  int depth_ = 0;
};

}  // namespace contour
