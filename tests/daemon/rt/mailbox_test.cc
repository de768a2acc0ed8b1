#include <gtest/gtest.h>

#include <memory>
#include <thread>

#include "daemon/rt/command_mailbox.h"
#include "daemon/rt/telemetry_queue.h"

namespace contour {
namespace {

TEST(CommandMailbox, StopOvertakesAndIsNotOverwritten) {
  CommandMailbox mailbox(8, 8);
  mailbox.Post(RequestKind::kEnable);
  mailbox.Post(RequestKind::kRun, 5);
  const std::uint32_t stop = mailbox.PostStop();
  mailbox.Post(RequestKind::kReset);
  const Request first = mailbox.TakeRequest();
  EXPECT_EQ(first.kind, RequestKind::kStop);
  EXPECT_EQ(first.sequence, stop);
  EXPECT_EQ(mailbox.TakeRequest().kind, RequestKind::kEnable);
  const Request run = mailbox.TakeRequest();
  EXPECT_EQ(run.kind, RequestKind::kRun);
  EXPECT_EQ(run.program_id, 5u);
  EXPECT_EQ(mailbox.TakeRequest().kind, RequestKind::kReset);
  EXPECT_EQ(mailbox.TakeRequest().kind, RequestKind::kNone);
}

TEST(CommandMailbox, HoldsOrdinaryRequestsBackButNotAStop) {
  CommandMailbox mailbox(8, 8);
  mailbox.Post(RequestKind::kEnable);
  EXPECT_EQ(mailbox.TakeRequest(false).kind, RequestKind::kNone);
  mailbox.PostTerminate();
  EXPECT_EQ(mailbox.TakeRequest(false).kind, RequestKind::kTerminate);
  EXPECT_EQ(mailbox.TakeRequest().kind, RequestKind::kEnable);
}

TEST(CommandMailbox, WithdrawnRequestsAreNotCarriedOut) {
  CommandMailbox mailbox(8, 8);
  const std::uint32_t enable = mailbox.Post(RequestKind::kEnable);
  mailbox.Withdraw(enable);
  mailbox.Post(RequestKind::kReset);
  EXPECT_EQ(mailbox.TakeRequest().kind, RequestKind::kReset);
  EXPECT_EQ(mailbox.TakeRequest().kind, RequestKind::kNone);
}

TEST(CommandMailbox, SaysWhenItIsFull) {
  CommandMailbox mailbox(2, 2);
  EXPECT_NE(mailbox.Post(RequestKind::kReset), 0u);
  EXPECT_NE(mailbox.Post(RequestKind::kReset), 0u);
  EXPECT_EQ(mailbox.Post(RequestKind::kReset), 0u);
  EXPECT_TRUE(mailbox.PushPathPoint({}));
  EXPECT_TRUE(mailbox.PushPathPoint({}));
  EXPECT_FALSE(mailbox.PushPathPoint({}));
}

TEST(TelemetryQueue, CountsWhatItDrops) {
  TelemetryQueue queue(4);
  for (std::uint64_t i = 0; i < 7; ++i) {
    queue.Reserve()->input.cycle = i;
    queue.Publish();
  }
  EXPECT_EQ(queue.dropped(), 3u);
  for (std::uint64_t i = 0; i < 4; ++i) {
    ASSERT_NE(queue.Front(), nullptr);
    EXPECT_EQ(queue.Front()->input.cycle, i);
    queue.Release();
  }
  EXPECT_EQ(queue.Front(), nullptr);
}

TEST(TelemetryQueue, NothingIsLostOrReorderedBetweenTwoThreads) {
  TelemetryQueue queue(16);
  constexpr std::uint64_t kCount = 20000;
  std::uint64_t seen = 0;
  std::thread reader([&] {
    std::uint64_t last = 0;
    for (;;) {
      CycleEntry* entry = queue.Front();
      if (entry == nullptr) {
        std::this_thread::yield();
        continue;
      }
      ASSERT_GT(entry->input.cycle, last);
      last = entry->input.cycle;
      queue.Release();
      ++seen;
      if (last == kCount) return;
    }
  });
  for (std::uint64_t i = 1; i <= kCount; ++i) {
    while (queue.size() == queue.capacity()) std::this_thread::yield();
    queue.Reserve()->input.cycle = i;
    queue.Publish();
  }
  reader.join();
  EXPECT_EQ(seen + queue.dropped(), kCount);
  EXPECT_EQ(queue.dropped(), 0u);
}

}  // namespace
}  // namespace contour
