#include "analysis/diagnosis/quantification/jitter_cause.h"

#include <gtest/gtest.h>

#include "tests/analysis/support/known_axis.h"

namespace contour::diagnosis {
namespace {

class JitterCauseTest : public testing::Test {
 protected:
  Diagnosis Accepted(const Jitter& jitter) const {
    Diagnosis out;
    out.candidates = {{"cogging", 1.0, 1.0, false}, {"sample_jitter", 50.0, 50.0, false}};
    Fit nominal;
    nominal.point.base.assign(axis_.problem.terms.size(), 0.0);
    AcceptJitter(axis_.problem, nominal, jitter, out);
    return out;
  }

  test::KnownAxis axis_;
};

TEST_F(JitterCauseTest, IsACauseInMicrosecondsWithItsInterval) {
  const Jitter jitter = {.tested = true, .drop = 103.0, .rms_s = 14e-6, .sigma_s = 0.5e-6, .sigma_s2 = 0.0};
  EXPECT_LT(ScoreOf(jitter), 103.0);
  const Diagnosis d = Accepted(jitter);
  ASSERT_EQ(d.causes.size(), 1u);
  EXPECT_EQ(d.causes[0].kind, "sample_jitter");
  EXPECT_NEAR(d.causes[0].log_evidence_gain, 0.5 * ScoreOf(jitter), 1e-12);
  const Interval rms_us = d.causes[0].parameters.at("rms_us");
  EXPECT_NEAR(rms_us.value, 14.0, 1e-9);
  // 1.96 x 0.5 us, and a little that no model is quite right.
  EXPECT_LT(rms_us.low, 13.02);
  EXPECT_GT(rms_us.low, 12.5);
  EXPECT_NEAR(rms_us.high - 14.0, 14.0 - rms_us.low, 1e-9);
  EXPECT_EQ(d.causes[0].unit, "Nm");
  EXPECT_NE(d.causes[0].deciding_experiment.find("constant speeds"), std::string::npos);
  EXPECT_FALSE(d.candidates[0].accepted);
  EXPECT_TRUE(d.candidates[1].accepted);
}

TEST_F(JitterCauseTest, AnIntervalDoesNotGoBelowNone) {
  const Diagnosis d =
      Accepted({.tested = true, .drop = 20.0, .rms_s = 2e-6, .sigma_s = 2e-6, .sigma_s2 = 0.0});
  EXPECT_LT(d.causes[0].parameters.at("rms_us").low, 0.1);
  EXPECT_GT(d.causes[0].parameters.at("rms_us").low, -0.1);
}

}  // namespace
}  // namespace contour::diagnosis
