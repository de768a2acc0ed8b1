#include "daemon/program/gcode_parser.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "daemon/program/program.h"

namespace contour {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr double kInch_m = 0.0254;
constexpr double kMillimetre_m = 1e-3;
// How far an arc's end may lie off the circle through its start: half a hundredth of a millimetre, or a
// thousandth of the radius, as programs come with a few decimals.
constexpr double kArcMismatch_m = 5e-6;
constexpr double kArcMismatch_rel = 1e-3;
constexpr std::string_view kAxisLetters = "XYZABCUVW";

struct Word {
  char letter = 0;
  double value = 0.0;
};

struct Block {
  int line = 0;
  std::vector<Word> words;

  [[nodiscard]] std::optional<double> Get(char letter) const {
    for (const Word& w : words) {
      if (w.letter == letter) return w.value;
    }
    return std::nullopt;
  }
};

bool IsAxis(char letter) { return kAxisLetters.find(letter) != std::string_view::npos; }

std::string Text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end.ptr};
}

std::string Text(const Word& word) { return word.letter + Text(word.value); }

/// One line into words. Comments in parentheses or after a semicolon, a leading slash and N words are
/// dropped; blanks mean nothing.
class BlockReader {
 public:
  BlockReader(std::string_view line, int number, const std::string& name) : number_(number), name_(name) {
    for (std::size_t i = 0; i < line.size() && line[i] != ';'; ++i) {
      if (line[i] == '(') {
        i = line.find(')', i);
        if (i == std::string_view::npos) Fail("comment is not closed");
      } else if (line[i] != ' ' && line[i] != '\t' && line[i] != '\r') {
        const char c = line[i];
        text_ += static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
      }
    }
  }

  Block Read() {
    Block block{number_, {}};
    while (at_ < text_.size()) {
      const Word word = ReadWord();
      if (word.letter == 'N') continue;
      const bool repeats = word.letter != 'G' && word.letter != 'M' && block.Get(word.letter);
      if (repeats) Fail(std::string("word ") + word.letter + " is given twice");
      block.words.push_back(word);
    }
    return block;
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    throw ProgramError(name_ + ":" + std::to_string(number_) + ": " + what);
  }

  Word ReadWord() {
    const char letter = text_[at_++];
    if (letter < 'A' || letter > 'Z')
      Fail(std::string("found '") + letter + "', expected a word such as X10");
    if (at_ < text_.size() && text_[at_] == '+') ++at_;
    double value = 0.0;
    const auto end =
        std::from_chars(text_.data() + at_, text_.data() + text_.size(), value, std::chars_format::fixed);
    if (end.ec != std::errc{} || !std::isfinite(value))
      Fail(std::string("a number is missing after ") + letter);
    at_ = static_cast<std::size_t>(end.ptr - text_.data());
    return {letter, value};
  }

  std::string text_;
  std::size_t at_ = 0;
  int number_;
  const std::string& name_;
};

class Interpreter {
 public:
  Interpreter(std::string letters, const std::string& name) : name_(name) {
    program_.letters = std::move(letters);
    position_m_.assign(program_.letters.size(), 0.0);
  }

  void Execute(const Block& block) {
    line_ = block.line;
    motion_in_block_.reset();
    dwell_ = false;
    path_control_.reset();
    for (const Word& word : block.words) Modal(word);
    const bool g64 = path_control_ == GcodeMove::Corner::kContinuous;
    if (block.Get('P') && !dwell_ && !g64) Fail("P belongs to G4 and G64");
    if (block.Get('P') && dwell_ && g64) Fail("G4 and G64 in the same block");
    if (g64) Tolerance(block);
    if (dwell_) {
      Dwell(block);
    } else if (HasAxisWord(block)) {
      Move(block);
    } else if (motion_in_block_ && (*motion_in_block_ == 2 || *motion_in_block_ == 3)) {
      // A full circle may name its centre only.
      Move(block);
    }
  }

  GcodeMoves Finish() {
    if (program_.moves.empty()) throw ProgramError(name_ + ": the program does not move");
    return std::move(program_);
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    throw ProgramError(name_ + ":" + std::to_string(line_) + ": " + what);
  }

  static bool HasAxisWord(const Block& block) {
    return std::any_of(block.words.begin(), block.words.end(),
                       [](const Word& w) { return IsAxis(w.letter); });
  }

  void Modal(const Word& word) {
    if (word.letter == 'G') {
      ModalG(word);
    } else if (word.letter == 'M') {
      if (word.value != 2.0 && word.value != 30.0) Fail(Text(word) + " is not supported");
    } else if (word.letter == 'F') {
      if (!(word.value > 0.0)) Fail("F: expected a feed above zero");
      feed_ = word.value;
    } else if (!IsAxis(word.letter) && std::string_view("IJRP").find(word.letter) == std::string_view::npos) {
      Fail(Text(word) + " is not supported");
    }
  }

