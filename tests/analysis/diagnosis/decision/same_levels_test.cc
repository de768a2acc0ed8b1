#include "analysis/diagnosis/decision/same_levels.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <span>
#include <utility>

#include "tests/analysis/diagnosis/decision/unknown_torque.h"

namespace contour::diagnosis {
namespace {

class SameLevelsTest : public test::UnknownTorque {
 protected:
  /// As large as that, of what it is; nothing else is fitted anew.
  [[nodiscard]] Fit Part(const Fit& whole, double share) const {
    Fit fit = whole;
    fit.point.amplitudes.back()[0] *= share;
    fit.residual = std::move(axis_.problem.Residuals(std::span(&fit.point, 1))[0]);
    return fit;
  }
};

TEST_F(SameLevelsTest, AreWhatBlocksDoNotTellApart) {
  const Fit there = Of("constant_torque").fit;
  // A difference of the levels of this size starts at other instants.
  EXPECT_FALSE(SameLevels(axis_.problem, there, "asymmetric_coulomb", 0.05));
  // Of a ten-thousandth of it both do the same.
  EXPECT_TRUE(SameLevels(axis_.problem, Part(there, 1e-4), "asymmetric_coulomb", 0.05));
}

TEST_F(SameLevelsTest, TheOtherIsAsLargeAsTheLevelsSay) {
  // A difference twice as large as the torque, over the level: exchanged, and back, it is the same torque.
  const Fit small = Part(Of("asymmetric_coulomb").fit, 1e-4);
  EXPECT_TRUE(SameLevels(axis_.problem, small, "constant_torque", 0.05));
}

TEST_F(SameLevelsTest, OfOneEventThatTellsNothingIsDecided) {
  // In one block of the log the torque explains far more than the other: the axis starts there, or does not.
  Fit there = Part(Of("constant_torque").fit, 1e-4);
  const auto n = static_cast<std::ptrdiff_t>(axis_.problem.rows());
  for (auto at = there.residual.begin(); at != there.residual.begin() + n / kBlocks; ++at) *at = 0.0;
  EXPECT_TRUE(SameLevels(axis_.problem, there, "asymmetric_coulomb", 0.05));
  for (double& r : there.residual) r *= 0.9;
  EXPECT_FALSE(SameLevels(axis_.problem, there, "asymmetric_coulomb", 0.05)) << "every block tells it";
}

TEST_F(SameLevelsTest, AreNoneOfWhatDoesSomethingElse) {
  EXPECT_FALSE(SameLevels(axis_.problem, Of("constant_torque").fit, "cable_spring", 0.05));
}

}  // namespace
}  // namespace contour::diagnosis
