#include "daemon/program/gcode/canonical_text.h"

#include <array>
#include <cstdio>

namespace contour {
namespace {

constexpr double kMillimetres = 1e3;
constexpr double kPerMinute = 60e3;  // mm/min in a m/s

std::string Number(const char* before, double value) {
  std::array<char, 64> text{};
  // Minus zero is zero.
  std::snprintf(text.data(), text.size(), "%.9f", value + 0.0);
  return before + std::string(text.data());
}

std::string Target(const CanonicalMove& move) {
  std::string text;
  for (std::size_t k = 0; k < kGcodeAxisCount; ++k) {
    const char name[] = {' ', static_cast<char>(kGcodeAxes[k] - 'a' + 'A'), '\0'};
    text += Number(name, move.target_m[k] * kMillimetres);
  }
  return text;
}

std::string Corner(const CanonicalMove& move) {
  switch (move.corner) {
    case GcodeMove::Corner::kExactPath:
      return " G61";
    case GcodeMove::Corner::kExactStop:
      return " G61.1";
    case GcodeMove::Corner::kContinuous:
      return " G64";
    case GcodeMove::Corner::kBlended:
      break;
  }
  return Number(" G64 P", move.tolerance_m * kMillimetres);
}

std::string Arc(const CanonicalMove& move) {
  const char* plane = move.plane[0] == 0 ? " G17" : move.plane[0] == 2 ? " G18" : " G19";
  return plane + Number(" centre ", move.centre_m[0] * kMillimetres) +
         Number(" ", move.centre_m[1] * kMillimetres) + " turns " + std::to_string(move.turns);
}

std::string Event(const GcodeEvent& event) {
  if (event.letter == 'M') return "M" + std::to_string(event.code);
  return Number(std::string(1, event.letter).c_str(), event.value);
}

}  // namespace

void AppendCanonical(const CanonicalMove& move, std::string& lines) {
  lines += std::to_string(move.line);
  switch (move.kind) {
    case CanonicalMove::Kind::kTraverse:
      lines += " STRAIGHT_TRAVERSE" + Target(move) + Corner(move);
      break;
    case CanonicalMove::Kind::kFeed:
      lines += " STRAIGHT_FEED" + Target(move) + Number(" F", move.feed_m_s * kPerMinute) + Corner(move);
      break;
    case CanonicalMove::Kind::kArc:
      lines +=
          " ARC_FEED" + Target(move) + Arc(move) + Number(" F", move.feed_m_s * kPerMinute) + Corner(move);
      break;
    case CanonicalMove::Kind::kDwell:
      lines += " DWELL" + Number(" P", move.dwell_s);
      break;
    case CanonicalMove::Kind::kEvent:
      lines += " EVENT " + Event(move.event);
      break;
  }
  lines += '\n';
}

}  // namespace contour
