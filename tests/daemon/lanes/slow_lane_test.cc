#include "daemon/lanes/slow_lane.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <stdexcept>
#include <vector>

namespace contour {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::minutes kLong{1};

TEST(SlowLaneTest, DoesAllInOrderAndSaysSo) {
  const auto done = std::make_shared<std::vector<int>>();
  SlowLane lane("lane", {100, {}});
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(lane.Post(1, [done, i] { done->push_back(i); }));
  ASSERT_TRUE(lane.Finish(Clock::now() + kLong));
  ASSERT_EQ(done->size(), 50u);
  for (int i = 0; i < 50; ++i) EXPECT_EQ((*done)[static_cast<std::size_t>(i)], i);
  EXPECT_FALSE(lane.Post(1, [] {})) << "after the end";
}

TEST(SlowLaneTest, WorkThatThrowsIsNotTheEnd) {
  const auto done = std::make_shared<bool>(false);
  SlowLane lane("lane", {100, {}});
  lane.Post(1, [] { throw std::runtime_error("no room"); });
  lane.Post(1, [done] { *done = true; });
  ASSERT_TRUE(lane.Finish(Clock::now() + kLong));
  EXPECT_TRUE(*done);
}

/// Work that is stuck until the test lets it go.
struct Stuck {
  std::promise<void> entered, let_go;
  std::function<void()> work(const std::shared_ptr<Stuck>& self) {
    return [self] {
      self->entered.set_value();
      self->let_go.get_future().wait();
    };
  }
};

TEST(SlowLaneTest, WhatDoesNotFitIsRefusedAndNobodyWaits) {
  const auto stuck = std::make_shared<Stuck>();
  SlowLane lane("lane", {100, {}});
  lane.Post(60, stuck->work(stuck));
  stuck->entered.get_future().wait();
  EXPECT_TRUE(lane.Post(40, [] {}));
  EXPECT_FALSE(lane.Post(1, [] {})) << "what is being done counts, too";
  EXPECT_TRUE(lane.Post(
      5, [] {}, 10))
      << "room that other work does not get";
  EXPECT_EQ(lane.waiting_bytes(), 105u);
  stuck->let_go.set_value();
  EXPECT_TRUE(lane.Finish(Clock::now() + kLong));
}

// This would not end if anybody waited for the thread that is stuck.
TEST(SlowLaneTest, AThreadThatIsStuckIsLeftBehind) {
  const auto stuck = std::make_shared<Stuck>();
  const auto later = std::make_shared<std::atomic<bool>>(false);
  {
    SlowLane lane("lane", {100, {}});
    lane.Post(1, stuck->work(stuck));
    lane.Post(1, [later] { *later = true; });
    stuck->entered.get_future().wait();
    EXPECT_FALSE(lane.Finish(Clock::now()));
  }
  stuck->let_go.set_value();
  EXPECT_FALSE(*later) << "the rest is not done behind everybody's back";
}

TEST(SlowLaneTest, WithPatienceItWaitsForRoomWhileThereIsProgress) {
  std::atomic<int> done{0};
  SlowLane lane("lane", {1, std::chrono::duration_cast<std::chrono::milliseconds>(kLong)});
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(lane.Post(1, [&done] { ++done; }));
  ASSERT_TRUE(lane.Finish(Clock::now() + kLong));
  EXPECT_EQ(done, 200);
}

}  // namespace
}  // namespace contour
