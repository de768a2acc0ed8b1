#include "daemon/program/gcode/move_list.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contour {
namespace {

// A loop that does not end is refused before it has filled a disk.
constexpr std::size_t kMostMoves = 4'000'000;
// Radii differ by no more than rounding.
constexpr double kSameRadius_m = 1e-10;
constexpr double kThreeQuarters_rad = 1.5 * std::numbers::pi;

PlanePoint InPlane(const AxisValues& at, const CanonicalMove& move) {
  return {at[move.plane[0]], at[move.plane[1]]};
}

double Distance(const PlanePoint& a, const PlanePoint& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

/// The point nearest to `centre` from which both ends are equally far.
PlanePoint Centred(const PlanePoint& centre, const ArcEnds& ends) {
  const double chord = Distance(ends.from_m, ends.to_m);
  const double along = (Distance(ends.from_m, centre) - Distance(ends.to_m, centre)) *
                       (Distance(ends.from_m, centre) + Distance(ends.to_m, centre)) / (2.0 * chord);
  return {centre[0] - along * (ends.to_m[0] - ends.from_m[0]) / chord,
          centre[1] - along * (ends.to_m[1] - ends.from_m[1]) / chord};
}

}  // namespace

void MoveList::Use(std::size_t axis, int line) {
  if (used_[axis] == 0) used_[axis] = line;
}

GcodeMove MoveList::NewMove(const CanonicalMove& canonical, GcodeMove::Kind kind) {
  GcodeMove move;
  move.kind = kind;
  move.line = canonical.line;
  move.in_sub = canonical.in_sub;
  move.corner = canonical.corner;
  move.tolerance_m = canonical.tolerance_m;
  move.target_m = canonical.target_m;
  return move;
}

void MoveList::Push(GcodeMove move, int line) {
  if (list_.moves.size() >= kMostMoves) {
    throw ProgramError(name_ + ":" + std::to_string(line) + ": more than " + std::to_string(kMostMoves) +
                       " moves");
  }
  for (std::size_t k = 0; k < kGcodeAxisCount; ++k)
    if (move.target_m[k] != at_m_[k]) Use(k, line);
  at_m_ = move.target_m;
  list_.moves.push_back(move);
}

void MoveList::Add(const CanonicalMove& canonical) {
  for (std::size_t k = 0; k < kGcodeAxisCount; ++k)
    if ((canonical.named >> k & 1U) != 0) Use(k, canonical.line);
  if (canonical.named != 0) named_line_ = canonical.line;
  switch (canonical.kind) {
    case CanonicalMove::Kind::kTraverse:
    case CanonicalMove::Kind::kFeed:
      AddStraight(canonical);
      break;
    case CanonicalMove::Kind::kArc:
      AddArc(canonical);
      break;
    case CanonicalMove::Kind::kDwell: {
      naive_cam_.Break();
      GcodeMove move = NewMove(canonical, GcodeMove::Kind::kDwell);
      move.dwell_s = canonical.dwell_s;
      Push(move, canonical.line);
      break;
    }
    case CanonicalMove::Kind::kEvent: {
      naive_cam_.Break();
      GcodeEvent event = canonical.event;
      event.before_move = list_.moves.size();
      if (event.holds() && !list_.moves.empty()) list_.moves.back().corner = GcodeMove::Corner::kExactStop;
      list_.events.push_back(event);
      break;
    }
  }
}

void MoveList::AddStraight(const CanonicalMove& canonical) {
  const bool rapid = canonical.kind == CanonicalMove::Kind::kTraverse;
  if (canonical.target_m == at_m_) return;
  GcodeMove move = NewMove(canonical, rapid ? GcodeMove::Kind::kRapid : GcodeMove::Kind::kLine);
  double xyz = 0.0, uvw = 0.0;
  for (std::size_t k = 0; k < kGcodeAxisCount; ++k)
    (k < 3 ? xyz : uvw) += std::pow(canonical.target_m[k] - at_m_[k], 2);
  if (!rapid) move.feed_m_s = canonical.feed_m_s * (xyz > 0.0 ? std::sqrt(1.0 + uvw / xyz) : 1.0);
  if (!naive_cam_.Joins(at_m_, move, JoinsWithin_m(canonical))) return Push(move, canonical.line);
  GcodeMove& longer = list_.moves.back();
  longer.line = move.line;
  longer.in_sub = longer.in_sub || move.in_sub;
  longer.target_m = at_m_ = move.target_m;
}

// Who begins at a line has to stand where that line begins.
double MoveList::JoinsWithin_m(const CanonicalMove& canonical) {
  const int begin = settings_.begins_at_line;
  if (begin > 0 && !list_.moves.empty()) {
    const GcodeMove& last = list_.moves.back();
    if ((last.line < begin) != (canonical.line < begin) || last.line == begin || canonical.line == begin ||
        last.in_sub != canonical.in_sub)
      naive_cam_.Break();
  }
  return settings_.joins_lines ? canonical.naive_cam_m : 0.0;
}

/// As LinuxCNC has it, an arc in XY that is nearer to its chord than Q is two straight moves, which may be
/// joined with others.
bool MoveList::AddAsLines(const CanonicalMove& canonical, double sweep_rad) {
  if (std::abs(canonical.turns) > 1) return false;  // its middle may be where it begins
  const bool blends =
      canonical.corner == GcodeMove::Corner::kBlended || canonical.corner == GcodeMove::Corner::kContinuous;
  const double within_m = JoinsWithin_m(canonical);
  if (!blends || within_m <= 0.0 || canonical.plane[0] != 0 || canonical.plane[1] != 1) return false;
  const PlanePoint from = InPlane(at_m_, canonical);
  const double radius_m = Distance(from, canonical.centre_m);
  if (radius_m * (1.0 - std::cos(std::min(0.5 * std::abs(sweep_rad), std::numbers::pi))) >= within_m)
    return false;
  const double c = std::cos(0.5 * sweep_rad), s = std::sin(0.5 * sweep_rad);
  const double dx = from[0] - canonical.centre_m[0], dy = from[1] - canonical.centre_m[1];
  CanonicalMove half = canonical;
  half.kind = CanonicalMove::Kind::kFeed;
  for (std::size_t k = 0; k < kGcodeAxisCount; ++k)
    half.target_m[k] = 0.5 * (at_m_[k] + canonical.target_m[k]);
  half.target_m[0] = canonical.centre_m[0] + c * dx - s * dy;
  half.target_m[1] = canonical.centre_m[1] + s * dx + c * dy;
  AddStraight(half);
  half.target_m = canonical.target_m;
  AddStraight(half);
  return true;
}

/// A circle of two radii is what a program with few decimals asks for. Up to three quarters of a turn it
/// becomes the arc through both ends about the nearest centre; a longer one ends in half a turn about a
/// centre on the line from the old one to where that half begins, so that it goes on smoothly and meets the
/// end.
void MoveList::AddArc(const CanonicalMove& canonical) {
  Use(canonical.plane[0], canonical.line);
  Use(canonical.plane[1], canonical.line);
  const PlanePoint& centre = canonical.centre_m;
  const ArcEnds ends{InPlane(at_m_, canonical), InPlane(canonical.target_m, canonical), canonical.turns > 0};
  const double sweep = SweepOf_rad(ends, centre, canonical.turns);
  if (AddAsLines(canonical, sweep)) return;
  naive_cam_.Break();
  const double from = Distance(ends.from_m, centre), to = Distance(ends.to_m, centre);
  if (std::abs(from - to) <= kSameRadius_m) return AddPart(canonical, centre, sweep, canonical.target_m);
  if (std::abs(sweep) <= kThreeQuarters_rad) {
    const PlanePoint better = Centred(centre, ends);
    return AddPart(canonical, better, SweepOf_rad(ends, better, canonical.turns), canonical.target_m);
  }
  const double half = std::copysign(std::numbers::pi, sweep);
  // Half a turn before its end, on the first radius.
  const double scale = from / to;
  const PlanePoint begin = {centre[0] - scale * (ends.to_m[0] - centre[0]),
                            centre[1] - scale * (ends.to_m[1] - centre[1])};
  AxisValues between = canonical.target_m;
  for (std::size_t k = 0; k < kGcodeAxisCount; ++k)
    between[k] -= (canonical.target_m[k] - at_m_[k]) * half / sweep;
  between[canonical.plane[0]] = begin[0];
  between[canonical.plane[1]] = begin[1];
  CanonicalMove first = canonical;
  first.corner = GcodeMove::Corner::kExactPath;
  AddPart(first, centre, sweep - half, between);
  AddPart(canonical, {0.5 * (begin[0] + ends.to_m[0]), 0.5 * (begin[1] + ends.to_m[1])}, half,
          canonical.target_m);
}

void MoveList::AddPart(const CanonicalMove& canonical, const PlanePoint& centre_m, double sweep_rad,
                       const AxisValues& end_m) {
  GcodeMove move = NewMove(canonical, GcodeMove::Kind::kArc);
  move.target_m = end_m;
  move.plane = canonical.plane;
  move.centre_m = centre_m;
  move.sweep_rad = sweep_rad;
  double tool = std::pow(Distance(InPlane(at_m_, canonical), centre_m) * sweep_rad, 2), others = 0.0;
  for (std::size_t k = 0; k < kGcodeAxisCount; ++k) {
    if (k == canonical.plane[0] || k == canonical.plane[1]) continue;
    (k < 3 ? tool : others) += std::pow(end_m[k] - at_m_[k], 2);
  }
  move.feed_m_s = canonical.feed_m_s * std::sqrt(1.0 + others / tool);
  Push(move, canonical.line);
}

/// Coordinates of the letters in use side by side.
void MoveList::Pack() {
  MoveTape::Places place{};
  for (std::size_t k = 0; k < kGcodeAxisCount; ++k) {
    if (used_[k] == 0) continue;
    place[k] = static_cast<std::uint8_t>(list_.letters.size());
    list_.letters += static_cast<char>(kGcodeAxes[k] - 'a' + 'A');
    list_.letter_lines.push_back(used_[k]);
  }
  list_.start_m = {};
  for (std::size_t k = 0; k < kGcodeAxisCount; ++k)
    if (place[k]) list_.start_m[*place[k]] = start_m_[k];
  list_.moves.Arrange(place);
}

GcodeMoves MoveList::Finish() {
  if (list_.moves.empty() && named_line_ != 0) {
    // It is there already, as after a pass before this one.
    GcodeMove stay;
    stay.kind = GcodeMove::Kind::kDwell;
    stay.line = named_line_;
    stay.target_m = at_m_;
    list_.moves.push_back(stay);
  }
  if (list_.moves.empty()) throw ProgramError(name_ + ": the program does not move");
  Pack();
  return std::move(list_);
}

}  // namespace contour
