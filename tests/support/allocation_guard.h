#pragma once

#include <cstddef>

namespace contour::test {

/// Counts what this thread asks of the heap while the object lives: malloc, calloc, realloc, free and their
/// aligned relatives, hence operator new and delete as well. Works by standing in front of glibc's allocator,
/// which a sanitizer wants for itself: there `kAvailable` is false and every count is 0, so a test says
///
///     if (!AllocationGuard::kAvailable) GTEST_SKIP() << "the sanitizer owns the heap";
///     AllocationGuard guard;
///     controller.Step(input, output);
///     EXPECT_EQ(guard.calls(), 0u);
class AllocationGuard {
 public:
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  static constexpr bool kAvailable = false;
#else
  static constexpr bool kAvailable = true;
#endif

  AllocationGuard() noexcept;
  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;

  /// Blocks requested since construction, by any function.
  [[nodiscard]] std::size_t allocations() const noexcept;
  /// Blocks given back since construction; free(nullptr) does not count.
  [[nodiscard]] std::size_t releases() const noexcept;
  /// Both together: 0 means the heap was not touched.
  [[nodiscard]] std::size_t calls() const noexcept { return allocations() + releases(); }

 private:
  std::size_t allocations_before_;
  std::size_t releases_before_;
};

}  // namespace contour::test
