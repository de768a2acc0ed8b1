#include "daemon/program/gcode/move_tape.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <stdexcept>

namespace contour {
namespace {

constexpr std::size_t kWholeEvery = 256;

/// What differs from the move before, one bit each; what follows it is in this order.
enum Change : std::uint16_t {
  kTargets = 0x3f,  ///< a bit for each axis
  kNextLine = 0x40,
  kLine = 0x80,
  kModes = 0x100,
  kFeed = 0x200,
  kTolerance = 0x400,
  kArc = 0x800,
  kDwell = 0x1000,
};

/// Longer than any move is written.
constexpr std::size_t kLongest = 128;

bool Same(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

class Writer {
 public:
  template <class T>
  void Put(const T& value) {
    std::memcpy(&bytes_[size_], &value, sizeof(T));
    size_ += sizeof(T);
  }
  void PutFirst(std::uint16_t changes) { std::memcpy(bytes_.data(), &changes, sizeof(changes)); }
  [[nodiscard]] const std::byte* data() const { return bytes_.data(); }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  std::array<std::byte, kLongest> bytes_{};
  std::size_t size_ = sizeof(std::uint16_t);
};

}  // namespace

void MoveTape::push_back(const GcodeMove& move) {
  if (size_ > 0) Write(back_);
  back_ = move;
  ++size_;
}

// The move before the newest one is complete.
void MoveTape::Write(const GcodeMove& move) {
  if ((size_ - 1) % kWholeEvery == 0) {
    whole_.push_back(spool_.size());
    written_ = {};
  }
  const GcodeMove& last = written_;
  Writer out;
  unsigned changes = 0;
  for (std::size_t k = 0; k < move.target_m.size(); ++k) {
    if (Same(move.target_m[k], last.target_m[k])) continue;
    changes |= 1U << k;
    out.Put(move.target_m[k]);
  }
  if (move.line == last.line + 1) {
    changes |= kNextLine;
  } else if (move.line != last.line) {
    changes |= kLine;
    out.Put(move.line);
  }
  if (move.kind != last.kind || move.corner != last.corner || move.in_sub != last.in_sub ||
      move.plane != last.plane) {
    changes |= kModes;
    out.Put(move.kind);
    out.Put(move.corner);
    out.Put(move.in_sub);
    out.Put(move.plane);
  }
  if (!Same(move.feed_m_s, last.feed_m_s)) {
    changes |= kFeed;
    out.Put(move.feed_m_s);
  }
  if (!Same(move.tolerance_m, last.tolerance_m)) {
    changes |= kTolerance;
    out.Put(move.tolerance_m);
  }
  if (!Same(move.centre_m[0], last.centre_m[0]) || !Same(move.centre_m[1], last.centre_m[1]) ||
      !Same(move.sweep_rad, last.sweep_rad)) {
    changes |= kArc;
    out.Put(move.centre_m);
    out.Put(move.sweep_rad);
  }
  if (!Same(move.dwell_s, last.dwell_s)) {
    changes |= kDwell;
    out.Put(move.dwell_s);
  }
  out.PutFirst(static_cast<std::uint16_t>(changes));
  spool_.Append(out.data(), out.size());
  written_ = move;
}

std::size_t MoveTape::ReadOver(GcodeMove& move, std::size_t at) const {
  std::array<std::byte, kLongest> bytes{};
  spool_.Read(at, bytes.data(), std::min(bytes.size(), spool_.size() - at));
  std::size_t read = 0;
  const auto get = [&](auto& value) {
    std::memcpy(&value, &bytes[read], sizeof(value));
    read += sizeof(value);
  };
  std::uint16_t changes = 0;
  get(changes);
  for (std::size_t k = 0; k < move.target_m.size(); ++k)
    if ((changes >> k & 1U) != 0) get(move.target_m[k]);
  if ((changes & kNextLine) != 0) ++move.line;
  if ((changes & kLine) != 0) get(move.line);
  if ((changes & kModes) != 0) {
    get(move.kind);
    get(move.corner);
    get(move.in_sub);
    get(move.plane);
  }
  if ((changes & kFeed) != 0) get(move.feed_m_s);
  if ((changes & kTolerance) != 0) get(move.tolerance_m);
  if ((changes & kArc) != 0) {
    get(move.centre_m);
    get(move.sweep_rad);
  }
  if ((changes & kDwell) != 0) get(move.dwell_s);
  return at + read;
}

void MoveTape::StopAfter(std::size_t i) {
  if (stops_.empty() || stops_.back() < i) stops_.push_back(i);
}

GcodeMove MoveTape::HandedOut(const GcodeMove& raw) const {
  if (!places_) return raw;
  GcodeMove move = raw;
  move.target_m = {};
  for (std::size_t k = 0; k < raw.target_m.size(); ++k)
    if ((*places_)[k]) move.target_m[*(*places_)[k]] = raw.target_m[k];
  if (move.kind == GcodeMove::Kind::kArc)
    for (std::size_t k = 0; k < move.plane.size(); ++k) move.plane[k] = (*places_)[raw.plane[k]].value_or(0);
  return move;
}

MoveTape::Iterator::Iterator(const MoveTape& tape, std::size_t index) : tape_(&tape), index_(index) {
  if (index >= tape.size_) return;
  const std::size_t whole = index - index % kWholeEvery;
  if (whole + 1 < tape.size_) at_ = tape.whole_[whole / kWholeEvery];
  stop_ = static_cast<std::size_t>(std::lower_bound(tape.stops_.begin(), tape.stops_.end(), index) -
                                   tape.stops_.begin());
  for (index_ = whole; index_ < index; ++index_) Read();
  Read();
}

void MoveTape::Iterator::Read() {
  if (index_ + 1 == tape_->size_) {
    raw_ = tape_->back_;
  } else {
    if (index_ % kWholeEvery == 0) raw_ = {};
    at_ = tape_->ReadOver(raw_, at_);
  }
  move_ = tape_->HandedOut(raw_);
  while (stop_ < tape_->stops_.size() && tape_->stops_[stop_] < index_) ++stop_;
  if (tape_->stop_after_all_ || (stop_ < tape_->stops_.size() && tape_->stops_[stop_] == index_))
    move_.corner = GcodeMove::Corner::kExactStop;
}

MoveTape::Iterator& MoveTape::Iterator::operator++() {
  if (++index_ < tape_->size_) Read();
  return *this;
}

GcodeMove MoveTape::operator[](std::size_t i) const { return *Iterator(*this, i); }

GcodeMove MoveTape::at(std::size_t i) const {
  if (i >= size_) throw std::out_of_range("no such move");
  return (*this)[i];
}

std::size_t MoveTape::bytes_in_memory() const {
  return spool_.bytes_in_memory() + whole_.bytes_in_memory() + stops_.capacity() * sizeof(std::size_t);
}

}  // namespace contour
