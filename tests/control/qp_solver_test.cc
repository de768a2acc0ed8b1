#include "control/qp_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "tests/control/support/dense_qp.h"
#include "tests/control/support/interior_point.h"
#include "tests/control/support/random_problem.h"
#include "tests/support/allocation_guard.h"

#ifdef CONTOUR_HAVE_EIQUADPROG
#include "tests/control/support/eiquadprog_oracle.h"
#endif

namespace contour {
namespace {

using test::Condense;
using test::RandomProblem;

template <std::size_t Axes>
Eigen::VectorXd Stacked(const QpProblem<Axes>& problem, const typename QpSolver<Axes>::Inputs& input) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(problem.horizon * Axes));
  Eigen::Index row = 0;
  for (std::size_t j = 0; j < problem.horizon; ++j) {
    for (std::size_t i = 0; i < Axes; ++i) x(row++) = input[j][i];
  }
  return x;
}

template <std::size_t Axes>
double Width(const QpProblem<Axes>& problem) {
  return problem.stage[1].highest[0] - problem.stage[1].lowest[0];
}

// Largest violation of a bound, in units of the bounds' width.
template <std::size_t Axes>
double Violation(const test::DenseQp& dense, const QpProblem<Axes>& problem, const Eigen::VectorXd& x) {
  const Eigen::VectorXd rows = dense.constraint * x;
  return std::max((dense.lower - rows).maxCoeff(), (rows - dense.upper).maxCoeff()) / Width(problem);
}

double CostOf(const test::DenseQp& dense, const Eigen::VectorXd& x) {
  return 0.5 * x.dot(dense.hessian * x) + dense.gradient.dot(x);
}

struct Coverage {
  int problems = 0;
  int with_values = 0;
  int with_steps = 0;
  int mostly_active = 0;
};

// Solves random problems and compares with the oracle to 1e-6 of the bounds' width.
template <std::size_t Axes, class Oracle>
Coverage Compare(std::uint64_t seed, int count, std::size_t horizon, bool rate_limits, Oracle&& oracle) {
  std::mt19937_64 random(seed);
  auto solver = std::make_unique<QpSolver<Axes>>();
  Coverage coverage;
  for (int n = 0; n < count; ++n) {
    QpProblem<Axes> problem = RandomProblem<Axes>(random, horizon, rate_limits);
    const test::DenseQp dense = Condense(problem);
    typename QpSolver<Axes>::Active active{};
    typename QpSolver<Axes>::Inputs input{};
    const QpReport report = solver->Solve(problem, 500, active, input);
    EXPECT_EQ(report.status, QpStatus::kOptimal) << "problem " << n;
    const Eigen::VectorXd x = Stacked(problem, input);
    EXPECT_LT(Violation(dense, problem, x), 1e-9) << "problem " << n;
    const Eigen::VectorXd expected = oracle(dense);
    EXPECT_LT((x - expected).template lpNorm<Eigen::Infinity>() / Width(problem), 1e-6) << "problem " << n;
    std::size_t values = 0, steps = 0;
    for (std::size_t j = 0; j < horizon; ++j) {
      for (std::size_t i = 0; i < Axes; ++i) {
        values += active[j][i].value != 0 ? 1U : 0U;
        steps += active[j][i].step != 0 ? 1U : 0U;
      }
    }
    ++coverage.problems;
    coverage.with_values += values > 0 ? 1 : 0;
    coverage.with_steps += steps > 0 ? 1 : 0;
    coverage.mostly_active += values + steps > (9 * horizon * Axes) / 10 ? 1 : 0;
    if (::testing::Test::HasFailure()) return coverage;
  }
  return coverage;
}

TEST(QpSolver, AgreesWithAnInteriorPointMethod) {
  const auto oracle = [](const test::DenseQp& dense) {
    double gap = 1.0;
    Eigen::VectorXd x = test::SolveByInteriorPoint(dense, &gap);
    EXPECT_LT(gap, 1e-12);
    return x;
  };
  Compare<1>(1, 200, 20, false, oracle);
  Compare<1>(2, 200, 20, true, oracle);
  Compare<2>(3, 300, 10, false, oracle);
  Compare<2>(4, 300, 10, true, oracle);
  Compare<3>(5, 100, 6, true, oracle);
  Compare<2>(6, 30, 40, false, oracle);
}

#ifdef CONTOUR_HAVE_EIQUADPROG
TEST(QpSolver, AgreesWithEiquadprogOnTenThousandProblems) {
  const auto with = [](auto& oracle) {
    return [&oracle](const test::DenseQp& dense) {
      const std::optional<Eigen::VectorXd> x = oracle.Solve(dense);
      EXPECT_TRUE(x.has_value()) << "eiquadprog found no solution";
      return x.value_or(Eigen::VectorXd::Zero(dense.gradient.size()));
    };
  };
  auto values10 = std::make_unique<test::EiquadprogOracle<20, 20>>();
  auto steps10 = std::make_unique<test::EiquadprogOracle<20, 40>>();
  auto values20 = std::make_unique<test::EiquadprogOracle<40, 40>>();
  auto steps20 = std::make_unique<test::EiquadprogOracle<40, 80>>();
  Coverage all;
  const auto add = [&all](const Coverage& part) {
    all.problems += part.problems;
    all.with_values += part.with_values;
    all.with_steps += part.with_steps;
    all.mostly_active += part.mostly_active;
  };
  add(Compare<2>(11, 4000, 10, false, with(*values10)));
  add(Compare<2>(12, 3500, 10, true, with(*steps10)));
  add(Compare<2>(13, 1500, 20, false, with(*values20)));
  add(Compare<2>(14, 1000, 20, true, with(*steps20)));
  EXPECT_EQ(all.problems, 10000);
  // The problems must be worth comparing.
  EXPECT_GT(all.with_values, 1500);
  EXPECT_GT(all.with_steps, 1500);
  EXPECT_GT(all.mostly_active, 500);
}
#endif

