#include "daemon/program/gcode/block_reader.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>

#include "daemon/program/gcode/value_reader.h"

namespace contour {
namespace {

/// Other alphabets, marks of byte order and control characters as the bytes they are.
std::string Shown(char c) {
  if (c > ' ' && c <= '~') return std::string("'") + c + "'";
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "byte 0x%02X",
                static_cast<unsigned>(static_cast<unsigned char>(c)));
  return text.data();
}

// How far ten times a code may be from a whole number.
constexpr double kNearlyTenth = 1e-3;
constexpr double kLargestCode = 1000.0;

// What lines of O words and other controls' macros begin with. None of it begins a word with a value.
constexpr std::string_view kFlow[] = {"while",  "if[", "goto", "then",   "else",  "end",     "do",
                                      "repeat", "sub", "call", "return", "break", "continue"};

bool IsLetter(char c) { return c >= 'a' && c <= 'z'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }

void RefuseFlow(std::string_view rest, const SourcePlace& place) {
  if (rest.size() < 2 || !IsLetter(rest[1])) return;
  for (const std::string_view word : kFlow) {
    if (!rest.starts_with(word)) continue;
    std::string name;
    for (const char c : word)
      if (IsLetter(c)) name += static_cast<char>(c - 'a' + 'A');
    Refuse(place, name +
                      " needs an O word before it, as in: o1 while [#1 lt 5] ... o1 endwhile; macros of "
                      "Fanuc (IF GOTO, WHILE DO END) are not supported");
  }
}

/// LinuxCNC's "$1" and "$[..]" choose a spindle; "$H", "$$", "$110=200" are commands of GRBL.
void RefuseDollar(std::string_view rest, const SourcePlace& place) {
  std::size_t digits = 0;
  while (digits < rest.size() && IsDigit(rest[digits])) ++digits;
  const char next = digits < rest.size() ? rest[digits] : ' ';
  const bool spindle = digits > 0 ? next != '=' : next == '[' || next == '#';
  if (spindle) Refuse(place, "a choice of spindles is not supported");
  Refuse(
      place,
      "a command of GRBL is no G-code: leave the line out; 'contour reference' tells axes where they stand");
}

class BlockReader {
 public:
  BlockReader(LineText& text, const Parameters& parameters, Block& block)
      : text_(text), parameters_(parameters), values_(text, parameters), block_(block) {}

  void Item() {
    const SourcePlace place = text_.place();
    RefuseFlow(text_.Rest(), place);
    const char letter = text_.Take();
    if (letter == '(') return;
    block_.sets_something = true;
    if (letter == '#') {
      Parameter(place);
    } else if (letter == 'g') {
      CodeG(place);
    } else if (letter == 'm') {
      CodeM(place);
    } else if (letter == '@' || letter == '^') {
      Put(letter == '@' ? block_.polar_radius : block_.polar_angle_deg, std::string(1, letter), letter,
          place);
    } else {
      Word(letter, place);
    }
  }

 private:
  void Parameter(const SourcePlace& place) {
    Assignment assignment;
    if (text_.Peek() == '<') {
      assignment.name = values_.Name();
      if (parameters_.IsModal(assignment.name))
        Refuse(place, "parameter #<" + assignment.name + "> cannot be set");
    } else {
      assignment.number = values_.Whole("#");
      if (!Parameters::Assignable(assignment.number))
        Refuse(place, "parameter #" + std::to_string(assignment.number) +
                          " cannot be set: expected #1 to #5000 or #<name>");
    }
    if (!text_.TakeIf('=')) text_.Fail("expected '=' behind the parameter that is to be set");
    assignment.value = values_.Value();
    block_.assignments.push_back(std::move(assignment));
  }

  void CodeG(const SourcePlace& place) {
    const double value = values_.Value();
    const double tenfold = value * 10.0;
    if (value < 0.0 || value >= kLargestCode || std::abs(tenfold - std::round(tenfold)) > kNearlyTenth)
      Refuse(place, "expected a G code with at most one decimal");
    const int code = static_cast<int>(std::lround(tenfold));
    // As with LinuxCNC, G80 gives way to the motion of its block.
    Block::Code& motion = block_.g[kMotion];
    if (code == kNoMotion && motion.code != kNoCode) return;
    const CodeGroup group = GroupOfG(code);
    if (group.known && group.group == kMotion && motion.code == kNoMotion) motion = {};
    Put(group, NameOfG(code), code, place, block_.g);
  }

  void CodeM(const SourcePlace& place) {
    const int code = values_.Whole("M");
    ++block_.m_count;
    Put(GroupOfM(code), "M" + std::to_string(code), code, place, block_.m);
  }

  template <class Groups>
  void Put(const CodeGroup& group, const std::string& name, int code, const SourcePlace& place,
           Groups& groups) {
    if (!group.known) {
      Refuse(place,
             group.refused ? name + " is not supported: " + group.refused : name + " is not supported");
    }
    Block::Code& slot = groups[group.group];
    if (slot.code != kNoCode) Refuse(place, name + ": a second code of the same modal group in this block");
    slot = {code, place.column};
  }

  void Word(char letter, const SourcePlace& place) {
    constexpr std::string_view kLetters = "dfhijklpqrstuvwxyz";
    const std::string name(1, static_cast<char>(letter - 'a' + 'A'));
    if (letter == 'a' || letter == 'b' || letter == 'c')
      Refuse(place, name + ": rotary axes are not supported");
    if (letter == 'e') Refuse(place, "E words are not supported; a number has no exponent");
    if (letter == '$') RefuseDollar(text_.Rest(), place);
    if (kLetters.find(letter) == std::string_view::npos)
      Refuse(place, "found " + Shown(letter) + ", expected a word such as X10");
    Put(block_.words[static_cast<std::size_t>(letter - 'a')], name, letter, place);
  }

  void Put(std::optional<Block::Word>& word, const std::string& name, char letter, const SourcePlace& place) {
    if (word) Refuse(place, "word " + name + " is given twice");
    const double value = values_.Value();
    if (value < 0.0 && (letter == 'f' || letter == 's' || letter == 't' || letter == 'h'))
      Refuse(place, name + ": expected a number that is not negative");
    word = Block::Word{value, place.column};
  }

  LineText& text_;
  const Parameters& parameters_;
  ValueReader values_;
  Block& block_;
};

}  // namespace

void ReadBlock(LineText& text, const Parameters& parameters, const std::string& name, Block& block) {
  block = Block{};
  block.name = &name;
  block.line = text.number();
  BlockReader reader(text, parameters, block);
  while (!text.AtEnd()) reader.Item();
}

bool TakeBlockDelete(LineText& text) { return text.TakeIf('/'); }

void TakeBlockNumber(LineText& text) {
  if (!text.TakeIf('n')) return;
  if (text.Peek() < '0' || text.Peek() > '9') text.Fail("N: expected a block number");
  while ((text.Peek() >= '0' && text.Peek() <= '9') || text.Peek() == '.') text.Skip(1);
}

}  // namespace contour
