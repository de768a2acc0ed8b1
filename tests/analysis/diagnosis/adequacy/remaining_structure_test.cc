// The statistic on residuals that are made here, so that what is in them is known.

#include "analysis/diagnosis/adequacy/remaining_structure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace contour::diagnosis {
namespace {

constexpr std::size_t kRows = 20000;
constexpr int kBins = 40;

/// A table that goes to and fro: bins in the order of the travel, each seen many times.
BinnedRows Places() {
  BinnedRows rows;
  rows.over = "the position";
  rows.quantity = Quantity::kPosition;
  rows.count = kBins;
  rows.bin.resize(kRows);
  for (std::size_t k = 0; k < kRows; ++k) {
    const auto at = static_cast<int>(k / 25 % (2 * kBins));
    rows.bin[k] = at < kBins ? at : 2 * kBins - 1 - at;
  }
  rows.place = [](int b) { return "place " + std::to_string(b); };
  return rows;
}

BinnedRows Nothing() {
  BinnedRows rows;
  rows.bin.assign(kRows, -1);
  return rows;
}

/// Direction of the travel as a sign, the same in all bins: a friction.
BinnedRows Friction() {
  BinnedRows rows;
  rows.bin.assign(kRows, 0);
  rows.count = 1;
  rows.size.resize(kRows);
  for (std::size_t k = 0; k < kRows; ++k) rows.size[k] = k / 25 % (2 * kBins) < kBins ? 1.0 : -1.0;
  return rows;
}

std::vector<double> White(unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> out(kRows);
  for (double& x : out) x = normal(random);
  return out;
}

/// Gradient of |r|^2 / 2 by a torque at each row, whose pulse makes `response` of the residual.
std::vector<double> GradientOf(const std::vector<double>& residual, const std::vector<double>& response) {
  std::vector<double> out(kRows, 0.0);
  for (std::size_t k = 0; k < kRows; ++k)
    for (std::size_t i = 0; i < response.size() && k + i < kRows; ++i)
      out[k] += response[i] * residual[k + i];
  return out;
}

void Add(const std::vector<double>& torque, const std::vector<double>& response,
         std::vector<double>& residual) {
  for (std::size_t k = 0; k < kRows; ++k)
    for (std::size_t i = 0; i < response.size() && k + i < kRows; ++i)
      residual[k + i] += response[i] * torque[k];
}

const std::vector<double> kPulse = {1.0, 0.7, 0.3, -0.2};
const std::vector<double> kEqual(kRows, 1.0);

TEST(RemainingStructure, OfWhiteNoiseIsAsProbableAsItSays) {
  constexpr int kDraws = 200;
  int beyond = 0;
  double bins = 0.0, drop = 0.0;
  for (unsigned seed = 1; seed <= kDraws; ++seed) {
    const RemainingStructure one =
        TestBins(Places(), Nothing(), GradientOf(White(seed), kPulse), kPulse, kEqual);
    beyond += one.score > -2.0 * std::log(0.05);
    drop += one.drop;
    bins += one.bins;
  }
  EXPECT_NEAR(drop / bins, 1.0, 0.03);
  EXPECT_GE(beyond, 3);
  EXPECT_LE(beyond, 20);  // 10 are expected
}

TEST(RemainingStructure, SaysWhereAndHowMuch) {
  std::vector<double> residual = White(3), torque(kRows, 0.0);
  const BinnedRows places = Places();
  for (std::size_t k = 0; k < kRows; ++k)
    if (places.bin[k] == 31) torque[k] = -0.5;  // the model lacks +0.5 there
  Add(torque, kPulse, residual);
  const RemainingStructure one = TestBins(places, Nothing(), GradientOf(residual, kPulse), kPulse, kEqual);
  EXPECT_GT(one.score, 30.0);
  EXPECT_EQ(one.over, "the position");
  EXPECT_EQ(one.at, "place 31");
  EXPECT_NEAR(one.amount, 0.5, 0.1);
}

TEST(RemainingStructure, WhatIsKnownIsTakenOutAndDoesNotCount) {
  // A friction level that is off shows at every place in both directions.
  std::vector<double> residual = White(5);
  Add(
      [] {
        std::vector<double> torque = Friction().size;
        for (double& x : torque) x *= 0.3;
        return torque;
      }(),
      kPulse, residual);
  BinnedRows travels = Places();
  travels.count *= 2;
  const BinnedRows friction = Friction();
  for (std::size_t k = 0; k < kRows; ++k) travels.bin[k] += friction.size[k] > 0.0 ? kBins : 0;
  const std::vector<double> gradient = GradientOf(residual, kPulse);
  EXPECT_GT(TestBins(travels, Nothing(), gradient, kPulse, kEqual).score, 50.0);
  const RemainingStructure without = TestBins(travels, friction, gradient, kPulse, kEqual);
  EXPECT_LT(without.score, 12.0);
  EXPECT_NEAR(without.bins, 2.0 * kBins - 1.0, 0.1);
}

/// Of white noise and one whose memory is a second of rows at 1 kHz, as a corner below 1 Hz has it.
std::vector<double> Coloured(unsigned seed) {
  constexpr double kMemoryRows = 300.0, kShare = 0.5;
  std::vector<double> out = White(seed);
  const std::vector<double> drive = White(seed + 1000);
  const double keep = std::exp(-1.0 / kMemoryRows);
  double slow = 0.0;
  for (std::size_t k = 0; k < kRows; ++k) {
    slow = keep * slow + std::sqrt(1.0 - keep * keep) * drive[k];
    out[k] += kShare * slow;
  }
  return out;
}

BinnedRows Times() {
  BinnedRows rows;
  rows.over = "time";
  rows.quantity = Quantity::kTime;
  rows.count = 80;
  rows.bin.resize(kRows);
  for (std::size_t k = 0; k < kRows; ++k) rows.bin[k] = static_cast<int>(k * 80 / kRows);
  return rows;
}

TEST(RemainingStructure, ColouredNoiseIsNone) {
  constexpr int kDraws = 100;
  // Three strokes each way, as many as a log of few visits has; and bins of time, seen once.
  BinnedRows places = Places();
  places.quantity = Quantity::kPosition;
  for (std::size_t k = 0; k < kRows; ++k) {
    const auto at = static_cast<int>(k / 83 % (2 * kBins));
    places.bin[k] = at < kBins ? at : 2 * kBins - 1 - at;
  }
  int by_place = 0, by_time = 0;
  for (unsigned seed = 1; seed <= kDraws; ++seed) {
    const std::vector<double> gradient = GradientOf(Coloured(seed), {1.0});
    by_place += TestBins(places, Nothing(), gradient, {1.0}, kEqual).score > -2.0 * std::log(0.01);
    by_time += TestBins(Times(), Nothing(), gradient, {1.0}, kEqual).score > -2.0 * std::log(0.01);
  }
  EXPECT_LE(by_place, 8);
  EXPECT_LE(by_time, 8);
}

TEST(RemainingStructure, WhatWasSeenOnceSaysNothing) {
  // A single stroke: a shape of the place and one of the time are the same.
  BinnedRows once = Times();
  once.quantity = Quantity::kPosition;
  once.count = kBins;
  for (std::size_t k = 0; k < kRows; ++k) once.bin[k] = static_cast<int>(k * kBins / kRows);
  std::vector<double> residual = White(11), torque(kRows, 0.0);
  for (std::size_t k = 0; k < kRows; ++k) torque[k] = once.bin[k] < 3 ? 0.5 : 0.0;
  Add(torque, {1.0}, residual);
  EXPECT_LT(TestBins(once, Nothing(), GradientOf(residual, {1.0}), {1.0}, kEqual).score, 60.0);
}

TEST(RemainingStructure, RowsThatWeighLittleSayLittle) {
  const BinnedRows places = Places();
  std::vector<double> weight(kRows), torque(kRows, 0.0), residual = White(7);
  for (std::size_t k = 0; k < kRows; ++k) {
    weight[k] = k < kRows / 2 ? 1.0 : 0.01;
    if (places.bin[k] == 5 && k >= kRows / 2) torque[k] = 0.5;
  }
  Add(torque, {1.0}, residual);
  // The residual that the gradient is of has the weight in it once, its response a second time.
  std::vector<double> gradient(kRows);
  for (std::size_t k = 0; k < kRows; ++k) gradient[k] = weight[k] * weight[k] * residual[k];
  EXPECT_LT(TestBins(places, Nothing(), gradient, {1.0}, weight).score, 12.0);
}

}  // namespace
}  // namespace contour::diagnosis
