#include "daemon/telemetry/row_feed.h"

#include <gtest/gtest.h>

#include <thread>

#include "tests/support/random_cycle_entry.h"

namespace contour {
namespace {

constexpr std::chrono::hours kLong{1};

TEST(RowFeedTest, WhereTimeWaitsForTheClientNothingIsLost) {
  RowFeed feed(4);
  constexpr std::uint64_t kRows = 500;
  std::thread machine([&] {
    test::RandomCycleEntry random(1);
    for (std::uint64_t cycle = 1; cycle <= kRows; ++cycle) feed.Push(random.Next(cycle, 1), kLong);
  });
  std::uint64_t got = 0;
  while (got < kRows && feed.lost() == 0)
    if (feed.Pop())
      ++got;
    else
      std::this_thread::yield();
  EXPECT_EQ(got, kRows);
  EXPECT_EQ(feed.lost(), 0U);
  machine.join();
}

TEST(RowFeedTest, AClientThatTakesNothingIsWaitedForOnce) {
  RowFeed feed(1);
  test::RandomCycleEntry random(2);
  feed.Push(random.Next(1, 1), kLong);
  feed.Push(random.Next(2, 1), std::chrono::milliseconds(1));
  EXPECT_EQ(feed.lost(), 1U);
  feed.Push(random.Next(3, 1), kLong);
  EXPECT_EQ(feed.lost(), 2U) << "and this did not wait";
  ASSERT_TRUE(feed.Pop());
  std::thread client([&] {
    while (!feed.Pop()) std::this_thread::yield();
  });
  feed.Push(random.Next(4, 1), kLong);
  feed.Push(random.Next(5, 1), kLong);
  client.join();
  EXPECT_EQ(feed.lost(), 2U) << "it takes rows again, and is waited for";
}

TEST(RowFeedTest, NobodyWaitsForAClientThatIsGone) {
  RowFeed feed(1);
  test::RandomCycleEntry random(3);
  feed.Push(random.Next(1, 1), kLong);
  std::thread machine([&] { feed.Push(random.Next(2, 1), kLong); });
  feed.End();
  machine.join();
  EXPECT_EQ(feed.lost(), 1U);
}

}  // namespace
}  // namespace contour
