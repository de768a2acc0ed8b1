#include "daemon/program/pace_law.h"

#include <algorithm>

namespace contour {

// On the ramp the rate is the cubic with from.rate and from.change at its beginning, `to` and no change at
// its end.
PaceState PaceLaw::On(const Piece& p, double index) {
  const double since = index - p.begin;
  if (p.length <= 0.0) return {p.from.time + p.to * since, p.to, 0.0, p.held};
  const double slope = p.length * p.from.change;
  const double u = std::min(1.0, std::max(0.0, since / p.length));
  const double u2 = u * u, u3 = u2 * u;
  const double way = p.from.rate * (u - u3 + 0.5 * u2 * u2) +
                     slope * (0.5 * u2 - 2.0 / 3.0 * u3 + 0.25 * u2 * u2) + p.to * (u3 - 0.5 * u2 * u2);
  if (since >= p.length) return {p.from.time + p.length * way + p.to * (since - p.length), p.to, 0.0, p.held};
  const double rate =
      p.from.rate * (1.0 - 3.0 * u2 + 2.0 * u3) + slope * (u - 2.0 * u2 + u3) + p.to * (3.0 * u2 - 2.0 * u3);
  const double change =
      (6.0 * (p.to - p.from.rate) * (u - u2) + slope * (1.0 - 4.0 * u + 3.0 * u2)) / p.length;
  return {p.from.time + p.length * way, rate, change, Held::kNot};
}

const PaceLaw::Piece& PaceLaw::PieceAt(double index) const {
  auto piece = pieces_.end() - 1;
  while (piece != pieces_.begin() && index < piece->begin) --piece;
  return *piece;
}

PaceState PaceLaw::At(double index) const { return On(PieceAt(index), index); }

PaceLaw::Aim PaceLaw::AimAt(double index) const {
  const Piece& piece = PieceAt(index);
  return {piece.to, index >= piece.begin + piece.length};
}

void PaceLaw::Ramp(double begin, double length, double rate) {
  const PaceState from = At(begin);
  while (pieces_.size() > 1 && pieces_.back().begin >= begin) pieces_.pop_back();
  pieces_.push_back({begin, length, from, rate, Held::kNot});
}

void PaceLaw::Hold(double begin, double length, Held held) {
  Ramp(begin, length, 0.0);
  pieces_.back().held = held;
}

void PaceLaw::ForgetBefore(double index) {
  const auto after =
      std::find_if(pieces_.begin(), pieces_.end(), [&](const Piece& p) { return p.begin > index; });
  if (after - pieces_.begin() > 1) pieces_.erase(pieces_.begin(), after - 1);
}

}  // namespace contour
