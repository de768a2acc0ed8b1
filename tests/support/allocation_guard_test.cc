#include "tests/support/allocation_guard.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace contour::test {
namespace {

/// Hides a pointer from the optimiser, which may otherwise remove a new together with its delete.
template <class T>
T* Opaque(T* pointer) {
  asm volatile("" : "+r"(pointer) : : "memory");
  return pointer;
}

class AllocationGuardTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!AllocationGuard::kAvailable) GTEST_SKIP() << "the sanitizer owns the heap";
  }
};

TEST_F(AllocationGuardTest, CountsNothingWhenTheHeapIsLeftAlone) {
  AllocationGuard guard;
  double sum = 0.0;
  for (int i = 0; i < 100; ++i) sum += *Opaque(&sum) + i;
  std::free(Opaque(static_cast<void*>(nullptr)));
  EXPECT_EQ(guard.calls(), 0u);
}

TEST_F(AllocationGuardTest, CountsNewAndDelete) {
  AllocationGuard guard;
  auto* value = Opaque(new int(1));
  EXPECT_EQ(guard.allocations(), 1u);
  EXPECT_EQ(guard.releases(), 0u);
  delete value;
  EXPECT_EQ(guard.allocations(), 1u);
  EXPECT_EQ(guard.releases(), 1u);
}

TEST_F(AllocationGuardTest, CountsOverAlignedNew) {
  struct alignas(64) Line {
    char bytes[64];
  };
  AllocationGuard guard;
  auto line = std::make_unique<Line>();
  Opaque(line.get());
  EXPECT_EQ(guard.allocations(), 1u);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(line.get()) % 64, 0u);
}

TEST_F(AllocationGuardTest, CountsTheFunctionsOfC) {
  AllocationGuard guard;
  void* a = Opaque(std::malloc(8));
  EXPECT_EQ(guard.allocations(), 1u);
  a = Opaque(std::realloc(a, 4096));
  EXPECT_EQ(guard.allocations(), 2u);
  void* b = Opaque(std::calloc(2, 8));
  EXPECT_EQ(guard.allocations(), 3u);
  void* c = Opaque(std::aligned_alloc(64, 128));
  EXPECT_EQ(guard.allocations(), 4u);
  void* d = nullptr;
  ASSERT_EQ(posix_memalign(&d, 64, 128), 0);
  EXPECT_EQ(guard.allocations(), 5u);
  std::free(a);
  std::free(b);
  std::free(c);
  std::free(Opaque(d));
  EXPECT_EQ(guard.releases(), 4u);
}

TEST_F(AllocationGuardTest, CountsContainersOfTheStandardLibrary) {
  AllocationGuard guard;
  std::vector<double> values;
  values.reserve(10);
  EXPECT_EQ(guard.allocations(), 1u);
  const std::string text(100, 'x');
  EXPECT_EQ(guard.allocations(), 2u);
}

TEST_F(AllocationGuardTest, SeesItsOwnThreadOnly) {
  std::thread other;
  std::size_t seen_by_other = 0;
  other = std::thread([&] {
    AllocationGuard inner;
    delete Opaque(new int(1));
    seen_by_other = inner.calls();
  });
  AllocationGuard guard;
  other.join();
  EXPECT_EQ(guard.calls(), 0u);
  EXPECT_EQ(seen_by_other, 2u);
}

}  // namespace
}  // namespace contour::test
