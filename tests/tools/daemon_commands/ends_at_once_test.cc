#include "tools/contour/ends_at_once.h"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <thread>

#include "core/exit_status.h"

namespace contour {
namespace {

std::atomic<int> caught{0};
void Count(int /*signal*/) { ++caught; }

TEST(EndsAtOnceDeathTest, ASignalEndsTheProcessWithItsWordsWhateverComputes) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  for (const int signal : {SIGTERM, SIGINT}) {
    EXPECT_EXIT(
        {
          std::signal(signal, Count);
          const EndsAtOnce ends("interrupted; nothing was written\n");
          std::atomic<std::uint64_t> turns{0};
          std::jthread computing([&](const std::stop_token&) {
            for (;;) ++turns;
          });
          while (turns == 0) std::this_thread::yield();
          std::raise(signal);
          for (;;) std::this_thread::yield();
        },
        testing::ExitedWithCode(kExitFailed), "^interrupted; nothing was written\n$");
  }
}

TEST(EndsAtOnceDeathTest, WhatWasInForceBeforeIsAgain) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  std::signal(SIGTERM, Count);
  { const EndsAtOnce ends("no\n"); }
  caught = 0;
  std::raise(SIGTERM);
  EXPECT_EQ(caught, 1);
  std::signal(SIGTERM, SIG_DFL);
}

}  // namespace
}  // namespace contour
