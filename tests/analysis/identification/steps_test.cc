// Each step of identification on records of an axis that other code has generated.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/identification/presliding_fit.h"
#include "analysis/identification/scale_wind_up.h"
#include "analysis/identification/shaken_screw.h"
#include "analysis/identification/sliding_fit.h"
#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

using identify::AxisModel;
using identify::Measured;

constexpr double kTwoPi = 2.0 * std::numbers::pi;
const std::vector<double> kSpeeds_m_s = {0.5e-3, 1e-3, 2e-3, 5e-3, 10e-3, 20e-3, 50e-3};

double Nothing(double) { return 0.0; }

/// 100 to 480 Hz every two seconds.
double Chirp_N(double t) {
  const double s = std::fmod(t, 2.0);
  return 60.0 * std::sin(kTwoPi * (100.0 * s + 0.5 * 190.0 * s * s));
}

Measured SlidingRecord() {
  static const Measured record = [] {
    GeneratedAxis axis{PlainAxis()};
    return axis.Drive(StrokesDuration_s(5e-3, kSpeeds_m_s), Strokes(5e-3, kSpeeds_m_s), Nothing);
  }();
  return record;
}

TEST(KinematicsTest, ForceIsMassTimesAccelerationForWhatIsHeld) {
  // A free mass under a held, delayed force, solved by hand: x_{k+1} = x_k + v_k T + a_k T^2 / 2.
  Measured d;
  d.period_s = 1e-3;
  double x = 0.0;
  double v = 0.0;
  constexpr double kMass = 40.0;
  for (int k = 0; k < 400; ++k) {
    d.force_N.push_back(30.0 * std::sin(0.3 * k) + 0.1 * k);
    d.position_m.push_back(x);
    d.present.push_back(k == 200 ? 0 : 1);
    const double a = k > 0 ? d.force_N[static_cast<std::size_t>(k) - 1] / kMass : 0.0;
    x += v * 1e-3 + 0.5 * a * 1e-6;
    v += a * 1e-3;
  }
  const auto instants = identify::Kinematics(d, 1e-3, 0.0, 3, 1);
  ASSERT_GT(instants.size(), 300U);
  for (const identify::Instant& i : instants) {
    if (i.row < 10) continue;
    EXPECT_NEAR(i.force_N, kMass * i.acceleration_m_s2, 1e-6);
    EXPECT_GT(std::abs(static_cast<int>(i.row) - 200), 3) << "a row next to the missing one was used";
  }
}

TEST(SlidingFitTest, FindsMassLevelsStribeckVelocityAndViscousFriction) {
  const AxisModel truth = Exactly(PlainAxis());
  const auto fit = identify::FitSliding(identify::Kinematics(SlidingRecord(), 1e-3, 0.2e-3, 4, 4), 1.0,
                                        truth.radius_m_rad);
  ASSERT_TRUE(fit.found) << fit.why_not;
  EXPECT_NEAR(fit.mass_kg / truth.mass_kg(), 1.0, 0.03);
  EXPECT_NEAR(fit.Fc_plus_N / truth.friction.Fc_plus_N, 1.0, 0.03);
  EXPECT_NEAR(fit.Fc_minus_N / truth.friction.Fc_minus_N, 1.0, 0.03);
  EXPECT_NEAR(fit.Fs_plus_N / truth.friction.Fs_plus_N, 1.0, 0.05);
  EXPECT_NEAR(fit.Fs_minus_N / truth.friction.Fs_minus_N, 1.0, 0.05);
  EXPECT_NEAR(fit.sigma2_Ns_m / truth.friction.sigma2_Ns_m, 1.0, 0.05);
  EXPECT_NEAR(fit.vs_m_s / truth.friction.vs_m_s, 1.0, 0.25);
}

TEST(SlidingFitTest, OneDirectionOnlyIsRefusedWithTheReason) {
  GeneratedAxis axis{PlainAxis()};
  const Measured record = axis.Drive(
      4.0, [](double t) { return 1e-3 * t * t; }, Nothing);
  const auto fit = identify::FitSliding(identify::Kinematics(record, 1e-3, 0.2e-3, 4, 4), 1.0, 8e-4);
  EXPECT_FALSE(fit.found);
  EXPECT_NE(fit.why_not.find("both directions"), std::string::npos) << fit.why_not;
}

TEST(StribeckPointsTest, LieOnTheCurveOfTheAxis) {
  const AxisModel truth = Exactly(PlainAxis());
  const auto points =
      identify::StribeckPoints(identify::Kinematics(SlidingRecord(), 1e-3, 0.2e-3, 4, 4), truth);
  ASSERT_GE(points.size(), 10U);
  for (const identify::StribeckPoint& p : points) {
    const bool up = p.velocity_m_s > 0.0;
    const double fc = up ? truth.friction.Fc_plus_N : truth.friction.Fc_minus_N;
    const double fs = up ? truth.friction.Fs_plus_N : truth.friction.Fs_minus_N;
    const double speed = std::fabs(p.velocity_m_s);
    const double expected = fc + (fs - fc) * std::exp(-speed / 2e-3) + 500.0 * speed;
    EXPECT_NEAR(std::fabs(p.friction_N), expected, 0.02 * expected) << "at " << p.velocity_m_s;
  }
}