TEST(QpSolver, FeasibleAndNeverWorseAtAnyCap) {
  std::mt19937_64 random(21);
  auto solver = std::make_unique<QpSolver<2>>();
  int capped = 0;
  for (int n = 0; n < 400; ++n) {
    const QpProblem<2> original = RandomProblem<2>(random, 20, n % 2 == 0);
    const test::DenseQp dense = Condense(original);
    // What a controller would send that clips to the bounds and looks no further: zero deviation where
    // allowed.
    double best_so_far = std::numeric_limits<double>::infinity();
    for (const int cap : {6, 8, 12, 20, 400}) {
      QpProblem<2> problem = original;
      QpSolver<2>::Active active{};
      QpSolver<2>::Inputs input{};
      const QpReport report = solver->Solve(problem, cap, active, input);
      EXPECT_LE(report.iterations, cap);
      capped += report.status == QpStatus::kCap ? 1 : 0;
      const Eigen::VectorXd x = Stacked(problem, input);
      ASSERT_TRUE(x.allFinite());
      EXPECT_LT(Violation(dense, original, x), 1e-9) << "problem " << n << " cap " << cap;
      const double cost = CostOf(dense, x);
      EXPECT_LE(cost, best_so_far + 1e-9 * std::abs(best_so_far)) << "problem " << n << " cap " << cap;
      best_so_far = cost;
    }
  }
  EXPECT_GT(capped, 100);  // the caps did bite
}

TEST(QpSolver, CapOfOneStillGivesAUsableInput) {
  std::mt19937_64 random(22);
  auto solver = std::make_unique<QpSolver<2>>();
  for (int n = 0; n < 400; ++n) {
    QpProblem<2> problem = RandomProblem<2>(random, 20, n % 2 == 0);
    const test::DenseQp dense = Condense(problem);
    QpSolver<2>::Active active{};
    QpSolver<2>::Inputs input{};
    solver->Solve(problem, 1, active, input);
    const Eigen::VectorXd x = Stacked(problem, input);
    ASSERT_TRUE(x.allFinite());
    EXPECT_LT(Violation(dense, problem, x), 1e-9);
  }
}

TEST(QpSolver, AnyGuessLeadsToTheSameSolution) {
  std::mt19937_64 random(23);
  std::uniform_int_distribution<int> side(-1, 1);
  auto solver = std::make_unique<QpSolver<2>>();
  for (int n = 0; n < 200; ++n) {
    QpProblem<2> problem = RandomProblem<2>(random, 15, n % 2 == 0);
    QpSolver<2>::Active cold{}, wild{};
    for (auto& stage : wild) {
      for (ActiveBounds& bound : stage) {
        bound.value = static_cast<std::int8_t>(side(random));
        if (n % 2 == 0) bound.step = static_cast<std::int8_t>(side(random));
      }
    }
    QpSolver<2>::Inputs from_cold{}, from_wild{};
    QpProblem<2> again = problem;
    ASSERT_EQ(solver->Solve(problem, 500, cold, from_cold).status, QpStatus::kOptimal);
    ASSERT_EQ(solver->Solve(again, 500, wild, from_wild).status, QpStatus::kOptimal);
    const double apart = (Stacked(problem, from_cold) - Stacked(again, from_wild)).lpNorm<Eigen::Infinity>();
    EXPECT_LT(apart / Width(problem), 1e-8) << "problem " << n;
  }
}

TEST(QpSolver, TheSolutionsOwnBoundsAreAPerfectGuess) {
  std::mt19937_64 random(24);
  auto solver = std::make_unique<QpSolver<2>>();
  for (int n = 0; n < 200; ++n) {
    QpProblem<2> problem = RandomProblem<2>(random, 20, n % 2 == 0);
    QpSolver<2>::Active active{};
    QpSolver<2>::Inputs input{};
    ASSERT_EQ(solver->Solve(problem, 500, active, input).status, QpStatus::kOptimal);
    EXPECT_EQ(solver->Solve(problem, 500, active, input).iterations, 1) << "problem " << n;
  }
}

TEST(QpSolver, StepOutOfReachGivesWayToTheValueBound) {
  std::mt19937_64 random(25);
  QpProblem<1> problem = RandomProblem<1>(random, 10, true);
  const double highest = problem.stage[0].highest[0];
  problem.previous[0] = highest + 100.0 * Width(problem);  // no step leads back at once
  auto solver = std::make_unique<QpSolver<1>>();
  QpSolver<1>::Active active{};
  QpSolver<1>::Inputs input{};
  EXPECT_EQ(solver->Solve(problem, 100, active, input).status, QpStatus::kOptimal);
  EXPECT_DOUBLE_EQ(input[0][0], highest);
}

TEST(QpSolver, DoesNotTouchTheHeap) {
  if (!test::AllocationGuard::kAvailable) GTEST_SKIP() << "the sanitizer owns the heap";
  std::mt19937_64 random(26);
  auto solver = std::make_unique<QpSolver<2>>();
  for (int n = 0; n < 50; ++n) {
    QpProblem<2> problem = RandomProblem<2>(random, 20, n % 2 == 0);
    QpSolver<2>::Active active{};
    QpSolver<2>::Inputs input{};
    const test::AllocationGuard guard;
    solver->Solve(problem, 500, active, input);
    EXPECT_EQ(guard.calls(), 0u);
  }
}

}  // namespace
}  // namespace contour
