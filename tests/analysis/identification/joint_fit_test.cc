#include "analysis/identification/joint_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "analysis/identification/whitening.h"
#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

using identify::AxisModel;
using identify::Measured;

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Half a minute of everything: strokes, loops, shaking at rest, a chirp while sliding.
Measured Everything() {
  static const Measured record = [] {
    const std::vector<double> speeds = {1e-3, 3e-3, 10e-3, 50e-3};
    const double strokes_s = StrokesDuration_s(5e-3, speeds);
    const auto strokes = Strokes(5e-3, speeds);
    GeneratedAxis axis{PlainAxis()};
    return axis.Drive(
        strokes_s + 14.0,
        [=](double t) {
          if (t < strokes_s) return strokes(t);
          const double s = t - strokes_s;
          if (s < 6.0) return (s < 2.0 ? 4e-6 : s < 4.0 ? 15e-6 : 0.2e-3) * std::sin(kTwoPi * s);
          return s < 9.0 ? 0.0 : 5e-3 * (s - 9.0);
        },
        [=](double t) {
          const double s = t - strokes_s;
          if (s < 6.0) return 0.0;
          if (s < 9.0) return 8.0 * std::sin(kTwoPi * (10.0 * (s - 6.0) + 15.0 * (s - 6.0) * (s - 6.0)));
          const double c = std::fmod(s - 9.0, 2.5);
          return 60.0 * std::sin(kTwoPi * (100.0 * c + 76.0 * c * c));
        });
  }();
  return record;
}

