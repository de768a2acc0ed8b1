#include "analysis/prediction_error/stands_out.h"

#include <gtest/gtest.h>

#include <limits>

namespace contour::diagnosis {
namespace {

std::vector<double> Noise(double loud_from = 1e9) {
  std::vector<double> out(4000);
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = (k % 2 == 0 ? 1.0 : -1.0) * (static_cast<double>(k) >= loud_from ? 20.0 : 1.0);
  return out;
}

TEST(StandsOut, OnlyWhatIsFarBeyondTheWholeLogAndItsNeighbourhood) {
  std::vector<double> values = Noise(3000);
  values[1000] = 60.0;
  values[3500] = 60.0;
  StandsOut stands_out(values, 0.0);
  EXPECT_TRUE(stands_out(1000));
  EXPECT_FALSE(stands_out(3500));  // as loud there anyway
  EXPECT_FALSE(stands_out(999));
}

TEST(StandsOut, CountsOfTheEncoderCome) {
  std::vector<double> values = Noise();
  values[1000] = 60.0;
  StandsOut stands_out(values, 10.0);
  EXPECT_FALSE(stands_out(1000));
}

// A count that flickers at rest, of an encoder whose counts nobody stated.
TEST(StandsOut, NothingStandsOutFromALogThatRestsMostOfTheTime) {
  std::vector<double> values(4000, 0.0);
  for (std::size_t k = 0; k < 1500; ++k) values[k] = (k % 2 == 0 ? 1.0 : -1.0);
  values[2500] = 1.0;
  StandsOut stands_out(values, 0.0);
  EXPECT_FALSE(stands_out(2500));
}

TEST(StandsOut, MissingValuesAreNone) {
  std::vector<double> values = Noise();
  for (std::size_t k = 0; k < 900; ++k) values[k] = std::numeric_limits<double>::quiet_NaN();
  values[1000] = 60.0;
  StandsOut stands_out(values, 0.0);
  EXPECT_TRUE(stands_out(1000));
  EXPECT_FALSE(stands_out(500));
}

}  // namespace
}  // namespace contour::diagnosis
