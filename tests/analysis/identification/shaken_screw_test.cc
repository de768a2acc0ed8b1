#include "analysis/identification/shaken_screw.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

using identify::Measured;
using identify::TableAxis;

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// 100 to 480 Hz every two seconds.
double Chirp_N(double t) {
  const double s = std::fmod(t, 2.0);
  return 60.0 * std::sin(kTwoPi * (100.0 * s + 0.5 * 190.0 * s * s));
}

/// Slid at 5 mm/s, forth and back, under the chirp.
Measured ShakenRecord(const plant::AxisParameters& truth) {
  const GeneratedAxis axis{truth};
  return axis.Drive(
      4.0, [](double time) { return 5e-3 * (time < 2.0 ? time : 4.0 - time); }, Chirp_N);
}

/// A start that is wrong as after the first steps: split, stiffness and damping of the screw, the bristle.
TableAxis RoughStart(const plant::AxisParameters& truth) {
  TableAxis a = Exactly(truth);
  const double mass = a.mass_kg();
  a.load_inertia *= 1.3;
  a.motor_inertia = mass - a.load_inertia;
  a.stiffness = 20e6;
  a.damping = 3000;
  a.friction.s0 *= 0.5;
  a.friction.Fc_plus *= 1.02;
  a.variation.high_m = 15e-3;
  return a;
}

TEST(ShakenScrewTest, FindsScrewsWhereverTheirResonanceIs) {
  for (const double stiffness_N_um : {12.0, 80.0}) {
    plant::AxisParameters screw = PlainAxis();
    screw.stiffness_N_m = stiffness_N_um * 1e6;
    const auto found = identify::FitShakenScrew(RoughStart(screw), {ShakenRecord(screw)});
    ASSERT_EQ(found.verdict, identify::ShakenScrew::Verdict::kFound) << stiffness_N_um;
    EXPECT_NEAR(found.axis.stiffness / screw.stiffness_N_m, 1.0, 0.03) << stiffness_N_um;
    EXPECT_NEAR(found.axis.load_inertia / screw.table_mass_kg, 1.0, 0.03) << stiffness_N_um;
    EXPECT_NEAR(found.antiresonance_Hz, std::sqrt(screw.stiffness_N_m / screw.table_mass_kg) / kTwoPi, 3.0);
  }
}

TEST(ShakenScrewTest, APartThatSwingsIsNotTakenForTheScrew) {
  // The part swings at 0.55 of the mode.
  for (const auto& [table_kg, side_Hz] : {std::pair{10.0, 186.0}}) {
    plant::AxisParameters truth = PlainAxis();
    truth.table_mass_kg = table_kg;
    const double omega = kTwoPi * side_Hz, side_kg = 0.12 * table_kg;
    truth.side_modes = {{side_kg, side_kg * omega * omega, 0.04 * side_kg * omega}};
    const auto found = identify::FitShakenScrew(RoughStart(truth), {ShakenRecord(truth)});
    ASSERT_EQ(found.verdict, identify::ShakenScrew::Verdict::kFound) << table_kg;
    EXPECT_NEAR(found.axis.side.share, 0.12, 0.03) << table_kg;
    EXPECT_NEAR(found.axis.side.frequency_Hz, side_Hz, 4.0) << table_kg;
    EXPECT_NEAR(found.axis.load_inertia / truth.table_mass_kg, 1.0, 0.08) << table_kg;
    EXPECT_NEAR(found.axis.stiffness / truth.stiffness_N_m, 1.0, 0.05) << table_kg;
  }
  EXPECT_EQ(identify::FitShakenScrew(RoughStart(PlainAxis()), {ShakenRecord(PlainAxis())}).axis.side.share,
            0.0);
}

TEST(ShakenScrewTest, AStiffScrewIsRigidAndNotInvented) {
  plant::AxisParameters stiff = PlainAxis();
  stiff.stiffness_N_m = 400e6;  // resonance at 1070 Hz
  const auto found = identify::FitShakenScrew(RoughStart(stiff), {ShakenRecord(stiff)});
  EXPECT_EQ(found.verdict, identify::ShakenScrew::Verdict::kRigid) << found.resonance_Hz;
  EXPECT_FALSE(found.axis.two_inertia);
  EXPECT_NEAR(found.axis.mass_kg() / Exactly(stiff).mass_kg(), 1.0, 0.05);
}

// What its loop makes of the encoder's noise is quick, too, and there in every stroke.
TEST(ShakenScrewTest, WhereADriveLeadsItsOwnNoiseShakesNothing) {
  Measured data;
  data.period_s = 1e-3;
  for (int k = 0; k < 4000; ++k) {
    const double t = 1e-3 * k;
    const double offset_N = k >= 2000 ? Chirp_N(t) : 0.0;
    const double noise_N = k % 2 == 0 ? 30.0 : -30.0;
    data.offset_N.push_back(offset_N);
    data.reported_N.push_back(40.0 + offset_N + noise_N);
    data.force_N.push_back(40.0 + offset_N + noise_N);
    data.position_m.push_back(5e-3 * t);
    data.present.push_back(1);
  }
  const auto segments = identify::ShakenStretches({data}, Exactly(PlainAxis()));
  ASSERT_EQ(segments.size(), 1U);
  EXPECT_NEAR(static_cast<double>(segments.front().size()), 2000.0, 200.0);
  EXPECT_GT(segments.front().position_m.front(), 9e-3);
}

TEST(ShakenScrewTest, WithoutAChirpThereIsNothingToSee) {
  const auto found = identify::FitShakenScrew(Exactly(PlainAxis()), {SlidingRecord()});
  EXPECT_EQ(found.verdict, identify::ShakenScrew::Verdict::kNotSeen);
  EXPECT_NE(found.why_not.find("chirp"), std::string::npos) << found.why_not;
}

}  // namespace
}  // namespace contour::test
