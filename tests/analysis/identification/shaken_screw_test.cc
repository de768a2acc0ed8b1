#include "analysis/identification/shaken_screw.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "analysis/identification/follow_gain.h"
#include "analysis/identification/simulation.h"
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

/// The whole of a record's or of its stretches' errors.
double Rms_m(const TableAxis& axis, const std::vector<Measured>& records) {
  const auto errors =
      identify::PredictionErrors_m({{axis, identify::FollowGainFor(axis, records.front())}}, records, 1);
  return errors.norm() / std::sqrt(static_cast<double>(errors.size()));
}

// Strokes of half a second, each shaken from its beginning on: the part swings all the time, and left alone
// it rings for 0.13 s.
TEST(ShakenScrewTest, AStretchBeginsWithThePartAsItSwings) {
  constexpr double kSide_Hz = 60.0;
  plant::AxisParameters truth = PlainAxis();
  const double omega = kTwoPi * kSide_Hz, side_kg = 0.12 * truth.table_mass_kg;
  truth.side_modes = {{side_kg, side_kg * omega * omega, 0.04 * side_kg * omega}};
  TableAxis model = Exactly(truth);
  model.side = {0.12, kSide_Hz, 0.02};
  const GeneratedAxis axis{truth};
  const Measured record = axis.Drive(
      8.0, [](double t) { return 5e-3 * std::fabs(std::remainder(t, 1.2)); },
      [](double t) {
        const double s = std::fmod(t, 2.0);
        return 60.0 * std::sin(kTwoPi * (40.0 + 100.0 * s) * s);
      });
  const std::vector<Measured> stretches = identify::ShakenStretches({record}, model);
  ASSERT_GE(stretches.size(), 10U);
  const double whole_m = Rms_m(model, {record});
  EXPECT_LT(Rms_m(model, stretches), 1.5 * whole_m);
  // What that is worth.
  std::vector<Measured> without = stretches;
  for (Measured& s : without) {
    const auto rows = static_cast<std::ptrdiff_t>(std::exchange(s.run_up, 0));
    s.force_N.erase(s.force_N.begin(), s.force_N.begin() + rows);
    s.position_m.erase(s.position_m.begin(), s.position_m.begin() + rows);
    s.present.erase(s.present.begin(), s.present.begin() + rows);
  }
  EXPECT_GT(Rms_m(model, without), 4.0 * whole_m);
}

TEST(ShakenScrewTest, ARunUpEndsWhereARowIsMissing) {
  const plant::AxisParameters truth = PlainAxis();
  Measured record = ShakenRecord(truth);
  const TableAxis model = Exactly(truth);
  const auto whole = identify::ShakenStretches({record}, model);
  ASSERT_GE(whole.size(), 2U);
  ASSERT_GT(whole[1].run_up, 300U);
  // The second begins 0.2 s behind the turn at 2 s.
  record.present[2050] = 0;
  const auto cut = identify::ShakenStretches({record}, model);
  ASSERT_EQ(cut.size(), whole.size());
  EXPECT_EQ(cut[1].compared(), whole[1].compared());
  EXPECT_LT(cut[1].run_up, 200U);
  for (const auto present : cut[1].present) EXPECT_EQ(present, 1);
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
  EXPECT_NEAR(static_cast<double>(segments.front().compared()), 2000.0, 200.0);
  EXPECT_GT(segments.front().position_m[segments.front().run_up], 9e-3);
}

TEST(ShakenScrewTest, WithoutAChirpThereIsNothingToSee) {
  const auto found = identify::FitShakenScrew(Exactly(PlainAxis()), {SlidingRecord()});
  EXPECT_EQ(found.verdict, identify::ShakenScrew::Verdict::kNotSeen);
  EXPECT_NE(found.why_not.find("chirp"), std::string::npos) << found.why_not;
}

}  // namespace
}  // namespace contour::test
