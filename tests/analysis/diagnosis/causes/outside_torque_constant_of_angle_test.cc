#include <gtest/gtest.h>

#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/waves.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "outside:torque constant of angle";

TEST(TorqueConstantOfAngle, IsAWaveInProportionToTheTorque) {
  const test::KnownAxis axis;
  const SharedEffect e = WaveEffect(axis.problem, Wave::kGainOfAngle, 6.0, 144.0);
  EXPECT_EQ(e->kind, kKind);
  const AxisModel m = test::With(axis, e, {0.02, 0.0});
  const Signal& torque_Nm = axis.signals().model_torque;
  for (const std::size_t row : {40u, 700u, 1200u}) {
    const double mean_Nm = 0.5 * (torque_Nm[row] + torque_Nm[row + 1]);
    EXPECT_NEAR(test::MeanOverRow(m.motor_force, row), mean_Nm * test::MeanOfWave(axis, row, 0.02, 6.0, 0.0),
                1e-8);
  }
  EXPECT_EQ(test::Told(axis, e, {0.02, 0.0}).at("amplitude"), 0.02);
}

TEST(TorqueConstantOfAngle, WithoutTorqueIsNothing) {
  test::KnownAxis axis;
  axis.problem.signals->model_torque.assign(test::KnownAxis::kRows, 0.0);
  const AxisModel m =
      test::With(axis, WaveEffect(axis.problem, Wave::kGainOfAngle, 6.0, 144.0), {0.02, 0.01});
  for (const double v : *m.motor_force) ASSERT_EQ(v, 0.0);
}

TEST(TorqueConstantOfAngle, IsNoCauseOfTheCatalogue) {
  EXPECT_EQ(*CauseNamed(kKind).experiment, nullptr);
  EXPECT_EQ(*CauseNamed(kKind).extension, nullptr);
}

}  // namespace
}  // namespace contour::diagnosis
