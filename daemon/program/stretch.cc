#include "daemon/program/stretch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace contour {
namespace {

// Moves that are fitted at once; more of them where that is not enough to settle a knot.
constexpr std::size_t kAtOnce = 256;
// Breaks of the path that are to come behind a knot before it is settled: what lies farther ahead does not
// change it any more, as spacing changes along the path by half of the way at most.
constexpr std::size_t kAhead = 24;
// The path itself changes with as many knots behind it.
constexpr std::size_t kReach = 3;

// An arc of any number of turns comes in parts of a quarter of a turn, so that as much is fitted at once.
constexpr double kAtOnce_rad = 0.5 * std::numbers::pi;
// No part of a part is left over for rounding.
constexpr double kLastPart = 1.5;

// CheckRange() lets a move go so much farther, for the rounding of its numbers.
constexpr double kRounding_m = 1e-9;

// CheckRange() also lets an axis that stands beyond its limits come back from there.
Extent TravelOf(const PerAxis<PlanLimits>& limits, const std::vector<ProgrammedMove>& moves) {
  Extent travel;
  for (const PlanLimits& l : limits) {
    travel.min_m.push_back(l.position_min_m - kRounding_m);
    travel.max_m.push_back(l.position_max_m + kRounding_m);
  }
  for (const ProgrammedMove& m : moves) {
    const CurvePoint begin = PointAt(m.curve, 0.0);
    for (std::size_t i = 0; i < limits.size(); ++i) {
      travel.min_m[i] = std::min(travel.min_m[i], begin.position_m[i]);
      travel.max_m[i] = std::max(travel.max_m[i], begin.position_m[i]);
    }
  }
  return travel;
}

bool WithinCorner(const std::vector<LoneCorner>& corners, double way_m) {
  return std::any_of(corners.begin(), corners.end(), [&](const LoneCorner& c) {
    return way_m > c.at_m - c.outer_m && way_m < c.at_m + c.outer_m;
  });
}

/// The last knot that what is still unknown behind the path cannot change; `fixed`: the last one before.
std::size_t LastSettledKnot(const ProgrammedPath& path, const SmoothFit& fit, std::size_t fixed) {
  const std::vector<double>& knots = fit.path.knots_m();
  if (knots.size() < fixed + kAhead + 4) return fixed;
  const double last_move_m = path.begin_m(path.size() - 1);
  for (std::size_t i = knots.size() - 4 - kAhead; i > fixed; --i)
    if (knots[i] <= last_move_m && !WithinCorner(fit.corners, knots[i])) return i;
  return fixed;
}

}  // namespace

Stretch::Stretch(std::shared_ptr<const StretchProgram> program, std::size_t part)
    : program_(std::move(program)),
      part_(program_->parts()[part]),
      limits_(std::make_shared<const PerAxis<PlanLimits>>(program_->LimitsOf(part_))) {
  front_ = std::make_shared<const Front>(Front{{}, 0.0, part_.first, 0.0, {}});
}

void Stretch::TakeMoves(Front& front, std::size_t count) const {
  for (std::size_t i = 0; i < count && front.next < part_.end; ++i) {
    ProgrammedMove move = program_->moves().Move(front.next);
    const double length_m = move.curve.length_m, from_m = front.next_from_m;
    const double part_m = length_m * kAtOnce_rad / std::abs(move.curve.sweep_rad);
    const bool ends = move.curve.radius_m == 0.0 || length_m - from_m <= kLastPart * part_m;
    if (!ends || from_m > 0.0) move.curve = PartOfArc(move.curve, from_m, ends ? length_m : from_m + part_m);
    front.moves.push_back(std::move(move));
    front.next += ends ? 1 : 0;
    front.next_from_m = ends ? 0.0 : from_m + part_m;
  }
}

