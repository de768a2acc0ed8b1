#include "analysis/diagnosis/rounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

/// Rounds over a few of the catalogue, so that they are quick; waves are scanned for as ever.
struct Rounds {
  Rounds(std::vector<test::HiddenEffect> effects, const std::vector<std::string>& kinds, int most)
      : axis(Options(std::move(effects))) {
    nominal.fit = axis.base;
    for (const SharedEffect& e : CatalogueEffects(axis.problem))
      if (std::find(kinds.begin(), kinds.end(), e->kind) != kinds.end()) nominal.catalogue.push_back(e);
    DiagnoseOptions options;
    options.most_effects = most;
    result = AcceptInRounds(axis.made.problem, nominal, options, out);
  }

  static test::HiddenOptions Options(std::vector<test::HiddenEffect> effects) {
    test::HiddenOptions o = test::FittedAxis::Short(std::move(effects));
    o.duration_s = 14.0;
    return o;
  }

  std::vector<std::string> Kinds() const {
    std::vector<std::string> kinds;
    for (const Cause& c : out.causes) kinds.push_back(c.kind);
    return kinds;
  }

  test::FittedAxis axis;
  Nominal nominal;
  Diagnosis out;
  RoundsResult result;
};

const std::vector<std::string> kFew = {"constant_torque", "cable_spring", "friction_drift"};

TEST(AcceptInRounds, TakesOneCauseAfterTheOtherTheLargestFirst) {
  const Rounds r({{"constant_torque", 0.3, 0.0, 0.0, 0.0}, {"cable_spring", 0.6, 0.0, 0.0, 0.0}}, kFew, 3);
  ASSERT_EQ(r.out.causes.size(), 2u);
  EXPECT_TRUE(std::is_permutation(kFew.begin(), kFew.begin() + 2, r.Kinds().begin()));
  EXPECT_GT(r.out.causes[0].log_evidence_gain, 0.0);
  ASSERT_EQ(r.result.accepted.places.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(r.result.accepted.fit.point.effects[r.result.accepted.places[i]]->kind, r.Kinds()[i]);
  EXPECT_FALSE(r.result.stopped);
  for (const Candidate& c : r.out.candidates) {
    const bool named = std::find(kFew.begin(), kFew.begin() + 2, c.kind) != kFew.begin() + 2;
    if (c.accepted) {
      EXPECT_TRUE(named) << c.kind;
    }
  }
}

TEST(AcceptInRounds, StopsAtAsManyAsWereAskedFor) {
  const Rounds r({{"constant_torque", 0.3, 0.0, 0.0, 0.0}, {"cable_spring", 0.6, 0.0, 0.0, 0.0}}, kFew, 1);
  EXPECT_EQ(r.out.causes.size(), 1u);
  EXPECT_TRUE(r.result.stopped);
}

TEST(AcceptInRounds, TakesNothingFromAnAxisThatIsAsStated) {
  const Rounds r({}, kFew, 3);
  EXPECT_TRUE(r.out.causes.empty());
  EXPECT_TRUE(r.result.accepted.places.empty());
  EXPECT_FALSE(r.result.stopped);
  EXPECT_GT(r.out.threshold, 0.0);
  // Every candidate was looked at, jitter among them, and what could have been found is said.
  for (const std::string& kind : kFew)
    EXPECT_TRUE(std::any_of(r.out.candidates.begin(), r.out.candidates.end(), [&](const Candidate& c) {
      return c.kind == kind && !c.accepted;
    })) << kind;
  EXPECT_TRUE(std::any_of(r.out.candidates.begin(), r.out.candidates.end(),
                          [](const Candidate& c) { return c.kind == *CauseInScatter().name; }));
  EXPECT_TRUE(r.out.smallest_detectable.contains("constant_torque"));
  EXPECT_EQ(std::count(r.out.not_excited.begin(), r.out.not_excited.end(), "constant_torque"), 0);
}

}  // namespace
}  // namespace contour::diagnosis
