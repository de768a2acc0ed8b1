#include "daemon/program/gcode/block_reader.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

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

class BlockReader {
 public:
  BlockReader(LineText& text, const Parameters& parameters, Block& block)
      : text_(text), parameters_(parameters), values_(text, parameters), block_(block) {}

  void Item() {
    const SourcePlace place = text_.place();
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
    Put(GroupOfG(code), NameOfG(code), code, place, block_.g);
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
    if (letter == '$') Refuse(place, "a choice of spindles is not supported");
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