double Rms_m(const std::vector<double>& errors) {
  double sum = 0.0;
  for (const double e : errors) sum += e * e;
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

TEST(SimulationTest, TheTrueModelForeseesAnIndependentAxisToItsNoise) {
  // A reading's noise: quantisation and 0.3 counts, 1.9 nm. The prediction adds its own.
  const AxisModel truth = Exactly(PlainAxis());
  const auto gain = identify::MakeFollowGain(truth, 1e-3, 60.0);
  const double rms = Rms_m(identify::PredictionErrors_m(truth, Everything(), gain));
  EXPECT_LT(rms, 4.5e-9);
  EXPECT_GT(rms, 1.5e-9);
}

TEST(SimulationTest, EveryPartOfTheModelMatters) {
  const AxisModel truth = Exactly(PlainAxis());
  const auto gain = identify::MakeFollowGain(truth, 1e-3, 60.0);
  const double best = Rms_m(identify::PredictionErrors_m(truth, Everything(), gain));
  const std::vector<std::function<void(AxisModel&)>> wrongs = {
      [](AxisModel& a) { a.motor_mass_kg *= 1.05; },
      [](AxisModel& a) { a.table_mass_kg *= 1.2; },
      [](AxisModel& a) { a.stiffness_N_m *= 1.1; },
      [](AxisModel& a) { a.friction.Fc_plus_N *= 1.05; },
      [](AxisModel& a) { a.friction.Fs_minus_N *= 1.05; },
      [](AxisModel& a) { a.friction.vs_m_s *= 1.3; },
      [](AxisModel& a) { a.friction.sigma0_N_m *= 1.1; },
      [](AxisModel& a) { a.friction.sigma1_Ns_m *= 1.5; },
      [](AxisModel& a) { a.friction.sigma2_Ns_m *= 1.1; },
      [](AxisModel& a) { a.delay_s += 0.1e-3; },
      [](AxisModel& a) { a.offset_N += 1.0; },
  };
  for (std::size_t i = 0; i < wrongs.size(); ++i) {
    AxisModel wrong = truth;
    wrongs[i](wrong);
    EXPECT_GT(Rms_m(identify::PredictionErrors_m(wrong, Everything(), gain)), 1.1 * best) << "number " << i;
  }
}

TEST(SimulationTest, MissingRowsLeaveAGapAndNothingElse) {
  Measured record = Everything();
  for (std::size_t k = 5000; k < 5040; ++k) {
    record.present[k] = 0;
    record.position_m[k] = std::nan("");
  }
  const AxisModel truth = Exactly(PlainAxis());
  const auto errors =
      identify::PredictionErrors_m(truth, record, identify::MakeFollowGain(truth, 1e-3, 60.0));
  for (std::size_t k = 5000; k < 5040; ++k) EXPECT_EQ(errors[k], 0.0);
  EXPECT_LT(Rms_m(errors), 6e-9);
}

TEST(JointFitTest, FindsEveryParameterFromAModelThatIsHalfWrong) {
  const AxisModel truth = Exactly(PlainAxis());
  AxisModel start = truth;
  start.motor_mass_kg *= 1.2;
  start.table_mass_kg *= 1.3;
  start.stiffness_N_m *= 0.85;
  start.friction.Fc_plus_N *= 0.7;
  start.friction.Fc_minus_N *= 1.4;
  start.friction.Fs_plus_N *= 0.9;
  start.friction.Fs_minus_N *= 1.4;
  start.friction.vs_m_s *= 1.5;
  start.friction.sigma0_N_m *= 0.6;
  start.friction.sigma1_Ns_m *= 0.5;
  start.friction.sigma2_Ns_m *= 1.3;
  start.lag_s = 0.3e-3;
  start.variation.low_m = 0.0;
  start.variation.high_m = 25e-3;
  const auto fit = identify::FitJointly(start, {Everything()}, {});
  const AxisModel& a = fit.axis;
  EXPECT_NEAR(a.mass_kg() / truth.mass_kg(), 1.0, 0.005);
  EXPECT_NEAR(a.table_mass_kg / truth.table_mass_kg, 1.0, 0.03);
  EXPECT_NEAR(a.stiffness_N_m / truth.stiffness_N_m, 1.0, 0.03);
  EXPECT_NEAR(a.friction.Fc_plus_N / truth.friction.Fc_plus_N, 1.0, 0.01);
  EXPECT_NEAR(a.friction.Fc_minus_N / truth.friction.Fc_minus_N, 1.0, 0.01);
  EXPECT_NEAR(a.friction.Fs_plus_N / truth.friction.Fs_plus_N, 1.0, 0.01);
  EXPECT_NEAR(a.friction.Fs_minus_N / truth.friction.Fs_minus_N, 1.0, 0.01);
  EXPECT_NEAR(a.friction.vs_m_s / truth.friction.vs_m_s, 1.0, 0.05);
  EXPECT_NEAR(a.friction.sigma0_N_m / truth.friction.sigma0_N_m, 1.0, 0.02);
  EXPECT_NEAR(a.friction.sigma1_Ns_m / truth.friction.sigma1_Ns_m, 1.0, 0.1);
  EXPECT_NEAR(a.friction.sigma2_Ns_m / truth.friction.sigma2_Ns_m, 1.0, 0.02);
  EXPECT_NEAR(a.delay_s + a.lag_s, truth.delay_s + truth.lag_s, 10e-6);
  for (const auto& p : fit.parameters) EXPECT_GT(p.sigma, 0.0) << p.key;
}

TEST(WhiteningTest, TakesOutLevelAndCorrelation) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Eigen::VectorXd errors(40000);
  double last = 0.0;
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    last = 0.9 * last + normal(random);
    errors(i) = last * (i < 20000 ? 1e-9 : 5e-9);
  }
  identify::Whitening whitening;
  whitening.Learn(errors, 1000, 6, 1e-12);
  const Eigen::VectorXd white = whitening.Apply(errors);
  const double power = white.squaredNorm() / static_cast<double>(white.size());
  EXPECT_NEAR(power, 1.0, 0.05);
  const double next = white.head(39999).dot(white.tail(39999)) / white.squaredNorm();
  EXPECT_LT(std::fabs(next), 0.03);
  const double ratio = white.head(20000).squaredNorm() / white.tail(20000).squaredNorm();
  EXPECT_NEAR(ratio, 1.0, 0.1);
}

}  // namespace
}  // namespace contour::test
