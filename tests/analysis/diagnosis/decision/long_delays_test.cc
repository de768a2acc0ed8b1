#include "analysis/diagnosis/decision/long_delays.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

/// A short log whose torque acts later than stated, and what is proposed for one of the kinds.
struct Late {
  Late(const std::string& hidden, double size_ms) : axis({{hidden, size_ms, 0.0, 0.0, 0.0}}) {
    for (const char* kind : {"input_delay", "current_lag"}) effects.push_back(axis.Of(kind));
    scored = ScoreEffects(axis.problem, axis.base, effects);
  }

  [[nodiscard]] std::vector<InitialGuess> Guesses(const std::vector<Hypothesis>& hypotheses = {}) const {
    return LongDelays(axis.problem, axis.base, scored, ScoreThreshold{}, hypotheses);
  }
  /// 0: none is proposed.
  [[nodiscard]] double Proposed_s(const std::string& kind, const std::vector<Hypothesis>& others = {}) const {
    for (const InitialGuess& g : Guesses(others))
      if (g.point.effects.back()->kind == kind) return g.point.amplitudes.back()[0];
    return 0.0;
  }

  test::FittedAxis axis;
  std::vector<SharedEffect> effects;
  std::vector<Scored> scored;
};

// Before: fits began at none, and a compliance of 135 Hz was told in place of it.
TEST(LongDelays, OfManyRowsIsBegunWithinAFactorOfTwo) {
  for (const char* kind : {"input_delay", "current_lag"}) {
    const Late late(kind, 5.0);
    EXPECT_GE(late.Proposed_s(kind), 2.5e-3) << kind;
    EXPECT_LE(late.Proposed_s(kind), 10e-3) << kind;
  }
}

TEST(LongDelays, AnAxisThatActsInTimeIsLeftAlone) {
  const Late in_time("input_delay", 0.0);
  EXPECT_TRUE(in_time.Guesses().empty());
}

TEST(LongDelays, WhatHasBeenReachedFromNoneIsNotBegunAgain) {
  const Late late("input_delay", 5.0);
  Hypothesis r;
  r.fit.point = late.axis.base.point;
  r.fit.point.effects = {late.effects[0]};
  r.fit.point.amplitudes = {{late.Proposed_s("input_delay")}};
  EXPECT_EQ(late.Proposed_s("input_delay", {r}), 0.0);
  r.fit.point.amplitudes = {{0.1e-3}};
  EXPECT_GT(late.Proposed_s("input_delay", {r}), 0.0);
}

}  // namespace
}  // namespace contour::diagnosis