void Stretch::Extend() {
  if (!front_) return;
  Front front = *front_;
  for (;;) {
    TakeMoves(front, std::max(kAtOnce, front.moves.size()));
    const ProgrammedPath path(front.moves, front.from_m, TravelOf(limits(), front.moves));
    const SmoothFit fit = SmoothPathThrough(path, front.fixed);
    const std::size_t first = front.fixed.settled;
    const std::vector<double>& knots = fit.path.knots_m();
    if (front.next == part_.end) {
      AddSection(path, fit.path, first, knots.size() - 4);
      front_ = nullptr;
      return;
    }
    const std::size_t fixed = LastSettledKnot(path, fit, front.fixed.knots_m.size() - 1);
    if (fixed < first + kReach + 1) continue;
    const std::size_t last = fixed - kReach;
    AddSection(path, fit.path, first, last);
    // One piece before what is settled too: its coefficients are made of what is left of it.
    const auto knot = [&](std::size_t i) { return knots.begin() + static_cast<std::ptrdiff_t>(i); };
    front.fixed = {std::vector<double>(knot(last - 4), knot(fixed + 1)), 4};
    std::size_t kept = 0;
    while (path.begin_m(kept + 1) < front.fixed.knots_m.front()) ++kept;
    front.from_m = path.begin_m(kept);
    front.moves.erase(front.moves.begin(), front.moves.begin() + static_cast<std::ptrdiff_t>(kept));
    front_ = std::make_shared<const Front>(std::move(front));
    return;
  }
}

void Stretch::AddSection(const ProgrammedPath& path, const SmoothPath& smooth, std::size_t first,
                         std::size_t last) {
  const double from_m = smooth.knots_m()[first], to_m = smooth.knots_m()[last];
  std::vector<Words> words;
  for (std::size_t i = path.MoveAt(from_m); i < path.size() && (words.empty() || path.begin_m(i) <= to_m);
       ++i) {
    const ProgrammedMove& m = path.move(i);
    words.push_back({path.begin_m(i), m.feed_m_s, m.line});
  }
  words.shrink_to_fit();
  sections_.push_back(
      std::make_shared<const Section>(Section{from_m, to_m, smooth.Between(first, last), std::move(words)}));
}

void Stretch::ForgetBefore(double way_m) {
  while (sections_.size() > 1 && sections_.front()->to_m < way_m) sections_.pop_front();
}

const Stretch::Section& Stretch::SectionAt(double way_m) const {
  const auto after = std::upper_bound(sections_.begin(), sections_.end() - 1, way_m,
                                      [](double m, const auto& s) { return m < s->to_m; });
  return **after;
}

const Stretch::Words& Stretch::WordsAt(double way_m) const {
  const std::vector<Words>& words = SectionAt(way_m).words;
  const auto after = std::upper_bound(words.begin() + 1, words.end(), way_m,
                                      [](double m, const Words& w) { return m < w.from_m; });
  return *(after - 1);
}

PathDerivatives Stretch::At(double way_m) const { return At(way_m, way_m); }

PathDerivatives Stretch::At(double way_m, double within_m) const {
  const SmoothPath& path = SectionAt(within_m).path;
  return path.At(way_m, path.PieceAt(within_m));
}

std::vector<double> Stretch::Jumps_m(double from_m, double to_m) const {
  std::vector<double> ways;
  const auto add = [&](double way_m) {
    if (way_m > from_m && way_m < to_m) ways.push_back(way_m);
  };
  for (const auto& section : sections_) {
    if (section->to_m <= from_m || section->from_m >= to_m) continue;
    for (std::size_t i = 0; i < section->path.pieces(); ++i) add(section->path.break_m(i));
    const std::vector<Words>& words = section->words;
    for (std::size_t i = 1; i < words.size(); ++i)
      if (words[i].feed_m_s != words[i - 1].feed_m_s) add(words[i].from_m);
  }
  std::sort(ways.begin(), ways.end());
  return ways;
}

PerAxis<double> Stretch::EndTangent() const {
  const CurvePiece last = program_->moves().Curve(part_.end - 1);
  return PointAt(last, last.length_m).tangent;
}

double Stretch::EndFeed_m_s() const { return program_->moves().Move(part_.end - 1).feed_m_s; }

std::size_t Stretch::moves_kept() const {
  std::size_t moves = front_ ? front_->moves.size() : 0;
  for (const auto& section : sections_) moves += section->words.size();
  return moves;
}

}  // namespace contour
