#include "analysis/prediction_error/base_terms.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

const BaseTerm* Find(const std::vector<BaseTerm>& terms, const std::string& name) {
  const auto it = std::find_if(terms.begin(), terms.end(), [&](const BaseTerm& t) { return t.name == name; });
  return it == terms.end() ? nullptr : &*it;
}

StatedAxis Stated() {
  test::HiddenOptions o;
  o.duration_s = 1.0;
  return test::MakeHiddenAxis(o).stated;
}

TEST(BaseTerms, WhatIsStatedBeatsWhatADataSheetIsWorth) {
  StatedAxis stated = Stated();
  stated.sigma.erase("stiffness");
  stated.sigma["Fc"] = 0.033;
  EXPECT_EQ(StatedSigma(stated, "Fc"), 0.033);
  EXPECT_EQ(StatedSigma(stated, "stiffness"), 0.10);
  stated.sigma.erase("inertia");
  stated.sigma["motor_inertia"] = 0.021;
  EXPECT_EQ(StatedSigma(stated, "inertia"), 0.021);
}

TEST(BaseTerms, ANumberThatIsKnownForSureIsNoTerm) {
  StatedAxis stated = Stated();
  stated.sigma["s2"] = 0.0;
  EXPECT_EQ(Find(MakeBaseTerms(stated, ModelOf(stated)), "s2"), nullptr);
  stated.sigma["s2"] = 0.1;
  EXPECT_NE(Find(MakeBaseTerms(stated, ModelOf(stated)), "s2"), nullptr);
}

TEST(BaseTerms, AConstantForceIsOneWhereItIsStated) {
  StatedAxis stated = Stated();
  EXPECT_EQ(Find(MakeBaseTerms(stated, ModelOf(stated)), "offset"), nullptr);
  // As doubtful as friction, or as itself where it is larger; or as it is stated.
  const double level = 0.5 * (stated.friction.Fc_plus + stated.friction.Fc_minus);
  const auto sigma = [&] { return Find(MakeBaseTerms(stated, ModelOf(stated)), "offset")->sigma; };
  stated.offset = -0.1 * level;
  EXPECT_DOUBLE_EQ(sigma(), 0.1 * level);
  stated.offset = 20.0 * level;
  EXPECT_DOUBLE_EQ(sigma(), 2.0 * level);
  stated.offset = -0.1 * level;
  stated.sigma["offset"] = 0.5;
  EXPECT_DOUBLE_EQ(sigma(), 0.05 * level);
}

TEST(BaseTerms, WithoutAStribeckDropItsNumbersAreNone) {
  StatedAxis stated = Stated();
  stated.friction.Fs_plus = stated.friction.Fc_plus;
  stated.friction.Fs_minus = stated.friction.Fc_minus;
  const std::vector<BaseTerm> terms = MakeBaseTerms(stated, ModelOf(stated));
  EXPECT_EQ(Find(terms, "Fs"), nullptr);
  EXPECT_EQ(Find(terms, "vs"), nullptr);
}

// Before: up to a twentieth above Coulomb friction it had none, and what it was off by within its own
// uncertainty was a cause.
TEST(BaseTerms, AStribeckDropHasNumbersHoweverSmallItIs) {
  StatedAxis stated = Stated();
  stated.friction.Fs_plus = 1.01 * stated.friction.Fc_plus;
  stated.friction.Fs_minus = 1.01 * stated.friction.Fc_minus;
  const std::vector<BaseTerm> terms = MakeBaseTerms(stated, ModelOf(stated));
  EXPECT_NE(Find(terms, "Fs"), nullptr);
  EXPECT_NE(Find(terms, "vs"), nullptr);
}

TEST(BaseTerms, NuisancesComeLastAndARigidAxisExchangesLagForDelay) {
  StatedAxis stated = Stated();
  AxisModel nominal = ModelOf(stated);
  nominal.delay_s = 1e-3;
  nominal.two_inertia = false;
  std::vector<BaseTerm> terms = MakeBaseTerms(stated, nominal);
  ASSERT_NE(Find(terms, "lag_for_delay"), nullptr);
  EXPECT_EQ(terms.back().name, "start_bristle");
  EXPECT_TRUE(terms.back().nuisance);
  nominal.two_inertia = true;
  nominal.load_inertia = nominal.motor_inertia;
  nominal.stiffness = nominal.damping = 1.0;
  terms = MakeBaseTerms(stated, nominal);
  EXPECT_EQ(Find(terms, "lag_for_delay"), nullptr);
  EXPECT_NE(Find(terms, "stiffness"), nullptr);
}

}  // namespace
}  // namespace contour::diagnosis
