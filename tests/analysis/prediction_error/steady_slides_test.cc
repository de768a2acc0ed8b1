#include "analysis/prediction_error/steady_slides.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#include "analysis/prediction_error/problem.h"
#include "analysis/prediction_error/simd/lane_run.h"
#include "tests/analysis/support/distance.h"
#include "tests/analysis/support/hidden_axis.h"
#include "tests/analysis/support/scalar_predictor.h"

namespace contour::diagnosis {
namespace {

test::HiddenAxis Axis(bool two_inertia, bool on_load) {
  test::HiddenOptions o;
  o.duration_s = 20.0;
  o.two_inertia = two_inertia;
  o.friction_on_load = on_load;
  return test::MakeHiddenAxis(o);
}

std::vector<std::uint8_t> SlidesOfLog(const Problem& problem, const AxisLog& log, double strict) {
  const std::vector<std::size_t> begins = {0};
  return SteadySlides({log, problem.setup.valid, begins, problem.nominal}, strict);
}

double Share(const std::vector<std::uint8_t>& rows) {
  return std::accumulate(rows.begin(), rows.end(), 0.0) / static_cast<double>(rows.size());
}

// Friction held over rows of steady sliding, against sub-steps four times as many: it may add a tenth to
// what the sub-steps themselves are off by, which is at reversals.
TEST(SteadySlides, HoldingFrictionThereIsAsExactAsSubsteps) {
  for (const bool on_load : {false, true})
    for (const bool two : {false, true}) {
      if (on_load && !two) continue;
      const test::HiddenAxis axis = Axis(two, on_load);
      const Problem problem(axis.log, axis.stated, 1);
      const auto run = [&](int times, bool held) {
        FilterSetup setup = problem.setup;
        setup.substeps_rigid *= times;
        setup.substeps_two *= times;
        if (!held) setup.slides.clear();
        return RunFilter(setup, std::span(&problem.nominal, 1), 1)[0].innovation;
      };
      const std::vector<double> fine = run(4, false), as_is = run(1, false), held = run(1, true);
      EXPECT_GT(test::Distance(held, as_is), 0.0);
      EXPECT_LT(test::Distance(held, as_is), 0.1 * test::Distance(as_is, fine)) << two << on_load;
    }
}

// Sub-steps that are off by hardly anything leave no room for what holding friction adds.
TEST(SteadySlides, HowManyRowsAreHeldDependsOnWhatTheSubstepsAreOffBy) {
  const test::HiddenAxis axis = Axis(false, false);
  const Problem problem(axis.log, axis.stated, 1);
  const std::vector<std::size_t> begins = {0};
  const SlidesOf of{axis.log, problem.setup.valid, begins, problem.nominal};
  FilterSetup fine = problem.setup;
  fine.substeps_rigid = kMostSubsteps;
  ASSERT_GT(Share(HeldSlides(problem.setup, of)), 0.1);
  EXPECT_LT(Share(HeldSlides(fine, of)), Share(HeldSlides(problem.setup, of)));
}

TEST(SteadySlides, StricterRowsAreSomeOfThem) {
  const test::HiddenAxis axis = Axis(false, false);
  const Problem problem(axis.log, axis.stated, 1);
  const std::vector<std::uint8_t> loose = SlidesOfLog(problem, axis.log, 1.0),
                                  strict = SlidesOfLog(problem, axis.log, 8.0);
  EXPECT_LT(Share(strict), Share(loose));
  for (std::size_t k = 0; k < loose.size(); ++k) EXPECT_LE(strict[k], loose[k]) << k;
}

TEST(SteadySlides, ARowNextToATurnOrAWrongReadingIsNone) {
  const test::HiddenAxis axis = Axis(false, false);
  const Problem problem(axis.log, axis.stated, 1);
  const std::vector<std::uint8_t>& slides = problem.setup.slides;
  ASSERT_EQ(slides.size(), problem.rows());
  const auto some = std::accumulate(slides.begin(), slides.end(), std::size_t{0});
  EXPECT_GT(some, problem.rows() / 10);
  const std::vector<double>& q = axis.log.position;
  const double bristle = problem.nominal.friction.Fs_plus / problem.nominal.friction.s0;
  double turned = q[0];
  for (std::size_t k = 2; k + 1 < slides.size(); ++k) {
    if ((q[k + 1] - q[k]) * (q[k] - q[k - 1]) <= 0.0) turned = q[k];
    if (slides[k] != 0) {
      EXPECT_GT(std::fabs(q[k] - turned), 2.0 * bristle) << k;
    }
  }
  const std::size_t at =
      static_cast<std::size_t>(std::find(slides.begin(), slides.end(), std::uint8_t{1}) - slides.begin()) +
      10;
  std::vector<std::uint8_t> valid = problem.setup.valid;
  valid[at] = 0;
  const std::vector<std::size_t> begins = {0};
  const std::vector<std::uint8_t> without = SteadySlides({axis.log, valid, begins, problem.nominal}, 1.0);
  for (std::size_t k = at - 2; k < at + 2; ++k) EXPECT_EQ(without[k], 0) << k;
}

// A bristle that nobody knows.
TEST(SteadySlides, AnAxisWithoutABristleHasNone) {
  const test::HiddenAxis axis = Axis(false, false);
  const Problem problem(axis.log, axis.stated, 1);
  AxisModel free = problem.nominal;
  free.friction.s0 = 0.0;
  const std::vector<std::size_t> begins = {0};
  const std::vector<std::uint8_t> slides = SteadySlides({axis.log, problem.setup.valid, begins, free}, 1.0);
  EXPECT_EQ(std::count(slides.begin(), slides.end(), std::uint8_t{1}), 0);
}

}  // namespace
}  // namespace contour::diagnosis
