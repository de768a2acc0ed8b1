#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "daemon/program/gcode/codes.h"
#include "daemon/program/gcode/parameters.h"
#include "daemon/program/gcode/source_place.h"

namespace contour {

/// The axes a program can name, in the order of coordinates in this folder.
inline constexpr std::string_view kGcodeAxes = "xyzuvw";
inline constexpr std::size_t kGcodeAxisCount = 6;
using AxisValues = std::array<double, kGcodeAxisCount>;

/// A line's words, before anything is done with them.
struct Block {
  struct Word {
    double value = 0.0;
    int column = 0;
  };
  struct Code {
    int code = kNoCode;  ///< G: tenfold
    int column = 0;
  };

  const std::string* name = nullptr;  ///< of the program
  int line = 0;
  bool sets_something = false;
  std::array<std::optional<Word>, 26> words;  ///< per letter, but G, M, N and O
  std::optional<Word> polar_radius;           ///< @
  std::optional<Word> polar_angle_deg;        ///< ^
  std::array<Code, kGGroups> g;
  std::array<Code, kMGroups> m;
  int m_count = 0;
  std::vector<Assignment> assignments;
  int motion = kNoCode;  ///< motion of this block, its own or the modal one: set by CheckBlock

  [[nodiscard]] const std::optional<Word>& Get(char letter) const {
    return words[static_cast<std::size_t>(letter - 'a')];
  }
  [[nodiscard]] bool Has(char letter) const { return Get(letter).has_value(); }
  [[nodiscard]] bool HasAny(std::string_view letters) const {
    for (const char letter : letters)
      if (Has(letter)) return true;
    return false;
  }
  [[nodiscard]] bool IsPolar() const { return polar_radius || polar_angle_deg; }
  [[nodiscard]] int G(GGroup group) const { return g[group].code; }

  [[noreturn]] void FailAt(int column, const std::string& what) const { Refuse({name, line, column}, what); }
  [[noreturn]] void FailAtWord(char letter, const std::string& what) const {
    FailAt(Has(letter) ? Get(letter)->column : 1, what);
  }
  [[noreturn]] void FailAtG(GGroup group, const std::string& what) const { FailAt(g[group].column, what); }
};

}  // namespace contour
