#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace contour {

/// Copies the state of an object to memory or back, for a cycle that is to go on elsewhere as if it had been
/// there from the start. A class that owns memory lists its members once:
///
///   void Keep(StateKeeper& keep) noexcept { keep(axes_, mode_, child_); }
///
/// and the same list measures, saves and loads. Whatever owns nothing is copied as it lies in memory, so only
/// the same build can read it. Sizes of vectors are fixed once a cycle is constructed; the reader's must
/// agree. Never allocates.
class StateKeeper {
 public:
  /// Counts bytes only.
  StateKeeper() noexcept = default;
  static StateKeeper Saving(std::span<std::byte> to) noexcept {
    StateKeeper k;
    k.to_ = to;
    k.size_ = to.size();
    k.mode_ = Mode::kSave;
    return k;
  }
  static StateKeeper Loading(std::span<const std::byte> from) noexcept {
    StateKeeper k;
    k.from_ = from;
    k.size_ = from.size();
    k.mode_ = Mode::kLoad;
    return k;
  }

  template <class... T>
  void operator()(T&... values) noexcept {
    (Value(values), ...);
  }

  /// Bytes passed so far.
  [[nodiscard]] std::size_t used() const noexcept { return used_; }
  /// Everything fitted, and was used up.
  [[nodiscard]] bool whole() const noexcept { return ok_ && (mode_ == Mode::kMeasure || used_ == size_); }

 private:
  enum class Mode { kMeasure, kSave, kLoad };

  template <class T>
  void Value(T& value) noexcept {
    if constexpr (requires { value.Keep(*this); }) {
      value.Keep(*this);
    } else {
      // What owns memory has something to do when it ends, and what is polymorphic has a pointer inside.
      static_assert(std::is_trivially_destructible_v<T> && !std::is_polymorphic_v<T> &&
                        !std::is_pointer_v<T> && !std::is_reference_v<T>,
                    "a class that owns memory needs a Keep of its own");
      Bytes(&value, sizeof value);
    }
  }
  template <class T>
  void Value(std::vector<T>& values) noexcept {
    std::size_t count = values.size();
    Bytes(&count, sizeof count);
    if (count != values.size()) ok_ = false;
    if (!ok_) return;
    for (T& v : values) Value(v);
  }
  template <class T>
  void Value(std::unique_ptr<T>& owned) noexcept {
    bool there = owned != nullptr;
    Bytes(&there, sizeof there);
    if (there != (owned != nullptr)) ok_ = false;
    if (ok_ && there) Value(*owned);
  }

  void Bytes(void* value, std::size_t size) noexcept {
    if (mode_ != Mode::kMeasure && size > size_ - used_) ok_ = false;
    if (!ok_) return;
    if (mode_ == Mode::kSave) std::memcpy(to_.data() + used_, value, size);
    if (mode_ == Mode::kLoad) std::memcpy(value, from_.data() + used_, size);
    used_ += size;
  }

  Mode mode_ = Mode::kMeasure;
  std::span<std::byte> to_;
  std::span<const std::byte> from_;
  std::size_t size_ = 0;
  std::size_t used_ = 0;
  bool ok_ = true;
};

}  // namespace contour
