#include "analysis/prediction_error/forward_filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/prediction_error/problem.h"
#include "tests/analysis/support/distance.h"
#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

Point Stated(const Problem& problem) {
  Point p;
  p.base.assign(problem.terms.size(), 0.0);
  return p;
}

std::vector<double> RmsPerSegment(const std::vector<double>& x, std::size_t rows) {
  std::vector<double> out;
  for (std::size_t k = 0; k + 1000 <= rows; k += 1000) {
    double sum = 0.0;
    for (std::size_t i = k; i < k + 1000; ++i) sum += x[i] * x[i];
    out.push_back(std::sqrt(sum / 1000.0));
  }
  return out;
}

// With the true parameters and a fine encoder, what is left is the difference of two integrators: it must be
// under a tenth of what ordinary noise leaves, in every second of the log.
void ExpectSmallerThanNoise(bool two_inertia, bool on_load) {
  test::HiddenOptions o;
  o.seed = 5;
  o.duration_s = 30.0;
  o.two_inertia = two_inertia;
  o.friction_on_load = on_load;
  o.parameter_spread = 0.0;
  const test::HiddenAxis noisy = test::MakeHiddenAxis(o);
  o.torque_noise_rel = 0.0;
  o.encoder_step_rad = 1e-7;
  const test::HiddenAxis silent = test::MakeHiddenAxis(o);
  const Problem with(noisy.log, noisy.stated, 1), without(silent.log, silent.stated, 1);
  const Point a = Stated(with), b = Stated(without);
  const auto noise = RmsPerSegment(with.Raw(std::span(&a, 1))[0], with.rows());
  const auto left = RmsPerSegment(without.Raw(std::span(&b, 1))[0], without.rows());
  for (std::size_t i = 0; i < noise.size(); ++i) EXPECT_LT(left[i], 0.1 * noise[i]) << "second " << i;
}

TEST(ForwardFilter, RigidAxisLeavesLessThanATenthOfTheNoise) { ExpectSmallerThanNoise(false, false); }
TEST(ForwardFilter, TwoInertiasLeaveLessThanATenthOfTheNoise) { ExpectSmallerThanNoise(true, false); }
TEST(ForwardFilter, FrictionOnTheTableLeavesLessThanATenthOfTheNoise) { ExpectSmallerThanNoise(true, true); }

TEST(ForwardFilter, LanesAndThreadsDoNotChangeARun) {
  test::HiddenOptions o;
  o.duration_s = 5.0;
  o.two_inertia = true;
  const test::HiddenAxis axis = test::MakeHiddenAxis(o);
  const Problem problem(axis.log, axis.stated, 1);
  Point p = Stated(problem);
  std::vector<AxisModel> models;
  for (int i = 0; i < 7; ++i) {
    p.base[0] = 0.01 * i;
    models.push_back(problem.Build(p));
  }
  const auto together = RunFilter(problem.setup, models, 3);
  for (std::size_t i = 0; i < models.size(); ++i) {
    const auto alone = RunFilter(problem.setup, std::span(&models[i], 1), 1);
    EXPECT_EQ(alone[0].innovation, together[i].innovation);
  }
}

TEST(DeliveredStore, WhatIsLeftOfAKeyServesIt) {
  DeliveredStore store;
  const DeliveredKey key{1e-4, 2e-4, 4}, other{1e-4, 3e-4, 4};
  Delivered found;
  EXPECT_FALSE(store.Find(key, true, found));
  store.Give(key, true, {{1.0}, {2.0}});
  store.Give(other, false, {{3.0}, {4.0}});
  EXPECT_FALSE(store.Find(other, true, found)) << "of some segments only";
  EXPECT_FALSE(store.Find(other, false, found)) << "of which nobody knows";
  ASSERT_TRUE(store.Find(key, true, found));
  EXPECT_EQ(found.mean, std::vector<double>{1.0});
  EXPECT_FALSE(store.Find(key, true, found)) << "it is the caller's now";
  EXPECT_EQ(store.Take().mean, std::vector<double>{3.0}) << "to be filled";
  EXPECT_TRUE(store.Take().mean.empty());
}

// Fits come back to the delay that they stood at, after some others.
TEST(ForwardFilter, MeansThatAreKeptChangeNoRun) {
  test::HiddenOptions o;
  o.duration_s = 5.0;
  const test::HiddenAxis axis = test::MakeHiddenAxis(o);
  const Problem problem(axis.log, axis.stated, 1);
  AxisModel model = problem.Build(Stated(problem));
  const auto first = RunFilter(problem.setup, std::span(&model, 1), 1);
  for (int i = 1; i < 20; ++i) {
    AxisModel late = model;
    late.delay_s += 1e-5 * i;
    RunFilter(problem.setup, std::span(&late, 1), 1);
    if (i % 4 != 0) continue;
    EXPECT_EQ(RunFilter(problem.setup, std::span(&model, 1), 1)[0].innovation, first[0].innovation);
  }
}

// What a fit's step may end in leaves the runs next to it alone, whose delivered means have another length.
TEST(ForwardFilter, WhatIsNoMachineHasNoResidualAndDisturbsNone) {
  test::HiddenOptions o;
  o.duration_s = 5.0;
  const test::HiddenAxis axis = test::MakeHiddenAxis(o);
  const Problem problem(axis.log, axis.stated, 1);
  const AxisModel rigid = problem.Build(Stated(problem));
  AxisModel two = rigid, no_number = rigid, no_number_two = rigid, negative = rigid;
  two.two_inertia = true;
  two.load_inertia = 0.1 * rigid.motor_inertia;
  two.stiffness = two.load_inertia * 4e6;
  no_number_two = two;
  no_number.delay_s = no_number_two.lag_s = std::nan("");
  negative.payload = -2.0 * rigid.motor_inertia;
  const std::vector<AxisModel> models = {no_number, rigid, no_number_two, two, negative};
  const auto runs = RunFilter(problem.setup, models, 1);
  for (const std::size_t i : {1U, 3U})
    EXPECT_EQ(runs[i].innovation, RunFilter(problem.setup, std::span(&models[i], 1), 1)[0].innovation);
  for (const std::size_t i : {0U, 2U, 4U}) {
    ASSERT_EQ(runs[i].innovation.size(), problem.rows());
    EXPECT_TRUE(std::isnan(runs[i].innovation.back())) << i;
  }
}

