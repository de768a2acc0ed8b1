#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/program/gcode/line_text.h"

namespace contour {

/// One line that begins with an O word: part of a sub, a loop or a choice.
struct OWord {
  enum class Kind {
    kNumber,  ///< of the program; means nothing
    kSub,
    kEndSub,
    kCall,
    kReturn,
    kIf,
    kElseIf,
    kElse,
    kEndIf,
    kWhile,  ///< with its condition first
    kEndWhile,
    kDo,
    kDoWhile,  ///< the condition at the end of a do
    kRepeat,
    kEndRepeat,
    kBreak,
    kContinue,
  };
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  Kind kind = Kind::kNumber;
  std::string label;
  std::size_t line = 0;       ///< index
  std::size_t begin = kNone;  ///< index of the line that opens what this one closes, or is in
  std::size_t next = kNone;   ///< if, elseif: the next branch; others: the line that closes
  bool in_sub = false;
};

/// True when the raw line begins with an O word, after a slash and a block number.
bool BeginsWithO(std::string_view line);

/// Reads label and keyword from where the text stands; what follows is left for the interpreter.
OWord ReadOWord(LineText& text);

/// Which lines belong together.
class OWords {
 public:
  /// `words` in the order of lines. Throws ProgramError for what is opened and not closed, and the reverse.
  OWords(std::vector<OWord> words, const std::string& name);
  OWords() = default;

  /// The word of a line; null when the line has none.
  [[nodiscard]] const OWord* At(std::size_t line) const;
  /// The sub of a label; null when there is none.
  [[nodiscard]] const OWord* Sub(const std::string& label) const;

 private:
  std::vector<OWord> words_;
  std::map<std::size_t, std::size_t> by_line_;
  std::map<std::string, std::size_t> subs_;
};

}  // namespace contour
