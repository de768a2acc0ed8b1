#include "analysis/metrics/run_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace contour {
namespace {

const double kPi = std::numbers::pi;
constexpr double kRadius_m = 1e-4;

std::shared_ptr<const MotionPlan> PlanOf(const std::string& text, std::size_t axes = 2) {
  PerAxis<double> start(axes);
  PerAxis<PlanLimits> limits(axes);
  const char* names[] = {"x", "y"};
  for (std::size_t i = 0; i < axes; ++i) limits[i] = {names[i], -0.2, 0.2, 0.25, 5.0, 200.0};
  start[0] = kRadius_m;  // the circles below are then about the origin
  return PlanMotion(ParseProgram(text, "test.yaml", ProgramFormat::kYaml), start, limits);
}

std::shared_ptr<const MotionPlan> CirclePlan(int turns = 3) {
  return PlanOf("shape: circle\nradius_mm: 0.1\nfrequency_hz: 0.5\nturns: " + std::to_string(turns) + "\n");
}

/// Runs the plan at 1 kHz; `edit` turns a perfect row into the machine's.
RunMetrics Score(const std::shared_ptr<const MotionPlan>& plan, const std::function<void(ScoredRow&)>& edit) {
  std::vector<ScoredAxisFacts> facts;
  for (std::size_t i = 0; i < plan->axis_count(); ++i) facts.push_back({i == 0 ? "x" : "y", 5e-9});
  RunScorer scorer(plan, facts);
  PerAxis<ReferencePoint> reference;
  for (int k = 0; k * 1e-3 <= plan->duration_s() + 0.1; ++k) {
    ScoredRow row{std::min(k * 1e-3, plan->duration_s()), PerAxis<ScoredAxis>(plan->axis_count())};
    plan->At(row.path_time_s, reference);
    for (std::size_t i = 0; i < reference.size(); ++i) {
      row.axes[i] = {};
      row.axes[i].reference_m = row.axes[i].encoder_m = row.axes[i].table_m = reference[i].position_m;
    }
    edit(row);
    scorer.Add(row);
  }
  return scorer.Finish();
}

/// Moves the table along the radius by a function of the angle.
std::function<void(ScoredRow&)> RadialError(std::function<double(double)> error_m) {
  return [error_m](ScoredRow& row) {
    const double angle = std::atan2(row.axes[1].reference_m, row.axes[0].reference_m);
    row.axes[0].table_m += error_m(angle) * std::cos(angle);
    row.axes[1].table_m += error_m(angle) * std::sin(angle);
  };
}

TEST(RunMetrics, PerfectCircleHasNoErrors) {
  const RunMetrics m = Score(CirclePlan(), [](ScoredRow&) {});
  for (const ContourMetrics* c : {&m.encoder, &m.table}) {
    EXPECT_NEAR(*c->rms_um, 0.0, 1e-9);
    EXPECT_NEAR(*c->peak_um, 0.0, 1e-9);
    EXPECT_NEAR(*c->circular_deviation_um, 0.0, 1e-8);
    for (const double peak : *c->quadrant_peak_um) EXPECT_NEAR(peak, 0.0, 1e-9);
  }
  // Turns 2 and 3 of 2 s each; the last one takes 0.1 s more to come to rest.
  EXPECT_NEAR(static_cast<double>(m.scored_cycles), 4101.0, 2.5);
}

TEST(RunMetrics, EllipseIsSeenAtTheReversalsAndInTheDeviation) {
  // Radius + e at +-X, - e at +-Y: radial error e cos 2 phi.
  const RunMetrics m =
      Score(CirclePlan(11), RadialError([](double angle) { return 1e-6 * std::cos(2.0 * angle); }));
  EXPECT_NEAR(*m.table.peak_um, 1.0, 1e-5);
  EXPECT_NEAR(*m.table.rms_um, 1.0 / std::numbers::sqrt2, 5e-3);  // the run-down weighs +X a little more
  EXPECT_NEAR(*m.table.circular_deviation_um, 2.0, 0.02);
  for (const double peak : *m.table.quadrant_peak_um) EXPECT_NEAR(peak, 1.0, 1e-5);
  EXPECT_NEAR(*m.encoder.peak_um, 0.0, 1e-9);
}

TEST(RunMetrics, ShiftedCircleHasErrorsButNoDeviation) {
  const RunMetrics m = Score(CirclePlan(), [](ScoredRow& row) {
    row.axes[0].table_m += 3e-6;
    row.axes[1].table_m -= 4e-6;
  });
  EXPECT_NEAR(*m.table.peak_um, 5.0, 0.01);
  EXPECT_NEAR(*m.table.circular_deviation_um, 0.0, 1e-6);
  // Within 15 degrees of +X the radial error is 3 cos phi - 4 sin phi, largest at -15 degrees.
  const double edge = 15.0 * kPi / 180.0;
  EXPECT_NEAR((*m.table.quadrant_peak_um)[0], 3.0 * std::cos(edge) + 4.0 * std::sin(edge), 0.12);
  EXPECT_NEAR((*m.table.quadrant_peak_um)[1], 4.0 * std::cos(edge) + 3.0 * std::sin(edge), 0.12);
}

TEST(RunMetrics, SpikeAfterOneReversalIsCountedThereOnly) {
  // 2 um high, from 2 to 6 degrees after +Y; and one outside all windows, 45 degrees after +X.
  const RunMetrics m = Score(CirclePlan(), RadialError([](double angle) {
                               const double degrees = angle * 180.0 / kPi;
                               if (degrees > 92.0 && degrees < 96.0) return 2e-6;
                               return degrees > 44.0 && degrees < 46.0 ? -7e-6 : 0.0;
                             }));
  const auto& peaks = *m.table.quadrant_peak_um;
  EXPECT_NEAR(peaks[0], 0.0, 1e-9);
  EXPECT_NEAR(peaks[1], 2.0, 1e-9);
  EXPECT_NEAR(peaks[2], 0.0, 1e-9);
  EXPECT_NEAR(peaks[3], 0.0, 1e-9);
  EXPECT_NEAR(*m.table.peak_um, 7.0, 1e-9);
  // A radial error does not shift the best centre much: 9 um from the lowest to the highest point.
  EXPECT_NEAR(*m.table.circular_deviation_um, 9.0, 0.3);
}

TEST(RunMetrics, FirstTurnIsNotScored) {
  const auto plan = CirclePlan();
  const auto first_turn_only = [&](ScoredRow& row) {
    if (plan->Turns(row.path_time_s) < 0.999) row.axes[0].table_m += 1e-3;
  };
  EXPECT_NEAR(*Score(plan, first_turn_only).table.peak_um, 0.0, 1e-9);
  const RunMetrics single = Score(CirclePlan(1), [](ScoredRow&) {});
  EXPECT_FALSE(single.table.peak_um.has_value());
  EXPECT_FALSE(single.table.circular_deviation_um.has_value());
  EXPECT_EQ(single.scored_cycles, 0u);
}

TEST(RunMetrics, WithoutTruthTheTableIsUnknown) {
  const RunMetrics m = Score(CirclePlan(), [](ScoredRow& row) { row.axes[1].table_m = kNoTruth; });
  EXPECT_FALSE(m.table.rms_um.has_value());
  EXPECT_FALSE(m.table.quadrant_peak_um.has_value());
  EXPECT_TRUE(m.encoder.rms_um.has_value());
  EXPECT_FALSE(m.axes[0].friction_estimate_error_rms_N.has_value());
}

TEST(RunMetrics, LineIsScoredAfterOneSecondByDistanceNotByLag) {
  const auto plan = PlanOf("shape: line\ndx_mm: 60\ndy_mm: 80\nfeed_mm_min: 1500\n");
  const RunMetrics m = Score(plan, [](ScoredRow& row) {
    // 10 um behind along the line, 2 um to its side; a millimetre off before it counts.
    const double side = row.path_time_s < 0.999 ? 1e-3 : 2e-6;
    row.axes[0].encoder_m += -0.6 * 10e-6 - 0.8 * side;
    row.axes[1].encoder_m += -0.8 * 10e-6 + 0.6 * side;
  });
  EXPECT_NEAR(*m.encoder.peak_um, 2.0, 1e-6);
  EXPECT_NEAR(*m.encoder.rms_um, 2.0, 1e-6);
  EXPECT_FALSE(m.encoder.circular_deviation_um.has_value());
  EXPECT_FALSE(m.encoder.quadrant_peak_um.has_value());
  EXPECT_NEAR(*m.axes[0].following_error_peak_um, 7.6, 1e-6);
}

TEST(RunMetrics, FrictionErrorIsTheRootMeanSquareOfTheScoredRows) {
  const auto plan = CirclePlan();
  const RunMetrics m = Score(plan, [&](ScoredRow& row) {
    const double error = plan->Scored(row.path_time_s) ? 0.5 : 100.0;
    row.axes[0].friction_truth_N = 40.0;
    row.axes[0].friction_estimate_N = 40.0 + error;
    row.axes[1].friction_truth_N = -40.0;
  });
  EXPECT_NEAR(*m.axes[0].friction_estimate_error_rms_N, 0.5, 1e-12);
  EXPECT_FALSE(m.axes[1].friction_estimate_error_rms_N.has_value());
}

TEST(RunMetrics, SaturationIsAFractionOfTheProgram) {
  const auto plan = PlanOf("shape: hold\nseconds: 2\n");
  const RunMetrics m =
      Score(plan, [](ScoredRow& row) { row.axes[0].torque_saturated = row.path_time_s < 0.5 - 1e-9; });
  EXPECT_NEAR(m.axes[0].torque_saturated_fraction, 500.0 / 2001.0, 1e-12);
  EXPECT_EQ(m.axes[1].torque_saturated_fraction, 0.0);
}

TEST(RunMetrics, HoldCountsPeakToPeakOverItsLastTwentySeconds) {
  const auto plan = PlanOf("shape: hold\nseconds: 25\n");
  const RunMetrics m = Score(plan, [](ScoredRow& row) {
    if (row.path_time_s < 4.9) row.axes[0].encoder_m += 1e-3;
    if (row.path_time_s > 10.0 && row.path_time_s < 10.1) row.axes[0].encoder_m += 5e-9;
    if (row.path_time_s > 20.0) row.axes[0].encoder_m -= 2 * 5e-9;
    if (row.path_time_s > 24.0) row.axes[1].encoder_m -= 5e-9;
  });
  EXPECT_EQ(m.axes[0].encoder_pp_counts, 3.0);
  EXPECT_EQ(m.axes[1].encoder_pp_counts, 1.0);
  EXPECT_EQ(m.encoder_pp_counts, 3.0);
  EXPECT_FALSE(Score(CirclePlan(), [](ScoredRow&) {}).encoder_pp_counts.has_value());
}

TEST(RunMetrics, OneAxisIsEnough) {
  const auto plan = PlanOf("shape: sine\naxis: x\namplitude_mm: 1\nfrequency_hz: 1\n", 1);
  const RunMetrics m = Score(plan, [](ScoredRow& row) { row.axes[0].encoder_m += 2e-6; });
  ASSERT_EQ(m.axes.size(), 1u);
  EXPECT_NEAR(*m.axes[0].following_error_rms_um, 2.0, 1e-9);
}

}  // namespace
}  // namespace contour
