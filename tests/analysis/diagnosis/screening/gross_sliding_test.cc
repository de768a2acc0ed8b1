#include "analysis/diagnosis/screening/gross_sliding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

test::HiddenOptions Short() {
  test::HiddenOptions o;
  o.duration_s = 10.0;
  o.maxwell_slip = true;
  return o;
}

class GrossSlidingTest : public testing::Test {
 protected:
  SharedEffect Of(const std::string& kind) const {
    const std::vector<SharedEffect> all = CatalogueEffects(problem_);
    return *std::find_if(all.begin(), all.end(), [&](const SharedEffect& e) { return e->kind == kind; });
  }

  /// `rough` so many standard deviations from zero.
  Fit With(const std::vector<std::string>& kinds, double rough_deviations) const {
    Fit fit;
    fit.point = made_.point;
    for (std::size_t i = 0; i < problem_.terms.size(); ++i)
      if (problem_.terms[i].name == "rough") fit.point.base[i] = rough_deviations * problem_.terms[i].sigma;
    for (const std::string& kind : kinds) {
      fit.point.effects.push_back(Of(kind));
      fit.point.amplitudes.emplace_back(fit.point.effects.back()->steps.size(), 0.0);
    }
    fit.residual.assign(problem_.data_size(), 1.0);
    fit.cost = static_cast<double>(fit.residual.size());
    return fit;
  }

  test::LearntProblem made_{test::MakeHiddenAxis(Short())};
  const Problem& problem_ = made_.problem;
};

TEST_F(GrossSlidingTest, AreFarFromReversalsAndFast) {
  const std::vector<bool> sliding = GrossSliding(problem_);
  const std::vector<double> way = TravelSinceReversal(*problem_.signals);
  const StatedFriction& f = problem_.nominal.friction;
  std::size_t count = 0;
  for (std::size_t k = 0; k < sliding.size(); ++k) {
    if (!sliding[k]) continue;
    ++count;
    EXPECT_GT(way[k], 5.0 * f.Fc_plus / f.s0 * problem_.stated.table_per_q);
    EXPECT_GT(std::fabs(problem_.signals->velocity[k]), f.vs);
  }
  EXPECT_GT(count, sliding.size() / 10);
  EXPECT_LT(count, sliding.size());
}

TEST_F(GrossSlidingTest, MismatchIsAnElementInPreslidingAndABristleThatDoesNotWear) {
  EXPECT_TRUE(FrictionModelMismatch(problem_, With({"presliding_hysteresis"}, -6.0)));
  EXPECT_TRUE(FrictionModelMismatch(problem_, With({"presliding_hysteresis", "cable_spring"}, -6.0)));
  EXPECT_FALSE(FrictionModelMismatch(problem_, With({"presliding_hysteresis"}, -0.2)));
  EXPECT_FALSE(FrictionModelMismatch(problem_, With({"presliding_hysteresis"}, 6.0)));
  EXPECT_FALSE(FrictionModelMismatch(problem_, With({"cable_spring"}, -6.0)));
}

TEST_F(GrossSlidingTest, OtherCausesAreJudgedThereWhereTheLawIsAnother) {
  const std::vector<bool> sliding = GrossSliding(problem_);
  const auto count = static_cast<double>(std::count(sliding.begin(), sliding.end(), true));
  const auto drop = [&](const std::string& kind, double rough, bool in_slides) {
    const Fit without = With({"presliding_hysteresis"}, rough);
    Fit with = With({"presliding_hysteresis", kind}, rough);
    for (std::size_t k = 0; k < sliding.size(); ++k)
      if (sliding[k] == in_slides) with.residual[k] = 0.0;
    with.cost = 0.0;
    for (const double r : with.residual) with.cost += r * r;
    return DropOf(problem_, without, with);
  };
  const double others = static_cast<double>(sliding.size()) - count;
  EXPECT_NEAR(drop("cable_spring", -6.0, true), count, 1e-6);
  EXPECT_NEAR(drop("cable_spring", -6.0, false), 0.0, 1e-6);
  EXPECT_NEAR(drop("backlash", -6.0, false), others, 1e-6);
  EXPECT_NEAR(drop("cable_spring", 0.0, false), others, 1e-6);
}

}  // namespace
}  // namespace contour::diagnosis
