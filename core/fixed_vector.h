#pragma once

#include <array>
#include <cstddef>

namespace contour {

/// A vector of at most N values that never touches the heap; push_back says whether there was room.
/// T must be default-constructible and copyable.
template <class T, std::size_t N>
class FixedVector {
 public:
  constexpr FixedVector() noexcept = default;
  constexpr explicit FixedVector(std::size_t size) noexcept : size_(size <= N ? size : N) {}

  static constexpr std::size_t capacity() noexcept { return N; }
  [[nodiscard]] constexpr std::size_t size() const noexcept { return size_; }
  [[nodiscard]] constexpr bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] constexpr bool full() const noexcept { return size_ == N; }

  constexpr bool push_back(const T& value) noexcept {
    if (size_ == N) return false;
    items_[size_++] = value;
    return true;
  }
  constexpr void clear() noexcept { size_ = 0; }
  /// Clamped to the capacity; new elements keep whatever the slot held.
  constexpr void resize(std::size_t size) noexcept { size_ = size <= N ? size : N; }

  constexpr T& operator[](std::size_t i) noexcept { return items_[i]; }
  constexpr const T& operator[](std::size_t i) const noexcept { return items_[i]; }
  constexpr T* data() noexcept { return items_.data(); }
  constexpr const T* data() const noexcept { return items_.data(); }
  constexpr T* begin() noexcept { return items_.data(); }
  constexpr T* end() noexcept { return items_.data() + size_; }
  constexpr const T* begin() const noexcept { return items_.data(); }
  constexpr const T* end() const noexcept { return items_.data() + size_; }
  constexpr T& back() noexcept { return items_[size_ - 1]; }
  constexpr const T& back() const noexcept { return items_[size_ - 1]; }

 private:
  std::array<T, N> items_{};
  std::size_t size_ = 0;
};

}  // namespace contour