  void ModalG(const Word& word) {
    // G61.1 is the only code with a decimal; codes beyond the table are refused below.
    const double tenfold = word.value * 10.0;
    const bool known_form = std::abs(tenfold) < 10000.0 && std::abs(tenfold - std::round(tenfold)) < 1e-6;
    switch (known_form ? static_cast<int>(std::lround(tenfold)) : -1) {
      case 0:
      case 10:
      case 20:
      case 30:
        if (motion_in_block_) Fail(Text(word) + ": a second motion in the same block");
        motion_ = static_cast<int>(word.value);
        motion_in_block_ = motion_;
        return;
      case 40:
        dwell_ = true;
        return;
      case 170:  // plane XY: the only one
      case 940:  // feed per minute: the only one
        return;
      case 200:
        unit_m_ = kInch_m;
        return;
      case 210:
        unit_m_ = kMillimetre_m;
        return;
      case 610:
        PathControl(word, GcodeMove::Corner::kExactPath);
        return;
      case 611:
        PathControl(word, GcodeMove::Corner::kExactStop);
        return;
      case 640:
        PathControl(word, GcodeMove::Corner::kContinuous);
        return;
      case 900:
        absolute_ = true;
        return;
      case 910:
        absolute_ = false;
        return;
      default:
        Fail(Text(word) + " is not supported");
    }
  }

  void PathControl(const Word& word, GcodeMove::Corner corner) {
    if (path_control_) Fail(Text(word) + ": a second path control in the same block");
    path_control_ = corner;
    corner_ = corner;
  }

  /// G64: full feed through corners, or with P: blended within P, in the units in force.
  void Tolerance(const Block& block) {
    const std::optional<double> tolerance = block.Get('P');
    if (!tolerance) return;
    if (!(*tolerance > 0.0)) Fail("G64: expected P with a tolerance above zero");
    corner_ = GcodeMove::Corner::kBlended;
    tolerance_m_ = *tolerance * unit_m_;
  }

  void Dwell(const Block& block) {
    const std::optional<double> seconds = block.Get('P');
    if (!seconds || *seconds < 0.0) Fail("G4: expected P with a time in seconds");
    if (HasAxisWord(block) || motion_in_block_) Fail("G4: a motion in the same block");
    GcodeMove move = NewMove(GcodeMove::Kind::kDwell, position_m_);
    move.dwell_s = *seconds;
    program_.moves.push_back(move);
  }

  GcodeMove NewMove(GcodeMove::Kind kind, const std::vector<double>& target_m) const {
    GcodeMove move;
    move.kind = kind;
    move.line = line_;
    move.target_m = target_m;
    move.corner = corner_;
    if (corner_ == GcodeMove::Corner::kBlended) move.tolerance_m = tolerance_m_;
    return move;
  }

  std::vector<double> Target(const Block& block) const {
    std::vector<double> target = position_m_;
    for (std::size_t k = 0; k < target.size(); ++k) {
      if (const auto value = block.Get(program_.letters[k])) {
        target[k] = (absolute_ ? 0.0 : position_m_[k]) + *value * unit_m_;
      }
    }
    return target;
  }

  void Move(const Block& block) {
    if (!motion_) Fail("a position without G0, G1, G2 or G3 before it");
    const std::vector<double> target = Target(block);
    const bool arc = *motion_ == 2 || *motion_ == 3;
    if (!arc && (block.Get('I') || block.Get('J') || block.Get('R'))) Fail("I, J and R belong to G2 and G3");
    if (*motion_ != 0 && !feed_) Fail("a feed (F) is missing");
    if (arc) {
      Arc(block, target);
    } else if (target != position_m_) {
      GcodeMove move = NewMove(*motion_ == 0 ? GcodeMove::Kind::kRapid : GcodeMove::Kind::kLine, target);
      move.feed_m_s = Feed_m_s();
      program_.moves.push_back(move);
    }
    position_m_ = target;
  }

  [[nodiscard]] double Feed_m_s() const { return feed_.value_or(0.0) * unit_m_ / 60.0; }

  void Arc(const Block& block, const std::vector<double>& target) {
    for (std::size_t k = 2; k < target.size(); ++k) {
      if (target[k] != position_m_[k]) Fail("helical arcs are not supported");
    }
    const bool ccw = *motion_ == 3;
    const bool centre = block.Get('I') || block.Get('J');
    if (centre == block.Get('R').has_value()) Fail("an arc takes either I and J, or R");
    GcodeMove move = NewMove(GcodeMove::Kind::kArc, target);
    move.feed_m_s = Feed_m_s();
    move.centre_m =
        centre ? CentreByOffset(block, target) : CentreByRadius(*block.Get('R') * unit_m_, target, ccw);
    move.sweep_rad = Sweep(move.centre_m, target, ccw);
    program_.moves.push_back(move);
  }

