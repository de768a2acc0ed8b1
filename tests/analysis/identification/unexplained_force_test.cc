#include "analysis/identification/unexplained_force.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "analysis/identification/usable.h"
#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

using identify::TableAxis;
using identify::UnexplainedForce;

/// Strokes and reversals; the motor's torque has this noise, the encoder next to none.
UnexplainedForce Unexplained(const plant::AxisParameters& truth, double torque_noise_N,
                             const TableAxis& model) {
  GeneratedAxis axis{truth};
  axis.noise_lsb = 0.1;
  axis.torque_noise_N = torque_noise_N;
  const std::vector<double> speeds = {1e-3, 2e-3, 5e-3, 20e-3};
  const identify::Measured record = axis.Drive(
      2.0 * StrokesDuration_s(5e-3, speeds),
      [&](double t) {
        const double once = StrokesDuration_s(5e-3, speeds);
        return Strokes(5e-3, speeds)(t < once ? t : t - once);
      },
      [](double) { return 0.0; });
  return identify::FindUnexplainedForce(model, {record}, 1);
}

/// Whether a fit that leaves this would be written.
std::string Refused(const UnexplainedForce& left) {
  identify::Identification id;
  id.unexplained = left;
  id.fit.parameters = {{"motor_inertia_kgm2", 80.0, 0.01, true}};
  return identify::WhyUnusable(id);
}

TEST(UnexplainedForceTest, NoiseOfTheTorqueIsNoStructureHoweverQuietTheEncoder) {
  const plant::AxisParameters truth = PlainAxis();
  const UnexplainedForce quiet = Unexplained(truth, 0.0, Exactly(truth));
  const UnexplainedForce noisy = Unexplained(truth, 4.0, Exactly(truth));
  EXPECT_EQ(Refused(quiet), "");
  EXPECT_EQ(Refused(noisy), "") << noisy.structure_N << " N beside " << noisy.noise_N;
  EXPECT_GT(noisy.noise_N, 10.0 * quiet.noise_N);
  EXPECT_LT(noisy.structure_N, noisy.noise_N);
}

// About to break away, an axis answers a little force by much: blocks with creeping in them then have far
// larger errors than those of sliding.
TEST(UnexplainedForceTest, NoiseThatAnAxisAnswersUnevenlyIsNoStructureEither) {
  plant::AxisParameters truth = PlainAxis();
  const double friction_N = truth.friction.base.plus.Fc_N;
  for (const double of_friction : {0.1, 0.2}) {
    const UnexplainedForce left = Unexplained(truth, of_friction * friction_N, Exactly(truth));
    EXPECT_EQ(Refused(left), "") << left.structure_N << " N beside " << left.noise_N;
    EXPECT_LT(left.structure_N, 0.6 * left.noise_N) << of_friction;
  }
  TableAxis stiff = Exactly(truth);
  stiff.friction.s0 *= 6.0;
  EXPECT_NE(Refused(Unexplained(truth, 0.1 * friction_N, stiff)), "") << "beside such noise, too";
}

TEST(UnexplainedForceTest, CoggingThatTheModelHasNotIsStructure) {
  plant::AxisParameters truth = PlainAxis();
  truth.effects.cogging = CoggingEffect{};
  truth.effects.cogging->amplitude_Nm = 3e-3;
  truth.effects.cogging->order_per_rev = 12;
  truth.effects.cogging->phase_rad = 0.7;
  const double amplitude_N = 3e-3 / truth.radius_m_rad;
  for (const double noise_N : {0.0, 1.0}) {
    const UnexplainedForce left = Unexplained(truth, noise_N, Exactly(truth));
    EXPECT_NEAR(left.structure_N, amplitude_N / std::sqrt(2.0), 0.4 * amplitude_N) << noise_N;
    EXPECT_NE(Refused(left).find("goes with the motion"), std::string::npos) << noise_N;
    TableAxis knows = Exactly(truth);
    knows.cogging[0] = {12.0, amplitude_N * std::sin(0.7), amplitude_N * std::cos(0.7)};
    EXPECT_EQ(Refused(Unexplained(truth, noise_N, knows)), "") << noise_N;
  }
}

TEST(UnexplainedForceTest, ABristleThatIsWrongIsStructure) {
  const plant::AxisParameters truth = PlainAxis();
  TableAxis stiff = Exactly(truth);
  stiff.friction.s0 *= 6.0;
  const UnexplainedForce right = Unexplained(truth, 0.0, Exactly(truth)),
                         wrong = Unexplained(truth, 0.0, stiff);
  EXPECT_EQ(Refused(right), "");
  EXPECT_NE(Refused(wrong).find("goes with the motion"), std::string::npos);
  EXPECT_GT(wrong.structure_N, 3.0 * wrong.noise_N);
}

}  // namespace
}  // namespace contour::test