TEST(PreslidingFitTest, FindsTheBristleFromAStartThatIsFarOff) {
  AxisModel axis = Exactly(PlainAxis());
  GeneratedAxis generated{PlainAxis()};
  const auto loops = [](double t) {
    const double amplitude = t < 3.0 ? 5e-6 : t < 6.0 ? 15e-6 : 60e-6;
    return amplitude * std::sin(kTwoPi * t);
  };
  const Measured record = generated.Drive(9.0, loops, Nothing);
  const auto instants = identify::Kinematics(record, axis.delay_s, axis.lag_s, 4, 1);
  for (const double wrong : {0.5, 1.5}) {
    axis.friction.sigma0_N_m = 5e6 * wrong;
    identify::PreslidingFit fit;
    for (int pass = 0; pass < 4; ++pass) {
      fit = identify::FitPresliding(instants, axis);
      ASSERT_TRUE(fit.found);
      axis.friction.sigma0_N_m = fit.sigma0_N_m;
    }
    EXPECT_NEAR(fit.sigma0_N_m / 5e6, 1.0, 0.25) << "started at " << wrong;
  }
}

/// Slid at 5 mm/s, forth and back, under the chirp.
Measured ShakenRecord(const plant::AxisParameters& truth) {
  const GeneratedAxis axis{truth};
  return axis.Drive(
      4.0, [](double time) { return 5e-3 * (time < 2.0 ? time : 4.0 - time); }, Chirp_N);
}

/// A start that is wrong as after the first steps: split, stiffness and damping of the screw, the bristle.
AxisModel RoughStart(const plant::AxisParameters& truth) {
  AxisModel a = Exactly(truth);
  const double mass = a.mass_kg();
  a.table_mass_kg *= 1.3;
  a.motor_mass_kg = mass - a.table_mass_kg;
  a.stiffness_N_m = 20e6;
  a.damping_Ns_m = 3000;
  a.friction.sigma0_N_m *= 0.5;
  a.friction.Fc_plus_N *= 1.02;
  a.variation.high_m = 15e-3;
  return a;
}

TEST(ShakenScrewTest, FindsScrewsWhereverTheirResonanceIs) {
  for (const double stiffness_N_um : {12.0, 80.0}) {
    plant::AxisParameters screw = PlainAxis();
    screw.stiffness_N_m = stiffness_N_um * 1e6;
    const auto found = identify::FitShakenScrew(RoughStart(screw), {ShakenRecord(screw)});
    ASSERT_EQ(found.verdict, identify::ShakenScrew::Verdict::kFound) << stiffness_N_um;
    EXPECT_NEAR(found.axis.stiffness_N_m / screw.stiffness_N_m, 1.0, 0.03) << stiffness_N_um;
    EXPECT_NEAR(found.axis.table_mass_kg / screw.table_mass_kg, 1.0, 0.03) << stiffness_N_um;
    EXPECT_NEAR(found.antiresonance_Hz, std::sqrt(screw.stiffness_N_m / screw.table_mass_kg) / kTwoPi, 3.0);
  }
}

TEST(ShakenScrewTest, AStiffScrewIsRigidAndNotInvented) {
  plant::AxisParameters stiff = PlainAxis();
  stiff.stiffness_N_m = 400e6;  // resonance at 1070 Hz
  const auto found = identify::FitShakenScrew(RoughStart(stiff), {ShakenRecord(stiff)});
  EXPECT_EQ(found.verdict, identify::ShakenScrew::Verdict::kRigid) << found.resonance_Hz;
  EXPECT_TRUE(found.axis.rigid);
  EXPECT_NEAR(found.axis.mass_kg() / Exactly(stiff).mass_kg(), 1.0, 0.05);
}

TEST(ShakenScrewTest, WithoutAChirpThereIsNothingToSee) {
  const auto found = identify::FitShakenScrew(Exactly(PlainAxis()), {SlidingRecord()});
  EXPECT_EQ(found.verdict, identify::ShakenScrew::Verdict::kNotSeen);
  EXPECT_NE(found.why_not.find("chirp"), std::string::npos) << found.why_not;
}

TEST(WindUpTest, FindsTheScrewWithALinearScale) {
  const AxisModel truth = Exactly(PlainAxis());
  GeneratedAxis axis{PlainAxis(), true};
  const Measured record =
      axis.Drive(StrokesDuration_s(5e-3, {2e-3, 10e-3, 50e-3}), Strokes(5e-3, {2e-3, 10e-3, 50e-3}), Nothing);
  const auto wind_up = identify::FitWindUp({record}, truth);
  ASSERT_TRUE(wind_up.found);
  EXPECT_NEAR(wind_up.stiffness_N_m / truth.stiffness_N_m, 1.0, 0.02);
  EXPECT_LT(std::fabs(wind_up.stiffness_N_m / truth.stiffness_N_m - 1.0), 4.0 * wind_up.sigma_rel + 0.005);
}

}  // namespace
}  // namespace contour::test
