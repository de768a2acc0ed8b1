#include "daemon/program/move_store.h"

#include <algorithm>

namespace contour {
namespace {

// So many of the newest modes are looked through; a program changes between few.
constexpr std::size_t kModesAgo = 8;

template <class T>
std::size_t BytesOf(const std::vector<T>& v) {
  return v.capacity() * sizeof(T);
}

}  // namespace

void MoveStore::Reserve(std::size_t moves) {
  ends_m_.reserve(moves * start_m_.size());
  records_.reserve(moves);
}

std::uint32_t MoveStore::ModeOf(const Mode& mode) {
  const std::size_t oldest = modes_.size() - std::min(modes_.size(), kModesAgo);
  for (std::size_t i = modes_.size(); i-- > oldest;)
    if (modes_[i].feed_m_s == mode.feed_m_s && modes_[i].tolerance_m == mode.tolerance_m)
      return static_cast<std::uint32_t>(i);
  modes_.push_back(mode);
  return static_cast<std::uint32_t>(modes_.size() - 1);
}

void MoveStore::Add(const ProgrammedMove& move, const PerAxis<double>& end_m) {
  Record record{move.line, ModeOf({move.feed_m_s, move.tolerance_m}), 0};
  if (move.curve.kind == CurvePiece::Kind::kArc) {
    const CurvePiece& c = move.curve;
    arcs_.push_back({c.centre_m,
                     c.sweep_rad,
                     {static_cast<std::uint8_t>(c.axis[0]), static_cast<std::uint8_t>(c.axis[1])}});
    record.arc = static_cast<std::uint32_t>(arcs_.size());
  }
  records_.push_back(record);
  ends_m_.insert(ends_m_.end(), end_m.begin(), end_m.end());
}

PerAxis<double> MoveStore::Begin(std::size_t i) const {
  if (i == 0) return start_m_;
  PerAxis<double> at_m(start_m_.size());
  const auto from = ends_m_.begin() + static_cast<std::ptrdiff_t>((i - 1) * start_m_.size());
  std::copy_n(from, start_m_.size(), at_m.begin());
  return at_m;
}

CurvePiece MoveStore::Curve(std::size_t i) const {
  const std::uint32_t arc = records_[i].arc;
  if (arc == 0) return LinePiece(Begin(i), Begin(i + 1));
  const Arc& a = arcs_[arc - 1];
  return HelixPiece(Begin(i), Begin(i + 1), {a.plane[0], a.plane[1]}, a.centre_m, a.sweep_rad);
}

ProgrammedMove MoveStore::Move(std::size_t i) const {
  const Mode& mode = modes_[records_[i].mode];
  return {Curve(i), mode.feed_m_s, mode.tolerance_m, records_[i].line};
}

std::size_t MoveStore::bytes() const {
  return BytesOf(ends_m_) + BytesOf(records_) + BytesOf(modes_) + BytesOf(arcs_);
}

}  // namespace contour