  std::array<double, 2> CentreByOffset(const Block& block, const std::vector<double>& target) const {
    const double i = block.Get('I').value_or(0.0) * unit_m_;
    const double j = block.Get('J').value_or(0.0) * unit_m_;
    const double radius = std::hypot(i, j);
    const std::array<double, 2> centre = {position_m_[0] + i, position_m_[1] + j};
    if (radius == 0.0) Fail("the arc's radius is zero");
    const double at_end = std::hypot(target[0] - centre[0], target[1] - centre[1]);
    if (std::abs(at_end - radius) > std::max(kArcMismatch_m, kArcMismatch_rel * radius)) {
      Fail("the arc's end is " + Text(at_end * 1e3) + " mm from its centre, its start " + Text(radius * 1e3) +
           " mm");
    }
    return centre;
  }

  /// R positive: the arc of at most half a turn; negative: the longer one.
  std::array<double, 2> CentreByRadius(double radius, const std::vector<double>& target, bool ccw) const {
    const double dx = target[0] - position_m_[0];
    const double dy = target[1] - position_m_[1];
    const double chord = std::hypot(dx, dy);
    if (chord == 0.0) Fail("an arc with R needs an end other than its start; use I and J for a full circle");
    const double height_squared = radius * radius - 0.25 * chord * chord;
    if (height_squared < -kArcMismatch_rel * radius * radius) {
      Fail("R " + Text(std::abs(radius) * 1e3) + " mm is too small for an arc over " + Text(chord * 1e3) +
           " mm");
    }
    const double height = std::sqrt(std::max(0.0, height_squared));
    const double side = ccw == (radius > 0.0) ? 1.0 : -1.0;
    return {position_m_[0] + 0.5 * dx - side * height * dy / chord,
            position_m_[1] + 0.5 * dy + side * height * dx / chord};
  }

  double Sweep(const std::array<double, 2>& centre, const std::vector<double>& target, bool ccw) const {
    if (target[0] == position_m_[0] && target[1] == position_m_[1]) return ccw ? kTurn_rad : -kTurn_rad;
    const double from = std::atan2(position_m_[1] - centre[1], position_m_[0] - centre[0]);
    const double to = std::atan2(target[1] - centre[1], target[0] - centre[0]);
    const double sweep = std::remainder(to - from, kTurn_rad);
    if (ccw) return sweep > 0.0 ? sweep : sweep + kTurn_rad;
    return sweep < 0.0 ? sweep : sweep - kTurn_rad;
  }

  const std::string& name_;
  GcodeMoves program_;
  std::vector<double> position_m_;
  std::optional<int> motion_;
  std::optional<double> feed_;  ///< in units per minute, as written
  double unit_m_ = kMillimetre_m;
  bool absolute_ = true;
  GcodeMove::Corner corner_ = GcodeMove::Corner::kContinuous;
  double tolerance_m_ = 0.0;  ///< of G64 P
  // Of the block at work:
  int line_ = 0;
  std::optional<int> motion_in_block_;
  bool dwell_ = false;
  std::optional<GcodeMove::Corner> path_control_;
};

bool EndsProgram(const Block& block) {
  return std::any_of(block.words.begin(), block.words.end(),
                     [](const Word& w) { return w.letter == 'M' && (w.value == 2.0 || w.value == 30.0); });
}

/// Up to and including the block that ends the program (M2, M30).
std::vector<Block> ReadBlocks(std::string_view text, const std::string& name) {
  std::vector<Block> blocks;
  int number = 0;
  while (!text.empty()) {
    ++number;
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    const bool frame = line.find_first_not_of(" \t\r%") == std::string_view::npos;
    if (!frame) blocks.push_back(BlockReader(line, number, name).Read());
    if (!blocks.empty() && EndsProgram(blocks.back())) break;
  }
  return blocks;
}

bool HasArc(const Block& block) {
  return std::any_of(block.words.begin(), block.words.end(),
                     [](const Word& w) { return w.letter == 'G' && (w.value == 2.0 || w.value == 3.0); });
}

/// Axis letters in use, X and Y first; arcs need both.
std::string LettersOf(const std::vector<Block>& blocks) {
  const bool arcs = std::any_of(blocks.begin(), blocks.end(), HasArc);
  std::string letters;
  for (const char letter : kAxisLetters) {
    const bool named =
        std::any_of(blocks.begin(), blocks.end(), [&](const Block& b) { return b.Get(letter); });
    if (named || (arcs && (letter == 'X' || letter == 'Y'))) letters += letter;
  }
  return letters;
}

}  // namespace

GcodeMoves ParseGcode(std::string_view text, const std::string& name) {
  const std::vector<Block> blocks = ReadBlocks(text, name);
  Interpreter interpreter(LettersOf(blocks), name);
  for (const Block& block : blocks) interpreter.Execute(block);
  return interpreter.Finish();
}

}  // namespace contour
