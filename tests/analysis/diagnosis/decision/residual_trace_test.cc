#include "analysis/diagnosis/decision/residual_trace.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

class TraceTest : public testing::Test {
 protected:
  double MeanInSlides(const Signal& x) const {
    double sum = 0.0, count = 0.0;
    for (std::size_t k = 1000; k + 1000 < x.size(); ++k) {
      if (std::fabs(axis_.problem.signals->sign[k]) < 0.9) continue;
      sum += x[k];
      count += 1.0;
    }
    return sum / count;
  }

  // A torque of 0.3 Fc that the model does not have.
  test::FittedAxis axis_{{{"constant_torque", 0.3, 0.0, 0.0, 0.0}}};
  double torque_Nm_ = 0.3 * axis_.made.axis.stated.friction.Fc_plus;
  Fit with_ = axis_.With(axis_.Of("constant_torque"));
};

TEST_F(TraceTest, TheTorqueResidualIsWhatTheCommandHasTooMuch) {
  // What pushes without being commanded has to be put on the command: taken off, it is negative.
  EXPECT_NEAR(MeanInSlides(TorqueResidual(axis_.problem, axis_.made.point)), -torque_Nm_, 0.2 * torque_Nm_);
  EXPECT_NEAR(MeanInSlides(TorqueResidual(axis_.problem, with_.point)), 0.0, 0.1 * torque_Nm_);
}

TEST_F(TraceTest, RowsThatDoNotCountHaveNone) {
  Problem& problem = axis_.made.problem;
  problem.counted.assign(problem.rows(), 0);
  for (const double r : TorqueResidual(problem, axis_.made.point)) ASSERT_EQ(r, 0.0);
}

TEST_F(TraceTest, TracesAreMeasuredLessResidual) {
  const Traces t = MakeTraces(axis_.problem, axis_.base, with_);
  const std::size_t n = axis_.problem.rows();
  ASSERT_EQ(t.time_s.size(), n);
  EXPECT_NEAR(t.time_s[4321], 4.321, 1e-9);
  for (const std::size_t k : {10u, 2000u, 7000u}) {
    EXPECT_NEAR(t.simulated_before[k], t.measured[k] - t.residual_before[k], 1e-12);
    EXPECT_NEAR(t.simulated_after[k], t.measured[k] - t.residual_after[k], 1e-12);
    EXPECT_EQ(t.position[k], axis_.problem.signals->position[k]);
  }
  EXPECT_EQ(t.residual_after, TorqueResidual(axis_.problem, with_.point));
  EXPECT_TRUE(t.scale_before.empty() && t.temperature_degC.empty())
      << "there is neither scale nor thermometer";
}

}  // namespace
}  // namespace contour::diagnosis
