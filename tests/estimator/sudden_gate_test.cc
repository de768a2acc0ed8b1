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

}  // namespace
}  // namespace contour
