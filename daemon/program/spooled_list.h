#pragma once

#include <cstddef>
#include <type_traits>

#include "daemon/program/spool.h"

namespace contour {

/// Records one after the other in a Spool. Only the newest one can be changed.
template <class T>
class SpooledList {
 public:
  static_assert(std::is_trivially_copyable_v<T>);

  void push_back(const T& record) {
    if (size_ > 0) spool_.Append(&back_, sizeof(T));
    back_ = record;
    ++size_;
  }
  [[nodiscard]] T& back() { return back_; }
  [[nodiscard]] const T& back() const { return back_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] T operator[](std::size_t i) const {
    if (i + 1 == size_) return back_;
    T record;
    spool_.Read(i * sizeof(T), &record, sizeof(T));
    return record;
  }
  [[nodiscard]] std::size_t bytes_in_memory() const { return spool_.bytes_in_memory(); }
  [[nodiscard]] bool on_disk() const { return spool_.on_disk(); }

 private:
  Spool spool_;
  T back_{};
  std::size_t size_ = 0;
};

}  // namespace contour
