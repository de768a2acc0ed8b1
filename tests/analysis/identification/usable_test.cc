#include "analysis/identification/usable.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace contour::test {
namespace {

using identify::Identification;
using identify::ResponsePoint;
using identify::ShakenScrew;
using identify::WhyNoBeginning;
using identify::WhyNoScrew;
using identify::WhyUnusable;

Identification Good() {
  Identification id;
  id.fit.parameters = {{"motor_inertia_kgm2", 80.0, 0.01, true}, {"offset_N", 0.0, 0.1, false}};
  id.fit.unsettled = 0.5;
  id.unexplained = {0.1, 0.2, 32.0};
  id.shaken.verdict = ShakenScrew::Verdict::kFound;
  return id;
}

bool Says(const Identification& id, const char* what) {
  return WhyUnusable(id).find(what) != std::string::npos;
}

/// 1 / 90 kg but for an antiresonance and a resonance of this depth.
std::vector<ResponsePoint> Response(double depth) {
  std::vector<ResponsePoint> response;
  for (double f = 100.0; f < 480.0; f += 2.0) {
    const double at = (f - 320.0) / 12.0;
    const double dip = 1.0 - depth * std::exp(-at * at);
    const double up = 1.0 + depth * std::exp(-(at - 2.0) * (at - 2.0));
    response.push_back({f, dip * up / 90.0, 0.95});
  }
  return response;
}

TEST(WhyUnusable, SaysNothingOfAGoodResult) { EXPECT_EQ(WhyUnusable(Good()), ""); }

TEST(WhyUnusable, RefusesWhatIsNoNumber) {
  for (const double value : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Identification id = Good();
    id.fit.parameters[0].sigma = value;
    EXPECT_TRUE(Says(id, "no number"));
    id = Good();
    id.fit.parameters[1].value = value;
    EXPECT_TRUE(Says(id, "no number"));
  }
}

// Friction and the whole mass may be used all the same.
TEST(WhyNoScrew, TellsAScrewThatDidNotShowFromOneThatIsNone) {
  Identification id = Good();
  for (const auto verdict : {ShakenScrew::Verdict::kFound, ShakenScrew::Verdict::kRigid}) {
    id.shaken.verdict = verdict;
    EXPECT_EQ(WhyNoScrew(id, true), "");
  }
  id.shaken.verdict = ShakenScrew::Verdict::kNotSeen;
  EXPECT_NE(WhyNoScrew(id, true).find("nothing of its screw showed"), std::string::npos);
  EXPECT_NE(WhyNoScrew(id, true).find("the screw's stiffness, and"), std::string::npos);
  id.shaken.why_not = "it stood still";
  EXPECT_NE(WhyNoScrew(id, false).find("nothing of the screw showed: it stood still; the screw's"),
            std::string::npos);
  EXPECT_EQ(WhyUnusable(id), "");
  // A linear scale shows how the screw winds up, not where the mass is.
  id.wind_up.found = true;
  EXPECT_EQ(WhyNoScrew(id, true).find("the screw's stiffness, and"), std::string::npos);
  EXPECT_NE(WhyNoScrew(id, true).find("how much of the mass"), std::string::npos);
}

TEST(WhyNoBeginning, TakesWhatIsUnsureButNotWhatIsNoModel) {
  Identification id = Good();
  EXPECT_EQ(WhyNoBeginning(id), "");
  id.fit.parameters.push_back({"screw_stiffness_N_um", 100.0, 0.3, true});
  id.unexplained.structure_N = 0.2 * id.unexplained.friction_N;
  EXPECT_NE(WhyUnusable(id), "");
  EXPECT_EQ(WhyNoBeginning(id), "") << "unsure, and not all that the axis has";
  id.fit.unsettled = 10.0;
  EXPECT_NE(WhyNoBeginning(id), "");
  for (const auto verdict : {ShakenScrew::Verdict::kRigid, ShakenScrew::Verdict::kNotSeen}) {
    id = Good();
    id.shaken.verdict = verdict;
    EXPECT_NE(WhyNoBeginning(id), "");
  }
  id = Good();
  id.fit.parameters[0].sigma = std::nan("");
  EXPECT_NE(WhyNoBeginning(id), "");
}

TEST(WhyUnusable, RefusesIntervalsOfNoWidth) {
  Identification id = Good();
  id.fit.parameters[0].sigma = 0.0;
  EXPECT_TRUE(Says(id, "no width"));
}

TEST(WhyUnusable, RefusesARecordWithHoles) {
  Identification id = Good();
  id.missing_share = 0.126;
  EXPECT_TRUE(Says(id, "12.6 % of the cycles are missing"));
  id.missing_share = 0.001;
  EXPECT_EQ(WhyUnusable(id), "");
}

TEST(WhyUnusable, RefusesAForceThatGoesWithTheMotionAndNotNoise) {
  Identification id = Good();
  id.unexplained = {1.5, 2.2, 32.0};
  EXPECT_TRUE(Says(id, "a force of 2.2 N unexplained that goes with the motion, 7 % of friction"));
  // A torque that is as noisy explains errors of that size.
  id.unexplained.noise_N = 2.4;
  EXPECT_EQ(WhyUnusable(id), "");
  // Little of friction, however quiet all the rest is.
  id.unexplained = {0.01, 0.5, 32.0};
  EXPECT_EQ(WhyUnusable(id), "");
}

TEST(WhyUnusable, RefusesAScrewThatIsHardlyKnown) {
  Identification id = Good();
  id.fit.parameters.push_back({"screw_stiffness_N_um", 40e6, 0.1, true});
  EXPECT_EQ(WhyUnusable(id), "");
  id.fit.parameters.back().sigma = 0.18;
  EXPECT_TRUE(Says(id, "a standard deviation of 18 %"));
}

// With a tenth of a turn's counts that fits usually see, intervals came out a tenth as wide as they should
// be.
TEST(WhyUnusable, RefusesAScrewThatIsShakenByLessThanTheEncoderShows) {
  Identification id = Good();
  id.encoder.step_m = 0.5e-6;
  id.shaken.antiresonance_Hz = 288.0;
  id.shaken.moves_m = 0.2e-6;
  EXPECT_TRUE(Says(id, "moves by 0.20 um, of which steps of its encoder of 0.50 um show too little"));
  EXPECT_EQ(WhyNoBeginning(id), "") << "a catalogue knows less";
  id.shaken.moves_m = 2.05e-6;
  EXPECT_EQ(WhyUnusable(id), "");
}

TEST(WhyUnusable, RefusesMassesThatACatalogueKnowsBetter) {
  Identification id = Good();
  id.fit.parameters[0].sigma = 0.27;
  EXPECT_EQ(WhyUnusable(id), "");
  id.fit.parameters[0].sigma = 0.47;
  EXPECT_TRUE(Says(id, "motor_inertia_kgm2 came out with a standard deviation of 47 %"));
}

TEST(WhyUnusable, RefusesAFitThatDidNotSettle) {
  Identification id = Good();
  id.fit.unsettled = 12.0;
  EXPECT_TRUE(Says(id, "did not settle"));
}

TEST(WhyUnusable, RefusesToCallAnAxisRigidThatShowsAnAntiresonance) {
  Identification id = Good();
  id.shaken.verdict = ShakenScrew::Verdict::kRigid;
  id.shaken.response = Response(0.1);
  EXPECT_EQ(WhyUnusable(id), "");
  id.shaken.response = Response(0.7);
  EXPECT_TRUE(Says(id, "antiresonance near 3")) << WhyUnusable(id);
  // What nothing shook says nothing.
  for (ResponsePoint& p : id.shaken.response) p.coherence = 0.3;
  EXPECT_EQ(WhyUnusable(id), "");
}

}  // namespace
}  // namespace contour::test