// Below zero, `rough` is a speed below which the bristle does not wear. A fit goes there step by step, so a
// little more of it must change little.
TEST(ForwardFilter, ABristleThatCreepingDoesNotWearChangesSmoothly) {
  test::HiddenOptions o;
  o.duration_s = 10.0;
  const test::HiddenAxis axis = test::MakeHiddenAxis(o);
  const Problem problem(axis.log, axis.stated, 1);
  const AxisModel wears = problem.Build(Stated(problem));
  std::vector<AxisModel> models(3, wears);
  const double vs = problem.nominal.friction.vs;
  models[0].rough = 0.0;
  models[1].rough = -0.01 * vs * vs;
  models[2].rough = 1.01 * models[1].rough;
  const auto runs = RunFilter(problem.setup, models, 1);
  const double all = test::Distance(runs[0].innovation, runs[1].innovation);
  EXPECT_GT(all, 0.0);
  EXPECT_LT(test::Distance(runs[1].innovation, runs[2].innovation), 0.1 * all);
}

// What the scale reads beyond the encoder is no matter of the forces, which move the model's own position.
TEST(ForwardFilter, ErrorsOfTheForcesLeaveTheScaleOfARigidAxisAlone) {
  test::HiddenOptions o;
  o.duration_s = 10.0;
  const test::HiddenAxis axis = test::MakeHiddenAxis(o);
  const Problem problem(axis.log, axis.stated, 1);
  std::vector<Point> points(2, Stated(problem));
  for (std::size_t t = 0; t < problem.terms.size(); ++t)
    if (problem.terms[t].name == "Fc") points[1].base[t] = 0.3;
  const auto raw = problem.Raw(points);
  const auto rows = static_cast<std::ptrdiff_t>(problem.rows());
  const double moved =
      test::Distance({raw[0].begin(), raw[0].begin() + rows}, {raw[1].begin(), raw[1].begin() + rows});
  ASSERT_GT(moved * axis.stated.table_per_q, 1e-5);
  for (std::ptrdiff_t k = rows; k < 2 * rows; ++k)
    EXPECT_NEAR(raw[0][static_cast<std::size_t>(k)], raw[1][static_cast<std::size_t>(k)], 1e-9);
}

/// One model's innovation with so many sub-steps.
std::vector<double> InnovationWith(const Problem& problem, const AxisModel& model, int substeps) {
  FilterSetup setup = problem.setup;
  setup.substeps_rigid = setup.substeps_two = substeps;
  return RunFilter(setup, std::span(&model, 1), 1)[0].innovation;
}

// Two bodies and what couples them, without friction, under a torque that is constant over every row.
TEST(ForwardFilter, ACouplingMovesExactlyWithAnySubsteps) {
  test::HiddenOptions o;
  o.duration_s = 5.0;
  o.two_inertia = true;
  const test::HiddenAxis axis = test::MakeHiddenAxis(o);
  const Problem problem(axis.log, axis.stated, 1);
  AxisModel m = problem.Build(Stated(problem));
  m.delay_s = 2e-3;
  m.lag_s = 0.0;
  StatedFriction& f = m.friction;
  for (double* level : {&f.Fc_plus, &f.Fc_minus, &f.Fs_plus, &f.Fs_minus, &f.s0, &f.s1, &f.s2})
    *level *= 1e-9;
  // Swings, is damped to death, hardly is a coupling.
  for (const auto& [stiffness, damping] : {std::pair(1.0, 1.0), std::pair(1.0, 40.0), std::pair(1e-6, 0.0)}) {
    AxisModel with = m;
    with.stiffness *= stiffness;
    with.damping *= damping;
    const std::vector<double> one = InnovationWith(problem, with, 1),
                              many = InnovationWith(problem, with, 16), none(one.size(), 0.0);
    EXPECT_LT(test::Distance(one, many), 1e-6 * test::Distance(many, none)) << stiffness << " " << damping;
  }
}

// Contacts that begin and end inside a sub-step: four of them serve as eight times as many do.
TEST(ForwardFilter, AGapIsCrossedWithoutWaitingForTheSubstepsEnd) {
  test::HiddenOptions o;
  o.duration_s = 10.0;
  o.two_inertia = o.friction_on_load = true;
  const test::HiddenAxis axis = test::MakeHiddenAxis(o);
  const Problem problem(axis.log, axis.stated, 1);
  const AxisModel without = problem.Build(Stated(problem));
  // Small gaps are crossed all the time, and chaotic.
  for (const auto& [gap, share] : {std::pair(2e-3, 0.04), std::pair(5e-5, 0.5)}) {
    AxisModel with = without;
    with.gap = gap;
    const std::vector<double> few = InnovationWith(problem, with, 4),
                              many = InnovationWith(problem, with, 32);
    const double effect = test::Distance(many, InnovationWith(problem, without, 32));
    EXPECT_LT(test::Distance(few, many), share * effect) << gap;
  }
}

}  // namespace
}  // namespace contour::diagnosis
