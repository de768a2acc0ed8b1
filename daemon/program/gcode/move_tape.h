#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <vector>

#include "daemon/program/gcode_move.h"
#include "daemon/program/spooled_list.h"

namespace contour {

/// The moves of a G-code program one after the other, written as what differs from the move before: 18 bytes
/// of a line with two coordinates, of which a window is in memory. They come back bit for bit.
class MoveTape {
 public:
  /// Only the newest move can be changed.
  void push_back(const GcodeMove& move);
  [[nodiscard]] GcodeMove& back() { return back_; }
  [[nodiscard]] GcodeMove back() const { return (*this)[size_ - 1]; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  /// Goes through the moves from one that is written whole; for many of them there is the iterator.
  [[nodiscard]] GcodeMove operator[](std::size_t i) const;
  /// Throws std::out_of_range.
  [[nodiscard]] GcodeMove at(std::size_t i) const;
  [[nodiscard]] GcodeMove front() const { return (*this)[0]; }

  /// Moves are handed out with the coordinate of axis k at place[k], 0 where no place is, when all are in.
  using Places = std::array<std::optional<std::uint8_t>, 6>;
  void Arrange(const Places& places) { places_ = places; }
  /// Move i ends in an exact stop. In rising order.
  void StopAfter(std::size_t i);
  /// All do.
  void StopAfterAll() { stop_after_all_ = true; }

  /// Goes forward.
  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = GcodeMove;
    using difference_type = std::ptrdiff_t;
    using pointer = const GcodeMove*;
    using reference = const GcodeMove&;
    [[nodiscard]] reference operator*() const { return move_; }
    [[nodiscard]] pointer operator->() const { return &move_; }
    Iterator& operator++();
    [[nodiscard]] std::size_t index() const { return index_; }
    friend bool operator==(const Iterator& a, const Iterator& b) { return a.index_ == b.index_; }

   private:
    friend class MoveTape;
    Iterator(const MoveTape& tape, std::size_t index);
    void Read();
    const MoveTape* tape_;
    std::size_t index_;
    std::size_t at_ = 0;  ///< in the spool, of the next move
    std::size_t stop_ = 0;
    GcodeMove raw_;
    GcodeMove move_;
  };
  [[nodiscard]] Iterator begin() const { return {*this, 0}; }
  [[nodiscard]] Iterator From(std::size_t i) const { return {*this, i}; }
  [[nodiscard]] Iterator end() const { return {*this, size_}; }

  [[nodiscard]] std::size_t bytes_in_memory() const;

 private:
  void Write(const GcodeMove& move);
  /// Changes the move before into the one that is written there; returns where the next one is.
  std::size_t ReadOver(GcodeMove& move, std::size_t at) const;
  [[nodiscard]] GcodeMove HandedOut(const GcodeMove& raw) const;

  Spool spool_;
  SpooledList<std::uint64_t> whole_;  ///< where every so many moves are written as from nothing
  GcodeMove written_;                 ///< the last one that is in the spool
  GcodeMove back_;
  std::size_t size_ = 0;
  std::optional<Places> places_;
  std::vector<std::size_t> stops_;
  bool stop_after_all_ = false;
};

}  // namespace contour
