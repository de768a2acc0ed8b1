#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/prediction_error/problem.h"
#include "analysis/recording/read_log.h"
#include "tests/analysis/support/hidden_axis.h"

// Several logs, or one with gaps: after each, motion begins anew.
namespace contour::diagnosis {
namespace {

test::HiddenAxis Made(std::uint64_t seed) {
  test::HiddenOptions o;
  o.seed = seed;
  o.duration_s = 8.0;
  o.parameter_spread = 0.0;
  return test::MakeHiddenAxis(o);
}

/// As if the axis had been moved by hand in between.
AxisLog Elsewhere(AxisLog log) {
  for (double& q : log.position) q += 300.0;
  for (double& x : log.table_position_m) x += 300.0 * 1e-3;
  return log;
}

Point Stated(const Problem& problem) {
  Point p;
  p.base.assign(problem.terms.size(), 0.0);
  return p;
}

TEST(Gaps, EachLogLeavesWhatItLeavesAlone) {
  const test::HiddenAxis a = Made(3);
  const AxisLog second = Elsewhere(Made(4).log);
  const AxisLog joined = JoinLogs({a.log, second});
  const Problem both(joined, a.stated, 1), alone(second, a.stated, 1);
  ASSERT_EQ(both.signals->begins.size(), 2U);
  const std::size_t begin = both.signals->begins[1];
  ASSERT_EQ(begin + alone.rows(), both.rows());
  const Point p = Stated(both), q = Stated(alone);
  const auto x = both.Raw(std::span(&p, 1))[0], y = alone.Raw(std::span(&q, 1))[0];
  double rms = 0.0;
  for (std::size_t k = 0; k < alone.rows(); ++k) rms += y[k] * y[k] / static_cast<double>(alone.rows());
  rms = std::sqrt(rms);
  // Where the axis rests, the bristle remembers for longer what the command was before.
  for (std::size_t k = 300; k < alone.rows(); ++k) ASSERT_NEAR(x[begin + k], y[k], 0.02 * rms) << k;
  for (std::size_t k = 4000; k < alone.rows(); ++k) ASSERT_NEAR(x[begin + k], y[k], 1e-3 * rms) << k;
}

TEST(Gaps, NoJumpCountsAsMotionAndWhatFollowsOneNotAtOnce) {
  const test::HiddenAxis a = Made(3);
  const AxisLog joined = JoinLogs({a.log, Elsewhere(a.log)});
  const Problem both(joined, a.stated, 1), alone(a.log, a.stated, 1);
  EXPECT_NEAR(both.signals->max_speed / alone.signals->max_speed, 1.0, 1e-9);
  const std::size_t begin = both.signals->begins[1];
  for (std::size_t k = begin - 400; k < begin + 250; ++k) EXPECT_EQ(both.counted[k], 0) << k;
  EXPECT_EQ(both.counted[begin + 350], 1);
}

/// Mean square of the white residual over the rows that count.
double WhiteSquare(Problem& problem, std::size_t from) {
  const Point p = Stated(problem);
  problem.LearnOutliers(p);
  problem.LearnNoise(p);
  const auto white = problem.Residuals(std::span(&p, 1))[0];
  double squares = 0.0, rows = 0.0;
  for (std::size_t k = from; k < problem.rows(); ++k) {
    if (problem.counted[k] == 0) continue;
    squares += white[k] * white[k];
    rows += 1.0;
  }
  return squares / rows;
}

TEST(Gaps, TheNoiseBehindAGapIsThatOfALogAlone) {
  const test::HiddenAxis a = Made(3);
  const AxisLog joined = JoinLogs({a.log, Elsewhere(a.log)});
  Problem both(joined, a.stated, 1), alone(a.log, a.stated, 1);
  const double square = WhiteSquare(alone, 0);
  EXPECT_NEAR(WhiteSquare(both, both.signals->begins[1]) / square, 1.0, 0.3);
}

TEST(Gaps, ALongGapInsideALogIsOneToo) {
  test::HiddenAxis a = Made(3);
  for (std::size_t k = 4000; k < 4200; ++k) {
    a.log.present[k] = 0;
    a.log.position[k] = NAN;
  }
  const Problem problem(a.log, a.stated, 1);
  EXPECT_EQ(problem.signals->begins, (std::vector<std::size_t>{0, 4200}));
  const Point p = Stated(problem);
  const auto raw = problem.Raw(std::span(&p, 1))[0];
  // The command of the gap is not known; nothing of that is left behind it.
  double most = 0.0;
  for (std::size_t k = 4600; k < 7900; ++k) most = std::max(most, std::fabs(raw[k]));
  double before = 0.0;
  for (std::size_t k = 1000; k < 3900; ++k) before = std::max(before, std::fabs(raw[k]));
  EXPECT_LT(most, 3.0 * before);
}

}  // namespace
}  // namespace contour::diagnosis
