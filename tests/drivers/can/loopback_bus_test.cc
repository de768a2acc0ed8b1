#include "drivers/can/loopback_bus.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "drivers/can/frame_timing.h"
#include "tests/support/allocation_guard.h"

namespace contour {
namespace {

constexpr std::uint32_t kBitrate = 1'000'000;

CanFrame Frame(std::uint16_t id, std::uint8_t length = 8) {
  CanFrame f{id, length, {}};
  for (std::uint8_t i = 0; i < length; ++i) f.data[i] = static_cast<std::uint8_t>(0xA5 + i);
  return f;
}
std::int64_t Duration_ns(const CanFrame& f) { return BitsToNs(FrameBits(f), kBitrate); }
std::int64_t ToLastBit_ns(const CanFrame& f) { return BitsToNs(FrameBits(f) - kIntermissionBits, kBitrate); }

/// Answers every SYNC with its replies; sends a frame when its timer runs out; writes down what it sees.
class ScriptedNode : public BusNode {
 public:
  struct Seen {
    CanFrame frame;
    std::int64_t time_ns;
  };
  void OnFrame(const CanFrame& frame, std::int64_t time_ns, PendingFrames& out) noexcept override {
    if (seen_count < seen.size()) seen[seen_count++] = {frame, time_ns};
    if (frame.id != 0x080) return;
    for (const PendingFrame& p : replies) out.push_back({p.frame, time_ns + p.ready_ns});
  }
  void OnTimer(std::int64_t time_ns, PendingFrames& out) noexcept override {
    timers.push_back(time_ns);
    out.push_back({Frame(0x701, 1), time_ns});
    timer_ns += timer_period_ns;
  }
  [[nodiscard]] std::int64_t NextTimer() const noexcept override { return timer_ns; }

