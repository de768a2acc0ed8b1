#include "daemon/telemetry/row_feed.h"

#include <gtest/gtest.h>

#include <thread>

#include "tests/support/random_cycle_entry.h"

namespace contour {
namespace {

constexpr std::chrono::hours kLong{1};
constexpr std::chrono::milliseconds kShort{2};

TEST(RowFeedTest, WhereTimeWaitsForTheClientNothingIsLost) {
  RowFeed feed(4);
  Patience patience(kLong);
  constexpr std::uint64_t kRows = 500;
  std::thread machine([&] {
    test::RandomCycleEntry random(1);
    for (std::uint64_t cycle = 1; cycle <= kRows; ++cycle) feed.Push(random.Next(cycle, 1), patience);
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
  Patience soon(kShort), patience(kLong);
  test::RandomCycleEntry random(2);
  feed.Push(random.Next(1, 1), patience);
  feed.Push(random.Next(2, 1), soon);
  EXPECT_EQ(feed.lost(), 1U);
  EXPECT_TRUE(feed.behind());
  feed.Push(random.Next(3, 1), patience);
  EXPECT_EQ(feed.lost(), 2U) << "and this did not wait";
  ASSERT_TRUE(feed.Pop());
  EXPECT_FALSE(feed.behind());
  std::thread client([&] {
    while (!feed.Pop()) std::this_thread::yield();
  });
  feed.Push(random.Next(4, 1), patience);
  feed.Push(random.Next(5, 1), patience);
  client.join();
  EXPECT_EQ(feed.lost(), 2U) << "it has caught up, and is waited for";
}

// Else it holds the machine for as long as it likes.
TEST(RowFeedTest, ARowNowAndThenIsNotCaughtUp) {
  RowFeed feed(8);
  Patience soon(kShort), patience(kLong);
  test::RandomCycleEntry random(5);
  for (std::uint64_t cycle = 1; cycle <= 9; ++cycle) feed.Push(random.Next(cycle, 1), soon);
  EXPECT_EQ(feed.lost(), 1U);
  for (std::uint64_t cycle = 10; cycle <= 12; ++cycle) {
    ASSERT_TRUE(feed.Pop());
    feed.Push(random.Next(cycle, 1), patience);
  }
  EXPECT_EQ(feed.lost(), 4U) << "what it lost stays in one piece, and nobody waited";
  ASSERT_TRUE(feed.Pop());
  feed.Push(random.Next(13, 1), patience);
  EXPECT_EQ(feed.lost(), 4U) << "half of them are taken";
}

TEST(RowFeedTest, AllClientsTogetherUseUpOnePatience) {
  using std::chrono::nanoseconds;
  Patience patience(nanoseconds(1000), nanoseconds(100));
  EXPECT_EQ(patience.ForOne(), nanoseconds(500));
  patience.Use(patience.ForOne());
  EXPECT_EQ(patience.ForOne(), nanoseconds(250)) << "those who wait after one who has stopped";
  patience.Use(nanoseconds(2000));  // a host may wake us up as late as it likes
  EXPECT_EQ(patience.ForOne(), nanoseconds(0));
  patience.EndCycle();
  EXPECT_EQ(patience.ForOne(), nanoseconds(50));
  for (int cycle = 0; cycle < 20; ++cycle) patience.EndCycle();
  EXPECT_EQ(patience.ForOne(), nanoseconds(500));
}

TEST(RowFeedTest, NobodyWaitsForAClientThatIsGone) {
  RowFeed feed(1);
  Patience patience(kLong);
  test::RandomCycleEntry random(3);
  feed.Push(random.Next(1, 1), patience);
  std::thread machine([&] { feed.Push(random.Next(2, 1), patience); });
  feed.End();
  machine.join();
  EXPECT_EQ(feed.lost(), 1U);
}

}  // namespace
}  // namespace contour
