// One reading that is suddenly off is left out; what lasts is believed.
#include <gtest/gtest.h>

#include <algorithm>

#include "estimator/gaussian.h"

namespace contour {
namespace {

bool Passes(const SuddenGate& gate, double innovation_m, double std_m) {
  return innovation_m <= std::max(gate.gate().sigmas * std_m, gate.gate().absolute);
}

TEST(SuddenGate, OneReadingIsLeftOutAndWhatLastsIsBelieved) {
  constexpr double kStd_m = 2e-8;
  SuddenGate gate({12.0, 20e-6}, 4e-6);
  EXPECT_TRUE(Passes(gate, 3e-6, kStd_m));
  EXPECT_FALSE(Passes(gate, 15e-6, kStd_m)) << "a SYNC that came late";
  gate.After(15e-6, kStd_m);
  EXPECT_TRUE(Passes(gate, 60e-6, kStd_m)) << "a force has gone on for two periods";
  gate.After(1e-8, kStd_m);
  EXPECT_FALSE(Passes(gate, 15e-6, kStd_m)) << "it was one reading, and so is the next";
}

// Before: of a swing every other reading or so was left out, which kept a loop swinging at half the sampling
// frequency (300 kg, one more cycle of delay than stated: 20 % of rated torque, for good).
TEST(SuddenGate, OfReadingsThatGoOnBeingOffNoneIsLeftOut) {
  constexpr double kStd_m = 2e-8;
  SuddenGate gate({12.0, 20e-6}, 2e-7);
  int left_out = 0;
  for (const double innovation_m : {1e-6, 1e-6, 1e-8, 1e-6, 1e-8, 1e-8, 1e-6, 5e-8, 1e-6}) {
    left_out += Passes(gate, innovation_m, kStd_m) ? 0 : 1;
    gate.After(innovation_m, kStd_m);
  }
  EXPECT_EQ(left_out, 1);
  for (int i = 0; i < 1000; ++i) gate.After(1e-8, kStd_m);
  EXPECT_FALSE(Passes(gate, 1e-6, kStd_m)) << "it is over";
}

}  // namespace
}  // namespace contour
