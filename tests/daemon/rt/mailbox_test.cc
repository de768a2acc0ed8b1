#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "daemon/rt/command_mailbox.h"
#include "daemon/rt/telemetry_queue.h"

namespace contour {
namespace {

TEST(CommandMailbox, StopOvertakesAndIsNotOverwritten) {
  CommandMailbox mailbox(8, 8);
  mailbox.Post(RequestKind::kReset);
  mailbox.Post(RequestKind::kDisable);
  const std::uint32_t stop = mailbox.PostStop();
  mailbox.Post(RequestKind::kRun, 5);
  const Request first = mailbox.TakeRequest();
  EXPECT_EQ(first.kind, RequestKind::kStop);
  EXPECT_EQ(first.sequence, stop);
  EXPECT_EQ(mailbox.TakeRequest().kind, RequestKind::kReset);
  EXPECT_EQ(mailbox.TakeRequest().kind, RequestKind::kDisable);
  const Request run = mailbox.TakeRequest();
  EXPECT_EQ(run.kind, RequestKind::kRun) << "asked for after the stop";
  EXPECT_EQ(run.program_id, 5u);
  EXPECT_EQ(mailbox.TakeRequest().kind, RequestKind::kNone);
}

TEST(CommandMailbox, NothingAskedForBeforeAStopLeadsToMotionAfterIt) {
  for (const bool terminate : {false, true}) {
    CommandMailbox mailbox(8, 8);
    const std::uint32_t enable = mailbox.Post(RequestKind::kEnable);
    const std::uint32_t run = mailbox.Post(RequestKind::kRun, 5);
    terminate ? mailbox.PostTerminate() : mailbox.PostStop();
    const std::uint32_t later = mailbox.Post(RequestKind::kEnable);
    mailbox.TakeRequest();
    EXPECT_EQ(mailbox.TakeRequest().sequence, later);
    EXPECT_EQ(mailbox.TakeRequest().kind, RequestKind::kNone);
    EXPECT_EQ(mailbox.Fate(enable), RequestFate::kVoid);
    EXPECT_EQ(mailbox.Fate(run), RequestFate::kVoid);
    EXPECT_EQ(mailbox.Fate(later), RequestFate::kTaken);
  }
}

TEST(CommandMailbox, HoldsOrdinaryRequestsBackButNotAStop) {
  CommandMailbox mailbox(8, 8);
  mailbox.Post(RequestKind::kReset);
  EXPECT_EQ(mailbox.TakeRequest(false).kind, RequestKind::kNone);
  mailbox.PostTerminate();
  EXPECT_EQ(mailbox.TakeRequest(false).kind, RequestKind::kTerminate);
  EXPECT_EQ(mailbox.TakeRequest().kind, RequestKind::kReset);
}

TEST(CommandMailbox, WithdrawnRequestsAreNotCarriedOutAndNoOtherIs) {
  CommandMailbox mailbox(8, 8);
  const std::uint32_t reset = mailbox.Post(RequestKind::kReset);
  const std::uint32_t enable = mailbox.Post(RequestKind::kEnable);
  EXPECT_TRUE(mailbox.Withdraw(enable));
  EXPECT_EQ(mailbox.TakeRequest().sequence, reset) << "withdrawn is the one, not all before it";
  EXPECT_EQ(mailbox.TakeRequest().kind, RequestKind::kNone);
  EXPECT_EQ(mailbox.Fate(enable), RequestFate::kWithdrawn);
}

TEST(CommandMailbox, WhatTheCycleHasTakenCannotBeWithdrawn) {
  CommandMailbox mailbox(8, 8);
  const std::uint32_t enable = mailbox.Post(RequestKind::kEnable);
  EXPECT_EQ(mailbox.Fate(enable), RequestFate::kWaiting);
  EXPECT_EQ(mailbox.TakeRequest().sequence, enable);
  EXPECT_FALSE(mailbox.Withdraw(enable));
  EXPECT_EQ(mailbox.Fate(enable), RequestFate::kTaken);
}

// Whoever withdraws and the cycle may meet over a request: one of them gets it, never both and never none.
TEST(CommandMailbox, ARequestIsEitherTakenOrWithdrawn) {
  CommandMailbox mailbox(4, 4);
  constexpr int kRequests = 20000;
  std::atomic<bool> ended{false};
  std::vector<std::uint32_t> taken;
  std::thread cycle([&] {
    for (;;) {
      const bool last = ended;
      const Request request = mailbox.TakeRequest();
      if (request.kind != RequestKind::kNone) {
        taken.push_back(request.sequence);
      } else if (last) {
        return;
      } else {
        // Or, on one core, nothing is posted before its time slice has run out.
        std::this_thread::yield();
      }
    }
  });
  std::vector<std::uint32_t> not_withdrawn;
  for (int i = 0; i < kRequests; ++i) {
    std::uint32_t sequence = 0;
    while ((sequence = mailbox.Post(RequestKind::kReset)) == 0) std::this_thread::yield();
    if (i % 3 != 0) std::this_thread::yield();
    if (!mailbox.Withdraw(sequence)) not_withdrawn.push_back(sequence);
  }
  ended = true;
  cycle.join();
  EXPECT_EQ(taken, not_withdrawn);
}

TEST(CommandMailbox, SaysWhenItIsFullAndKeepsPlacesForADisable) {
  CommandMailbox mailbox(8, 2);
  for (int i = 0; i < 6; ++i) EXPECT_NE(mailbox.Post(RequestKind::kReset), 0u);
  EXPECT_EQ(mailbox.Post(RequestKind::kReset), 0u);
  EXPECT_NE(mailbox.Post(RequestKind::kDisable), 0u);
  EXPECT_NE(mailbox.Post(RequestKind::kDisable), 0u);
  EXPECT_EQ(mailbox.Post(RequestKind::kDisable), 0u);
  EXPECT_TRUE(mailbox.PushPathPoint({}));
  EXPECT_TRUE(mailbox.PushPathPoint({}));
  EXPECT_FALSE(mailbox.PushPathPoint({}));
}

TEST(AnswerBoard, HasTheNewestRecordAndEveryAnswerWhateverTheQueueDrops) {
  TelemetryQueue queue(2);
  const auto publish = [&](std::uint64_t cycle, std::uint32_t acknowledged) {
    CycleRecord& record = queue.Reserve()->output.record;
    record = {};
    record.cycle = cycle;
    record.acknowledged = acknowledged;
    queue.Publish();
  };
  // Nobody empties the queue. A stop, sequence 6, overtook the request before it.
  std::uint64_t cycle = 0;
  for (const std::uint32_t acknowledged : {0u, 4u, 4u, 6u, 5u, 5u}) publish(++cycle, acknowledged);
  EXPECT_EQ(queue.dropped(), 4u);
  EXPECT_EQ(queue.board().Newest().cycle, 6u);
  EXPECT_EQ(queue.board().Newest().cycle, 6u) << "looked at again";
  CycleRecord answer;
  for (const auto& [sequence, in_cycle] : {std::pair{4u, 2u}, {6u, 4u}, {5u, 5u}}) {
    ASSERT_TRUE(queue.board().TakeAnswer(answer));
    EXPECT_EQ(answer.acknowledged, sequence);
    EXPECT_EQ(answer.cycle, in_cycle) << "the record that answered, not the newest";
  }
  EXPECT_FALSE(queue.board().TakeAnswer(answer));
}

TEST(AnswerBoard, ARecordIsWholeWhoeverLooksMeanwhile) {
  TelemetryQueue queue(2);
  constexpr std::uint64_t kCycles = 20000;
  std::thread loop([&] {
    for (std::uint64_t cycle = 1; cycle <= kCycles; ++cycle) {
      CycleRecord& record = queue.Reserve()->output.record;
      record.cycle = record.stale_cycles = cycle;
      record.axes.resize(kMaxAxes);
      record.axes[kMaxAxes - 1].position_m = static_cast<double>(cycle);
      queue.Publish();
    }
  });
  std::uint64_t last = 0;
  while (last < kCycles) {
    const CycleRecord& record = queue.board().Newest();
    ASSERT_GE(record.cycle, last);
    last = record.cycle;
    ASSERT_EQ(record.stale_cycles, last);
    if (last == 0) continue;
    ASSERT_EQ(record.axes[kMaxAxes - 1].position_m, static_cast<double>(last));
  }
  loop.join();
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
