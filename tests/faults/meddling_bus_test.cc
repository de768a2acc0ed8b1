#include "tools/faults/meddling_bus.h"

#include <gtest/gtest.h>

#include <vector>

namespace contour::faults {
namespace {

/// Gives one frame per call, numbered in its first byte, and remembers what was sent.
class CountingBus final : public FrameBus {
 public:
  std::size_t Receive(std::int64_t now_ns, std::span<StampedFrame> frames) noexcept override {
    frames[0] = {CanFrame{0x181, 8, {}}, 0, now_ns};
    frames[0].frame.data[0] = ++number_;
    return 1;
  }
  std::size_t Send(std::int64_t, std::span<const CanFrame> frames) noexcept override {
    sent.insert(sent.end(), frames.begin(), frames.end());
    return frames.size();
  }
  [[nodiscard]] BusState State() const noexcept override { return {}; }
  std::vector<CanFrame> sent;

 private:
  std::uint8_t number_ = 0;
};

class Meddled : public ::testing::Test {
 protected:
  std::vector<int> Numbers(int calls) {
    std::vector<int> numbers;
    for (int i = 0; i < calls; ++i) {
      std::array<StampedFrame, 8> frames;
      const std::size_t n = bus_.Receive(++now_, frames);
      for (std::size_t k = 0; k < n; ++k) numbers.push_back(frames[k].frame.data[0]);
    }
    return numbers;
  }
  CountingBus inner_;
  MeddlingBus bus_{inner_};
  std::int64_t now_ = 0;
};

using What = Meddling::What;

TEST_F(Meddled, NothingIsChangedUnasked) { EXPECT_EQ(Numbers(3), (std::vector{1, 2, 3})); }

TEST_F(Meddled, LosesSoManyFramesOfOneIdentifier) {
  bus_.Begin({What::kDrop, 0x181, 2});
  bus_.Begin({What::kDrop, 0x182});
  EXPECT_EQ(Numbers(4), (std::vector{3, 4}));
}

TEST_F(Meddled, HoldsAFrameBackForCycles) {
  bus_.Begin({What::kDelay, 0x181, 1, 2});
  EXPECT_EQ(Numbers(4), (std::vector{2, 1, 3, 4}));
}

TEST_F(Meddled, DoublesAFrame) {
  bus_.Begin({What::kDouble, 0x181, 1});
  EXPECT_EQ(Numbers(2), (std::vector{1, 1, 2}));
}

TEST_F(Meddled, FlipsABit) {
  bus_.Begin({What::kFlip, 0x181, 1, 1, 0, 4});
  EXPECT_EQ(Numbers(2), (std::vector{17, 2}));
}

TEST_F(Meddled, WhatIsLostOnTheWayToTheDrivesCountsAsSent) {
  bus_.Begin({What::kDrop, 0x201, 1});
  const std::array frames{CanFrame{0x201, 0, {}}, CanFrame{0x080, 0, {}}};
  EXPECT_EQ(bus_.Send(1, frames), 2U);
  ASSERT_EQ(inner_.sent.size(), 1U);
  EXPECT_EQ(inner_.sent[0].id, 0x080);
}

TEST_F(Meddled, EndsWithEverythingGoingItsWay) {
  bus_.Begin({What::kDrop, 0x181});
  EXPECT_TRUE(Numbers(2).empty());
  bus_.End();
  EXPECT_EQ(Numbers(1), (std::vector{3}));
}

}  // namespace
}  // namespace contour::faults
