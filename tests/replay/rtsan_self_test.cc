// The realtime sanitizer sees what it is there for; only built with it.
#include <gtest/gtest.h>
#include <time.h>

#include <memory>
#include <mutex>
#include <vector>

#include "core/nonblocking.h"

namespace contour::test {
namespace {

std::vector<int> numbers;
std::mutex mutex;

void TakesMemory() noexcept CONTOUR_NONBLOCKING { numbers.resize(numbers.size() + 1000); }
void Locks() noexcept CONTOUR_NONBLOCKING { const std::scoped_lock lock(mutex); }
void Sleeps() noexcept CONTOUR_NONBLOCKING {
  const timespec t{0, 1};
  nanosleep(&t, nullptr);
}
int Computes() noexcept CONTOUR_NONBLOCKING { return numbers.empty() ? 1 : 2; }

TEST(RtsanSelfTest, SeesMemoryLocksAndWaits) {
  EXPECT_DEATH(TakesMemory(), "RealtimeSanitizer");
  EXPECT_DEATH(Locks(), "RealtimeSanitizer");
  EXPECT_DEATH(Sleeps(), "RealtimeSanitizer");
  EXPECT_EQ(Computes(), 1);
}

}  // namespace
}  // namespace contour::test
