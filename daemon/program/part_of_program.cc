#include "daemon/program/part_of_program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

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
  // The line itself, else the next one that moves.
  std::optional<std::size_t> first;
  for (auto move = moves.moves.begin(); move != moves.moves.end(); ++move) {
    if (move->line == part.from_line) {
      if (move->in_sub)
        throw ProgramError(where + "this line is within a sub: begin at the line that calls it");
      first = move.index();
      break;
    }
    if (!first && move->line > part.from_line && !move->in_sub) first = move.index();
  }
  if (!first) throw ProgramError(where + "nothing moves from this line on");
  const std::size_t skipped = *first;
  const std::array<double, 6> begin_m = skipped == 0 ? moves.start_m : moves.moves[skipped - 1].target_m;
  double off_m = 0.0;
  for (std::size_t k = 0; k < moves.letters.size(); ++k)
    off_m = std::hypot(off_m, begin_m[k] - moves.start_m[k]);
  if (off_m > kSamePlace_m && !part.go_there)
    throw ProgramError(where + "it begins at " + Place(moves, begin_m) +
                       " mm from program zero, and the machine stands at " + Place(moves, moves.start_m) +
                       ": move it there, or ask for it (--go-there)");
  MoveTape rest;
  if (off_m != 0.0) {
    GcodeMove there;
    there.kind = GcodeMove::Kind::kRapid;
    there.corner = GcodeMove::Corner::kExactStop;
    there.line = moves.moves[skipped].line;
    there.target_m = begin_m;
    rest.push_back(there);
  }
  const std::size_t added = rest.size();
  for (auto move = moves.moves.From(skipped); move != moves.moves.end(); ++move) rest.push_back(*move);
  moves.moves = std::move(rest);
  std::erase_if(moves.events, [&](const GcodeEvent& e) { return e.before_move < skipped; });
  for (GcodeEvent& e : moves.events) e.before_move += added - skipped;
  return moves;
}

GcodeMoves WithStops(GcodeMoves moves) {
  moves.moves.StopAfterAll();
  return moves;
}

}  // namespace contour
