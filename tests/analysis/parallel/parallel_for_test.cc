#include "analysis/parallel/parallel_for.h"

#include <gtest/gtest.h>

#include <atomic>
#include <barrier>
#include <chrono>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace contour {
namespace {

TEST(ParallelFor, DoesEverythingOnceOnAnyNumberOfThreads) {
  for (const int threads : {-1, 0, 1, 2, 7, 100}) {
    std::vector<std::atomic<int>> done(1000);
    ParallelFor(done.size(), threads, [&](std::size_t i) { ++done[i]; });
    for (const auto& n : done) ASSERT_EQ(n.load(), 1) << threads;
  }
  ParallelFor(0, 4, [](std::size_t) { FAIL(); });
}

// Two bodies that wait for each other come through on two threads only.
TEST(ParallelFor, ThreadsWorkAtTheSameTime) {
  std::barrier both(2);
  ParallelFor(2, 2, [&](std::size_t) { both.arrive_and_wait(); });
}

TEST(ParallelFor, OneThreadIsTheCallers) {
  const auto caller = std::this_thread::get_id();
  ParallelFor(20, 1, [&](std::size_t) { EXPECT_EQ(std::this_thread::get_id(), caller); });
}

TEST(ParallelFor, NoMoreThreadsThanAskedForAndTheSameOnesAgain) {
  std::mutex mutex;
  std::set<std::thread::id> seen;
  for (int call = 0; call < 50; ++call)
    ParallelFor(100, 3, [&](std::size_t) {
      const std::scoped_lock lock(mutex);
      seen.insert(std::this_thread::get_id());
    });
  // The caller and the pool's, which the test before may have grown to 99.
  EXPECT_LE(seen.size(), 100U);
}

TEST(ParallelFor, ABodyMayCallItAgain) {
  std::atomic<int> done{0};
  ParallelFor(8, 4, [&](std::size_t) { ParallelFor(8, 4, [&](std::size_t) { ++done; }); });
  EXPECT_EQ(done.load(), 64);
}

TEST(ParallelFor, CallersDoNotWaitForEachOther) {
  std::atomic<int> done{0};
  std::vector<std::jthread> callers;
  for (int c = 0; c < 4; ++c)
    callers.emplace_back([&] {
      for (int i = 0; i < 200; ++i) ParallelFor(5, 3, [&](std::size_t) { ++done; });
    });
  callers.clear();
  EXPECT_EQ(done.load(), 4 * 200 * 5);
}

TEST(ParallelFor, WhatABodyThrowsIsThrownAndTheRestIsLeftOut) {
  for (const int threads : {1, 4}) {
    std::atomic<int> begun{0};
    const auto body = [&](std::size_t i) {
      ++begun;
      if (i == 3) {
        // Where there are others, one is at work.
        while (threads > 1 && begun < 5) std::this_thread::yield();
        throw std::runtime_error("three");
      }
      // A busy host may hold up the one that throws while another goes on: not for half a minute.
      if (i > 3) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    EXPECT_THROW(ParallelFor(100000, threads, body), std::runtime_error) << threads;
    EXPECT_LT(begun.load(), 100000);
    std::atomic<int> after{0};
    ParallelFor(10, threads, [&](std::size_t) { ++after; });
    EXPECT_EQ(after.load(), 10);
  }
}

TEST(ThreadsOf, NoneAskedForIsOnePerProcessor) {
  EXPECT_EQ(ThreadsOf(3), 3);
  EXPECT_GE(ThreadsOf(0), 1);
}

}  // namespace
}  // namespace contour
