#include "daemon/rt/bus_share.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <vector>

namespace contour {
namespace {

/// Hands over what was put into it.
class QueuedBus final : public FrameBus {
 public:
  void Put(std::uint16_t id, std::uint8_t value = 0, int times = 1) {
    for (int i = 0; i < times; ++i) waiting_.push_back({{id, 1, {value}}, 0, stamp_ns_++});
  }
  std::size_t Receive(std::int64_t, std::span<StampedFrame> frames) noexcept override {
    const std::size_t count = std::min(frames.size(), waiting_.size());
    for (std::size_t i = 0; i < count; ++i) {
      frames[i] = waiting_.front();
      waiting_.pop_front();
    }
    return count;
  }
  std::size_t Send(std::int64_t, std::span<const CanFrame> frames) noexcept override { return frames.size(); }
  [[nodiscard]] BusState State() const noexcept override { return {.up = true}; }
  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }

 private:
  std::deque<StampedFrame> waiting_;
  std::int64_t stamp_ns_ = 1;
};

BusNodes Nodes(std::initializer_list<int> ids) {
  BusNodes nodes;
  for (const int id : ids) nodes.Add(id);
  return nodes;
}

using Identifiers = std::vector<std::uint16_t>;

std::vector<std::uint16_t> Ids(const ReceivedFrames& frames, std::uint8_t bus) {
  std::vector<std::uint16_t> ids;
  for (const StampedFrame& f : frames)
    if (f.bus == bus) ids.push_back(f.frame.id);
  return ids;
}

std::ptrdiff_t Count(const std::vector<std::uint16_t>& ids, std::uint16_t id) {
  return std::count(ids.begin(), ids.end(), id);
}

TEST(BusTraffic, ByIdentifier) {
  const BusNodes nodes = Nodes({1, 5});
  for (const std::uint16_t id : Identifiers{0x181, 0x285, 0x381, 0x485, 0x081, 0x585, 0x701})
    EXPECT_EQ(nodes.Of(id), Traffic::kDrives) << id;
  for (const std::uint16_t id : Identifiers{0x000, 0x080, 0x201, 0x305, 0x401, 0x505, 0x605, 0x77F, 0x709})
    EXPECT_EQ(nodes.Of(id), Traffic::kMasters) << id;
  for (const std::uint16_t id : Identifiers{0x182, 0x082, 0x602, 0x100, 0x180, 0x003, 0x6E5})
    EXPECT_EQ(nodes.Of(id), Traffic::kOther) << id;
}

TEST(BusShare, ABabblingBusDoesNotStarveTheNext) {
  QueuedBus babbler;
  QueuedBus quiet;
  babbler.Put(0x123, 0, 200);
  quiet.Put(0x182);
  ReceivedFrames frames;
  EXPECT_EQ(TakeShare(babbler, 0, ShareOfBus(2), Nodes({1}), 0, frames), 168U);
  EXPECT_EQ(TakeShare(quiet, 1, ShareOfBus(2), Nodes({2}), 0, frames), 0U);
  EXPECT_EQ(Ids(frames, 1), std::vector<std::uint16_t>{0x182});
  EXPECT_EQ(babbler.waiting(), 0U) << "what is left would be a cycle old in the next one";
}

TEST(BusShare, WhatMattersIsKeptInOrder) {
  QueuedBus bus;
  bus.Put(0x123, 0, 100);
  bus.Put(0x080);
  bus.Put(0x123, 0, 100);
  bus.Put(0x081);
  bus.Put(0x181);
  bus.Put(0x201);
  bus.Put(0x123, 0, 100);
  ReceivedFrames frames;
  TakeShare(bus, 0, ShareOfBus(1), Nodes({1}), 0, frames);
  std::vector<std::uint16_t> ids = Ids(frames, 0);
  std::erase(ids, 0x123);
  EXPECT_EQ(ids, (std::vector<std::uint16_t>{0x080, 0x081, 0x181, 0x201}));
}

// A drive's own emergencies come before its feedback, by their identifier: a flood of them must leave
// feedback, and what tells of a second master.
TEST(BusShare, AFloodOfOneIdentifierOfOurOwnLeavesTheOthers) {
  QueuedBus bus;
  bus.Put(0x000);
  bus.Put(0x181, 1);
  bus.Put(0x081, 0, 150);
  bus.Put(0x701);
  bus.Put(0x081, 9, 150);
  bus.Put(0x182, 2);
  ReceivedFrames frames;
  EXPECT_EQ(TakeShare(bus, 0, 16, Nodes({1, 2}), 0, frames), 304U - 16U);
  const std::vector<std::uint16_t> ids = Ids(frames, 0);
  EXPECT_EQ(ids.size(), 16U);
  for (const std::uint16_t id : Identifiers{0x000, 0x181, 0x182, 0x701}) EXPECT_EQ(Count(ids, id), 1) << id;
  for (const StampedFrame& f : frames)
    EXPECT_TRUE(f.frame.id != 0x081 || f.frame.data[0] == 9) << "the newest stay";
}

TEST(BusShare, FeedbackThatCameTwiceKeepsTheNewest) {
  QueuedBus bus;
  bus.Put(0x181, 1, 100);
  bus.Put(0x181, 7);
  ReceivedFrames frames;
  TakeShare(bus, 0, 4, Nodes({1}), 0, frames);
  EXPECT_EQ(frames.back().frame.data[0], 7);
}

// Lock-step time asks several times for the same cycle.
TEST(BusShare, EarlierCallsCount) {
  QueuedBus bus;
  ReceivedFrames frames;
  bus.Put(0x123, 0, 20);
  EXPECT_EQ(TakeShare(bus, 1, 32, Nodes({1}), 0, frames), 0U);
  bus.Put(0x123, 0, 20);
  bus.Put(0x181);
  EXPECT_EQ(TakeShare(bus, 1, 32, Nodes({1}), 0, frames), 9U);
  EXPECT_EQ(frames.size(), 32U);
  EXPECT_EQ(Count(Ids(frames, 1), 0x181), 1);
}

TEST(BusShare, ABusThatNeverFallsSilentIsLeftAtTheBound) {
  QueuedBus bus;
  bus.Put(0x123, 0, 5000);
  ReceivedFrames frames;
  EXPECT_LE(TakeShare(bus, 0, 64, Nodes({1}), 0, frames), kMostFramesTaken);
  EXPECT_GT(bus.waiting(), 0U);
}

}  // namespace
}  // namespace contour
