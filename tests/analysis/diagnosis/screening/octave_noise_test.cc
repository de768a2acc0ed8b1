#include "analysis/diagnosis/screening/octave_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <random>

namespace contour::diagnosis {
namespace {

/// Of two degrees, from the `louder`-th on so many times as much.
std::vector<double> Noise(std::size_t count, std::size_t louder = 0, double times = 1.0) {
  std::mt19937_64 random(7);
  std::exponential_distribution<double> chi_square(0.5);
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(chi_square(random) * (i < louder ? 1.0 : times));
  return out;
}

std::size_t Largest(const std::vector<double>& scores) {
  return static_cast<std::size_t>(std::max_element(scores.begin(), scores.end()) - scores.begin());
}

TEST(OctaveNoise, AWaveBelowNoiseThatIsLouderAboveItIsTheLargest) {
  std::vector<double> scores = Noise(40, 15, 300.0);
  scores[1] = 300.0;
  ASSERT_GT(Largest(scores), 15u);
  OverTheOctave(scores);
  EXPECT_EQ(Largest(scores), 1u);
}

TEST(OctaveNoise, AWaveInTheNoiseThatIsThereKeepsWhatItHasOverIt) {
  std::vector<double> scores = Noise(2000, 0, 10.0);
  scores[700] = 1000.0;
  OverTheOctave(scores);
  EXPECT_EQ(Largest(scores), 700u);
  EXPECT_NEAR(scores[700], 100.0, 15.0);
}

TEST(OctaveNoise, TheFirstOrdersAreNotTheirOwnNoise) {
  // Order 1 alone, and orders 1 and 2, where an octave has hardly more than these.
  std::vector<double> scores(144, 1.0);
  scores[0] = 200.0;
  OverTheOctave(scores);
  EXPECT_EQ(scores[0], 200.0);
  scores[1] = 300.0;
  OverTheOctave(scores);
  EXPECT_EQ(scores[0], 200.0);
  EXPECT_EQ(scores[1], 300.0);
}

TEST(OctaveNoise, NoScoreIsRaised) {
  const std::vector<double> before = Noise(500, 0, 0.1);
  std::vector<double> after = before;
  OverTheOctave(after);
  EXPECT_EQ(after, before);
  std::vector<double> none;
  OverTheOctave(none);
  EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace contour::diagnosis
