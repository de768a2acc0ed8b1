#include "daemon/program/gcode/tool_table.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>

#include "daemon/program/program.h"

namespace contour {
namespace {

constexpr double kMillimetre_m = 1e-3;
/// More is no table of tools.
constexpr std::uintmax_t kMostBytes = 16'000'000;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr char kExpected[] = "expected a letter and a number, as in T1 P1 Z42.5";

/// One line of the table.
class ToolLine {
 public:
  ToolLine(std::string_view text, std::string where) : text_(text), where_(std::move(where)) {}

  void Into(ToolTable& table) {
    while (SkipBlanks()) Word();
    if (words_ == 0) return;
    if (!tool_) Fail("expected T and the number of a tool");
    if (!table.offsets_m.emplace(*tool_, offsets_m_).second)
      Fail("tool " + std::to_string(*tool_) + " is in the table twice");
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const { throw ProgramError(where_ + ": " + what); }

  bool SkipBlanks() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
    return at_ < text_.size();
  }

  void Word() {
    const char letter = static_cast<char>(std::toupper(static_cast<unsigned char>(text_[at_])));
    ++at_;
    if (letter < 'A' || letter > 'Z') Fail(kExpected);
    double value = 0.0;
    // LinuxCNC writes a sign before lengths.
    if (at_ + 1 < text_.size() && text_[at_] == '+' && text_[at_ + 1] != '-') ++at_;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc() || !std::isfinite(value))
      Fail(std::string(kExpected) + ", found '" + letter + "' without one");
    at_ = static_cast<std::size_t>(end - text_.data());
    ++words_;
    Take(letter, value);
  }

  void Take(char letter, double value) {
    const unsigned bit = 1U << static_cast<unsigned>(letter - 'A');
    if ((seen_ & bit) != 0) Fail(std::string(1, letter) + " is given twice");
    seen_ |= bit;
    constexpr std::string_view kAxes = "XYZUVW";
    if (const std::size_t axis = kAxes.find(letter); axis != kAxes.npos) {
      offsets_m_[axis] = value * kMillimetre_m;
    } else if (letter == 'T') {
      if (value != std::round(value) || value < 0.0 || value > kMostTools)
        Fail("expected T with a whole number from 0 to 99999");
      tool_ = static_cast<int>(value);
    } else if (letter == 'A' || letter == 'B' || letter == 'C') {
      if (value != 0.0) Fail(std::string("a tool's offset along ") + letter + " is not supported");
    } else if (std::string_view("PDIJQ").find(letter) == std::string_view::npos) {
      Fail(std::string("found '") + letter + "', expected T, P, X, Y, Z, U, V, W, D, I, J or Q");
    }
  }

  std::string_view text_;
  std::string where_;
  std::size_t at_ = 0;
  int words_ = 0;
  unsigned seen_ = 0;  ///< letters
  std::optional<int> tool_;
  AxisValues offsets_m_{};
};

}  // namespace

const AxisValues* ToolTable::Find(int tool) const {
  static constexpr AxisValues kNone{};
  const auto found = offsets_m.find(tool);
  if (found != offsets_m.end()) return &found->second;
  return tool == 0 ? &kNone : nullptr;
}

// Blanks may stand within a number, and zeros before it.
bool AsksForLengths(std::string_view program) {
  constexpr std::string_view kBlanks = " \t";
  const auto takes = [&](std::size_t& at, char wanted) {
    at = program.find_first_not_of(kBlanks, at);
    return at != program.npos && program[at] == wanted && ++at > 0;
  };
  for (std::size_t at = program.find_first_of("gG"); at != program.npos;
       at = program.find_first_of("gG", at)) {
    std::size_t digit = ++at;
    while (takes(digit, '0')) {
    }
    if (digit != program.npos && takes(digit, '4') && takes(digit, '3')) return true;
  }
  return false;
}

ToolTable ParseToolTable(std::string_view text, const std::string& name) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  ToolTable table{name};
  int line = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view words = text.substr(0, end);
    words = words.substr(0, words.find(';'));
    ToolLine(words, name + ":" + std::to_string(++line)).Into(table);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return table;
}

std::shared_ptr<const ToolTable> LoadToolTable(const std::filesystem::path& file) {
  if (file.empty()) return nullptr;
  std::error_code none;
  if (std::filesystem::exists(file, none) && !std::filesystem::is_regular_file(file, none))
    throw ProgramError(file.string() + ": expected a file with a table of tools");
  if (const std::uintmax_t bytes = std::filesystem::file_size(file, none); !none && bytes > kMostBytes)
    throw ProgramError(file.string() + ": is larger than a table of tools can be");
  return std::make_shared<const ToolTable>(ParseToolTable(ReadProgramText(file), file.string()));
}

}  // namespace contour