  std::vector<PendingFrame> replies;
  std::array<Seen, 256> seen{};
  std::size_t seen_count = 0;
  std::vector<std::int64_t> timers;
  std::int64_t timer_ns = kNever;
  std::int64_t timer_period_ns = 1'000'000;
};

std::vector<StampedFrame> ReceiveAll(LoopbackBus& bus, std::int64_t now_ns) {
  std::vector<StampedFrame> frames(300);
  frames.resize(bus.Receive(now_ns, frames));
  return frames;
}

TEST(LoopbackBus, AFrameTakesItsOwnBits) {
  ScriptedNode node;
  LoopbackBus bus(kBitrate, {&node});
  const CanFrame f = Frame(0x201, 4);
  EXPECT_EQ(bus.Send(1000, std::span(&f, 1)), 1u);
  ReceiveAll(bus, 1000 + ToLastBit_ns(f) - 1);
  EXPECT_EQ(node.seen_count, 0u);
  ReceiveAll(bus, 1000 + ToLastBit_ns(f));
  ASSERT_EQ(node.seen_count, 1u);
  EXPECT_EQ(node.seen[0].frame, f);
  EXPECT_EQ(node.seen[0].time_ns, 1000 + ToLastBit_ns(f));
}

TEST(LoopbackBus, RepliesArriveInOrderOfTheirIdentifiers) {
  ScriptedNode a;
  ScriptedNode b;
  a.replies = {{Frame(0x582), 0}, {Frame(0x182), 0}};
  b.replies = {{Frame(0x181), 0}};
  LoopbackBus bus(kBitrate, {&a, &b});
  const CanFrame sync = Frame(0x080, 0);
  bus.Send(0, std::span(&sync, 1));
  const auto got = ReceiveAll(bus, 1'000'000);
  ASSERT_EQ(got.size(), 3u);
  EXPECT_EQ(got[0].frame.id, 0x181);
  EXPECT_EQ(got[1].frame.id, 0x182);
  EXPECT_EQ(got[2].frame.id, 0x582);
  std::int64_t t = Duration_ns(sync);
  EXPECT_EQ(got[0].stamp_ns, t + ToLastBit_ns(got[0].frame));
  t += Duration_ns(got[0].frame);
  EXPECT_EQ(got[1].stamp_ns, t + ToLastBit_ns(got[1].frame));
  // Everyone but the sender has seen them.
  EXPECT_EQ(a.seen_count, 2u);
  EXPECT_EQ(b.seen_count, 3u);
}

TEST(LoopbackBus, WhatIsOnTheWireIsNotInterrupted) {
  ScriptedNode node;
  node.timer_ns = 0;  // heartbeat at time 0
  node.timer_period_ns = kNever / 2;
  LoopbackBus bus(kBitrate, {&node});
  const CanFrame heartbeat = Frame(0x701, 1);
  ReceiveAll(bus, 10'000);
  const CanFrame sync = Frame(0x080, 0);
  bus.Send(10'000, std::span(&sync, 1));  // in the middle of the heartbeat
  const auto got = ReceiveAll(bus, 1'000'000);
  ASSERT_EQ(got.size(), 1u);
  EXPECT_EQ(got[0].stamp_ns, ToLastBit_ns(heartbeat));
  ASSERT_EQ(node.seen_count, 1u);
  EXPECT_EQ(node.seen[0].time_ns, Duration_ns(heartbeat) + ToLastBit_ns(sync));
}

TEST(LoopbackBus, TheMastersQueueIsFirstInFirstOut) {
  ScriptedNode node;
  node.replies = {{Frame(0x181), 0}};
  LoopbackBus bus(kBitrate, {&node});
  // The RPDO goes before the SYNC although SYNC has the lower identifier; the SDO behind them lets the TPDO
  // pass.
  const std::array<CanFrame, 3> batch{Frame(0x201, 4), Frame(0x080, 0), Frame(0x601)};
  EXPECT_EQ(bus.Send(0, batch), 3u);
  const auto got = ReceiveAll(bus, 2'000'000);
  ASSERT_EQ(node.seen_count, 3u);
  EXPECT_EQ(node.seen[0].frame.id, 0x201);
  EXPECT_EQ(node.seen[1].frame.id, 0x080);
  EXPECT_EQ(node.seen[2].frame.id, 0x601);
  ASSERT_EQ(got.size(), 1u);
  EXPECT_LT(got[0].stamp_ns, node.seen[2].time_ns);
}

TEST(LoopbackBus, ALateReplyWaitsForItsTime) {
  ScriptedNode node;
  node.replies = {{Frame(0x181), 300'000}};
  LoopbackBus bus(kBitrate, {&node});
  const CanFrame sync = Frame(0x080, 0);
  bus.Send(0, std::span(&sync, 1));
  const auto got = ReceiveAll(bus, 1'000'000);
  ASSERT_EQ(got.size(), 1u);
  EXPECT_EQ(got[0].stamp_ns, ToLastBit_ns(sync) + 300'000 + ToLastBit_ns(got[0].frame));
}

TEST(LoopbackBus, TimersRunAtTheirTimesHoweverSeldomItIsCalled) {
  ScriptedNode node;
  node.timer_ns = 500'000;
  LoopbackBus bus(kBitrate, {&node});
  const auto got = ReceiveAll(bus, 4'000'000);
  EXPECT_EQ(node.timers, (std::vector<std::int64_t>{500'000, 1'500'000, 2'500'000, 3'500'000}));
  ASSERT_EQ(got.size(), 4u);
  EXPECT_EQ(got[3].stamp_ns, 3'500'000 + ToLastBit_ns(got[3].frame));
}

TEST(LoopbackBus, TheSameHoweverOftenItIsCalled) {
  const auto run = [](std::int64_t step_ns) {
    ScriptedNode a;
    ScriptedNode b;
    a.replies = {{Frame(0x181), 10'000}, {Frame(0x081), 70'000}};
    b.replies = {{Frame(0x182), 0}};
    a.timer_ns = 123'456;
    LoopbackBus bus(kBitrate, {&a, &b});
    std::vector<StampedFrame> all;
    for (int cycle = 0; cycle < 20; ++cycle) {
      const std::int64_t grid = cycle * 1'000'000;
      const std::array<CanFrame, 3> batch{Frame(0x201, 4), Frame(0x202, 4), Frame(0x080, 0)};
      for (std::int64_t t = grid; t < grid + 1'000'000; t += step_ns) {
        for (const StampedFrame& f : ReceiveAll(bus, t)) all.push_back(f);
        if (t == grid) bus.Send(t, batch);
      }
    }
    return all;
  };
  const auto once = run(1'000'000);
  const auto often = run(50'000);
  ASSERT_LE(once.size(), often.size());
  ASSERT_GT(once.size(), 70u);
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].frame, often[i].frame);
    EXPECT_EQ(once[i].stamp_ns, often[i].stamp_ns);
  }
}

TEST(LoopbackBus, AFullQueueIsAFailureToSend) {
  ScriptedNode node;
  LoopbackBus bus(kBitrate, {&node});
  const std::vector<CanFrame> batch(LoopbackBus::kSendQueue + 5, Frame(0x201));
  EXPECT_EQ(bus.Send(0, batch), LoopbackBus::kSendQueue);
  EXPECT_EQ(bus.State().send_failures, 5u);
  ReceiveAll(bus, 1'000'000'000);
  EXPECT_EQ(node.seen_count, LoopbackBus::kSendQueue);
  EXPECT_EQ(bus.Send(1'000'000'000, std::span(batch).first(3)), 3u) << "it recovers";
}

TEST(LoopbackBus, FramesNobodyTakesOverflow) {
  ScriptedNode node;
  node.timer_ns = 0;
  node.timer_period_ns = 100'000;
  LoopbackBus bus(kBitrate, {&node});
  std::array<StampedFrame, 1> one;
  bus.Receive(static_cast<std::int64_t>(LoopbackBus::kReceiveQueue + 10) * 100'000, one);
  EXPECT_GT(bus.State().receive_overflows, 0u);
}

TEST(LoopbackBus, ALinkThatIsDownLosesFramesAndComesBack) {
  ScriptedNode node;
  node.replies = {{Frame(0x181), 0}};
  node.timer_ns = 300'000;
  LoopbackBus bus(kBitrate, {&node});
  const CanFrame sync = Frame(0x080, 0);
  bus.Send(0, std::span(&sync, 1));
  bus.SetLink(20'000, false);  // the SYNC is still on the wire
  EXPECT_FALSE(bus.State().up);
  EXPECT_EQ(bus.Send(100'000, std::span(&sync, 1)), 0u);
  EXPECT_EQ(bus.State().send_failures, 1u);
  EXPECT_TRUE(ReceiveAll(bus, 2'000'000).empty());
  EXPECT_EQ(node.seen_count, 0u);
  EXPECT_EQ(node.timers.size(), 2u) << "the node's own time goes on";
  bus.SetLink(2'000'000, true);
  bus.Send(2'000'000, std::span(&sync, 1));
  const auto got = ReceiveAll(bus, 2'290'000);
  ASSERT_EQ(got.size(), 1u);
  EXPECT_EQ(got[0].frame.id, 0x181);
}

TEST(LoopbackBus, TellsWhenTheMastersOwnFrameWasOnTheWire) {
  ScriptedNode node;
  LoopbackBus bus(kBitrate, {&node});
  bus.TellOf(0x080);
  // A stranger's frame of the same identifier is his, and holds ours up.
  const CanFrame sync = Frame(0x080, 0), setpoint = Frame(0x201, 4);
  bus.Inject(0, sync);
  bus.Send(0, std::array{setpoint, sync});
  const auto got = ReceiveAll(bus, 1'000'000);
  ASSERT_EQ(got.size(), 2u) << "no set-point";
  EXPECT_EQ(got[0].frame.id, 0x080);
  EXPECT_EQ(got[1].frame.id, kOwnFrame | 0x080);
  EXPECT_EQ(got[1].stamp_ns, Duration_ns(sync) + Duration_ns(setpoint) + ToLastBit_ns(sync));
  EXPECT_EQ(bus.State().frames_received, 1u) << "what came from others";
  EXPECT_EQ(node.seen_count, 3u);
}

TEST(LoopbackBus, TouchesNoHeap) {
  if (!test::AllocationGuard::kAvailable) GTEST_SKIP() << "the sanitizer owns the heap";
  ScriptedNode node;
  node.replies = {{Frame(0x181), 0}, {Frame(0x081), 50'000}};
  LoopbackBus bus(kBitrate, {&node});
  const std::array<CanFrame, 2> batch{Frame(0x201, 4), Frame(0x080, 0)};
  std::array<StampedFrame, 64> frames;
  std::size_t received = 0;
  const test::AllocationGuard guard;
  for (int k = 0; k < 100; ++k) {
    received += bus.Receive(k * 1'000'000, frames);
    bus.Send(k * 1'000'000, batch);
  }
  EXPECT_EQ(guard.calls(), 0u);
  EXPECT_EQ(received, 198u);
}

TEST(LoopbackBus, RefusesABitRateOfZero) { EXPECT_THROW(LoopbackBus(0, {}), std::invalid_argument); }

}  // namespace
}  // namespace contour
