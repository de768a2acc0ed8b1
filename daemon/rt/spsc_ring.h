#pragma once

#include <atomic>
#include <cstddef>
#include <memory>

namespace contour {

/// Bounded queue for one producer and one consumer thread, without locks. All memory is taken at
/// construction. Capacity is rounded up to a power of two.
template <class T>
class SpscRing {
 public:
  explicit SpscRing(std::size_t capacity) : mask_(RoundUp(capacity) - 1), slots_(new T[mask_ + 1]()) {}

  [[nodiscard]] std::size_t capacity() const noexcept { return mask_ + 1; }
  /// Exact for the two parties as far as each cares: never too large for the consumer, never too small for
  /// the producer.
  [[nodiscard]] std::size_t size() const noexcept {
    return head_.load(std::memory_order_acquire) - tail_.load(std::memory_order_acquire);
  }

  /// The slot to write next, or null when full. Producer only; Publish() hands it over.
  [[nodiscard]] T* Reserve() noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) > mask_) return nullptr;
    return &slots_[head & mask_];
  }
  void Publish() noexcept {
    head_.store(head_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }

  bool Push(const T& value) noexcept {
    T* slot = Reserve();
    if (slot == nullptr) return false;
    *slot = value;
    Publish();
    return true;
  }

  /// All of them or none, and the consumer sees all of them at once. Producer only.
  bool PushAll(const T* values, std::size_t count) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head + count - tail_.load(std::memory_order_acquire) > mask_ + 1) return false;
    for (std::size_t i = 0; i < count; ++i) slots_[(head + i) & mask_] = values[i];
    head_.store(head + count, std::memory_order_release);
    return true;
  }

  /// Elements ever pushed. Producer only.
  [[nodiscard]] std::size_t pushed() const noexcept { return head_.load(std::memory_order_relaxed); }
  /// Gives back what is left of the first `count` elements ever pushed. Consumer only.
  void ReleaseUntil(std::size_t count) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    // The difference, as the numbers may wrap.
    if (count - tail <= mask_ + 1) tail_.store(count, std::memory_order_release);
  }

  /// The oldest element, or null when empty. Consumer only; Release() gives the slot back.
  [[nodiscard]] T* Front() noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire)) return nullptr;
    return &slots_[tail & mask_];
  }
  void Release() noexcept {
    tail_.store(tail_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }

  bool Pop(T& value) noexcept {
    T* slot = Front();
    if (slot == nullptr) return false;
    value = *slot;
    Release();
    return true;
  }

 private:
  static std::size_t RoundUp(std::size_t n) noexcept {
    std::size_t power = 1;
    while (power < n) power *= 2;
    return power;
  }

  const std::size_t mask_;
  std::unique_ptr<T[]> slots_;
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
};

}  // namespace contour
