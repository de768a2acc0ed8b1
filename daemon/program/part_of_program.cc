#include "daemon/program/part_of_program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "daemon/program/program.h"

namespace contour {
namespace {

/// Closer than this the machine stands where the line begins.
constexpr double kSamePlace_m = 1e-6;

std::string Place(const GcodeMoves& moves, const std::array<double, 6>& at_m) {
  std::string text;
  for (std::size_t k = 0; k < moves.letters.size(); ++k) {
    std::array<char, 40> number{};
    std::snprintf(number.data(), number.size(), "%s%c%.4f", text.empty() ? "" : " ", moves.letters[k],
                  1e3 * at_m[k]);
    text += number.data();
  }
  return text;
}

}  // namespace

GcodeMoves FromLine(GcodeMoves moves, const std::string& name, const PartOfProgram& part) {
  if (part.from_line <= 0) return moves;
  const std::string where = name + ":" + std::to_string(part.from_line) + ": ";
  const auto of_line = [&](const GcodeMove& m) { return m.line == part.from_line; };
  auto first = std::find_if(moves.moves.begin(), moves.moves.end(), of_line);
  if (first != moves.moves.end() && first->in_sub)
    throw ProgramError(where + "this line is within a sub: begin at the line that calls it");
  if (first == moves.moves.end())
    first = std::find_if(moves.moves.begin(), moves.moves.end(),
                         [&](const GcodeMove& m) { return m.line > part.from_line && !m.in_sub; });
  if (first == moves.moves.end()) throw ProgramError(where + "nothing moves from this line on");
  const auto skipped = static_cast<std::size_t>(first - moves.moves.begin());
  const std::array<double, 6> begin_m = skipped == 0 ? moves.start_m : (first - 1)->target_m;
  double off_m = 0.0;
  for (std::size_t k = 0; k < moves.letters.size(); ++k)
    off_m = std::hypot(off_m, begin_m[k] - moves.start_m[k]);
  if (off_m > kSamePlace_m && !part.go_there)
    throw ProgramError(where + "it begins at " + Place(moves, begin_m) +
                       " mm from program zero, and the machine stands at " + Place(moves, moves.start_m) +
                       ": move it there, or ask for it (--go-there)");
  moves.moves.erase(moves.moves.begin(), first);
  std::erase_if(moves.events, [&](const GcodeEvent& e) { return e.before_move < skipped; });
  for (GcodeEvent& e : moves.events) e.before_move -= skipped;
  if (off_m == 0.0) return moves;
  GcodeMove there;
  there.kind = GcodeMove::Kind::kRapid;
  there.corner = GcodeMove::Corner::kExactStop;
  there.line = moves.moves.front().line;
  there.target_m = begin_m;
  moves.moves.insert(moves.moves.begin(), there);
  for (GcodeEvent& e : moves.events) ++e.before_move;
  return moves;
}

GcodeMoves WithStops(GcodeMoves moves) {
  for (GcodeMove& move : moves.moves) move.corner = GcodeMove::Corner::kExactStop;
  return moves;
}

}  // namespace contour
