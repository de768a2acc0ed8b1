#include "analysis/diagnosis/decision/superseded.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "analysis/diagnosis/decision/tested_score.h"
#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

const test::HiddenEffect kConstant{"constant_torque", 0.3, 0.0, 0.0, 0.0};
const test::HiddenEffect kAsymmetric{"asymmetric_coulomb", 0.3, 0.0, 0.0, 0.0};

/// An asymmetry that was accepted first, and a constant torque in addition to it.
struct Both {
  explicit Both(std::vector<test::HiddenEffect> effects) : axis(std::move(effects)) {
    accepted.fit = axis.base;
    for (const char* kind : {"asymmetric_coulomb", "constant_torque"}) {
      Point point = accepted.fit.point;
      point.effects.push_back(axis.Of(kind));
      point.amplitudes.emplace_back(point.effects.back()->steps.size(), 0.0);
      Hypothesis r{FitPoint(axis.problem, point)};
      Judge(axis.problem, accepted.fit, r);
      AcceptFirst(axis.problem, {r}, threshold, accepted, out);
    }
    evidence = out.causes[1].log_evidence_gain;
    dropped = DropSuperseded(axis.problem, threshold, accepted, out);
  }

  test::FittedAxis axis;
  ScoreThreshold threshold{.flips = 10.0, .calibrated = 10.0};
  Accepted accepted;
  Diagnosis out;
  double evidence = 0.0;
  bool dropped = false;
};

TEST(DropSuperseded, WhatStoodForTheNewOneGoesAndItsEvidenceIsTheNewOnes) {
  const Both b({kConstant});
  EXPECT_TRUE(b.dropped);
  ASSERT_EQ(b.out.causes.size(), 1u);
  EXPECT_EQ(b.out.causes[0].kind, "constant_torque");
  EXPECT_GT(b.out.causes[0].log_evidence_gain, 2.0 * b.evidence);
  EXPECT_GT(b.out.causes[0].heldout_gain, 0.1);
  EXPECT_FALSE(b.out.blocks.empty());
  EXPECT_EQ(b.accepted.places, (std::vector<std::size_t>{0}));
  EXPECT_EQ(b.accepted.scatter.size(), 1u);
  ASSERT_EQ(b.accepted.fit.point.effects.size(), 1u);
  EXPECT_EQ(b.accepted.fit.point.effects[0]->kind, "constant_torque");
}

TEST(DropSuperseded, WhatIsThereBesidesStays) {
  const Both b({kConstant, kAsymmetric});
  EXPECT_FALSE(b.dropped);
  ASSERT_EQ(b.out.causes.size(), 2u);
  EXPECT_EQ(b.out.causes[1].log_evidence_gain, b.evidence);
  EXPECT_EQ(b.accepted.places, (std::vector<std::size_t>{0, 1}));
}

/// A limit that is known to a hundredth, and that explains nothing: by how well its size is known it would be
/// there for ever.
TEST(DropSuperseded, HowWellALimitIsKnownIsNotWhatItExplains) {
  test::FittedAxis axis({kConstant});
  auto limit = std::make_shared<Effect>();
  limit->kind = "torque_saturation";
  limit->steps = {0.01};
  limit->start = {1.0};
  limit->tested = 1;
  limit->apply = [](const std::vector<double>& a, AxisModel& m) {
    if (a[0] > 0.0) m.friction.s2 *= a[0];
  };
  Accepted accepted;
  Diagnosis out;
  Point point = axis.base.point;
  point.effects = {limit, axis.Of("constant_torque")};
  point.amplitudes = {{1.0}, {0.3 * axis.made.axis.stated.friction.Fc_plus}};
  accepted.fit = FitPoint(axis.problem, point);
  const ScoreThreshold threshold{.flips = 10.0, .calibrated = 10.0};
  accepted.places = {0, 1};
  accepted.scatter = {1.0, 1.0};
  for (const char* kind : {"torque_saturation", "constant_torque"}) {
    out.causes.emplace_back();
    out.causes.back().kind = kind;
  }
  EXPECT_TRUE(DropSuperseded(axis.problem, threshold, accepted, out));
  ASSERT_EQ(out.causes.size(), 1u);
  EXPECT_EQ(out.causes[0].kind, "constant_torque");
}

}  // namespace
}  // namespace contour::diagnosis
