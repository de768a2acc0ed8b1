#include "daemon/program/move_store.h"

#include <algorithm>

namespace contour {
namespace {

// So many of the newest modes are looked through; a program changes between few.
constexpr std::size_t kModesAgo = 8;

}  // namespace

std::uint32_t MoveStore::ModeOf(const Mode& mode) {
  const std::size_t oldest = modes_.size() - std::min(modes_.size(), kModesAgo);
  for (std::size_t i = modes_.size(); i-- > oldest;) {
    const Mode before = modes_[i];
    if (before.feed_m_s == mode.feed_m_s && before.tolerance_m == mode.tolerance_m)
      return static_cast<std::uint32_t>(i);
  }
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
  ends_m_.Append(end_m.data(), end_m.size() * sizeof(double));
}

PerAxis<double> MoveStore::Begin(std::size_t i) const {
  if (i == 0) return start_m_;
  PerAxis<double> at_m(start_m_.size());
  const std::size_t bytes = at_m.size() * sizeof(double);
  ends_m_.Read((i - 1) * bytes, at_m.data(), bytes);
  return at_m;
}

CurvePiece MoveStore::Curve(std::size_t i) const { return CurveOf(i, records_[i]); }

CurvePiece MoveStore::CurveOf(std::size_t i, const Record& record) const {
  if (record.arc == 0) return LinePiece(Begin(i), Begin(i + 1));
  const Arc a = arcs_[record.arc - 1];
  return HelixPiece(Begin(i), Begin(i + 1), {a.plane[0], a.plane[1]}, a.centre_m, a.sweep_rad);
}

ProgrammedMove MoveStore::Move(std::size_t i) const {
  const Record record = records_[i];
  const Mode mode = modes_[record.mode];
  return {CurveOf(i, record), mode.feed_m_s, mode.tolerance_m, record.line};
}

std::size_t MoveStore::bytes_in_memory() const {
  return ends_m_.bytes_in_memory() + records_.bytes_in_memory() + modes_.bytes_in_memory() +
         arcs_.bytes_in_memory();
}

}  // namespace contour
