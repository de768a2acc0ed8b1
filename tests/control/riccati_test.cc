#include "control/riccati.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <memory>

#include "tests/control/support/dense_qp.h"
#include "tests/control/support/random_problem.h"

namespace contour {
namespace {

using test::Condense;
using test::RandomProblem;

template <std::size_t Axes>
Eigen::VectorXd Stacked(std::size_t horizon, const typename Riccati<Axes>::Inputs& input) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(horizon * Axes));
  for (std::size_t j = 0; j < horizon; ++j) {
    for (std::size_t i = 0; i < Axes; ++i) x(static_cast<Eigen::Index>(j * Axes + i)) = input[j][i];
  }
  return x;
}

// Dense optimum with the held inputs as equality constraints.
template <std::size_t Axes>
Eigen::VectorXd DenseHeld(const QpProblem<Axes>& problem, const typename Riccati<Axes>::Holding& holding) {
  const test::DenseQp qp = Condense(problem);
  const Eigen::Index n = qp.gradient.size();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  Eigen::Index count = 0;
  for (std::size_t j = 0; j < problem.horizon; ++j) {
    for (std::size_t i = 0; i < Axes; ++i) {
      const auto at = static_cast<Eigen::Index>(j * Axes + i);
      if (holding[j].how[i] == Hold::kFree) continue;
      rows(count, at) = 1.0;
      if (holding[j].how[i] == Hold::kTied) rows(count, at - static_cast<Eigen::Index>(Axes)) = -1.0;
      right(count++) = holding[j].value[i];
    }
  }
  const double scale = qp.hessian.trace() / static_cast<double>(n);
  Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(n + count, n + count);
  kkt.topLeftCorner(n, n) = qp.hessian / scale;
  kkt.topRightCorner(n, count) = rows.topRows(count).transpose();
  kkt.bottomLeftCorner(count, n) = rows.topRows(count);
  Eigen::VectorXd b(n + count);
  b << -qp.gradient / scale, right.head(count);
  return kkt.fullPivLu().solve(b).head(n);
}

template <std::size_t Axes>
void CompareHeld(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  auto riccati = std::make_unique<Riccati<Axes>>();
  for (int n = 0; n < 100; ++n) {
    const std::size_t horizon = 2 + static_cast<std::size_t>(n) % 12;
    const QpProblem<Axes> problem = RandomProblem<Axes>(random, horizon, false);
    typename Riccati<Axes>::Holding holding{};
    for (std::size_t j = 0; j < horizon; ++j) {
      for (std::size_t i = 0; i < Axes; ++i) {
        const double dice = unit(random);
        holding[j].value[i] = unit(random) - 0.5;
        if (dice < 0.25) holding[j].how[i] = Hold::kFixed;
        if (dice > 0.6 && j > 0) holding[j].how[i] = Hold::kTied;
        // A fixed input fixes what is tied to it, as HoldActive sees to.
        if (j > 0 && holding[j].how[i] == Hold::kTied && holding[j - 1].how[i] == Hold::kFixed) {
          holding[j].how[i] = Hold::kFixed;
          holding[j].value[i] += holding[j - 1].value[i];
        }
      }
    }
    typename Riccati<Axes>::Inputs input{}, derivative{}, gradient{};
    riccati->Factor(problem, holding, horizon - 1);
    riccati->RollOut(problem, holding, input, derivative);
    const Eigen::VectorXd expected = DenseHeld(problem, holding);
    const Eigen::VectorXd found = Stacked<Axes>(horizon, input);
    EXPECT_LT((found - expected).template lpNorm<Eigen::Infinity>(), 1e-8 * (1.0 + expected.norm()));

    // The derivative by fixed inputs, and the gradient, against the dense form.
    const test::DenseQp qp = Condense(problem);
    const Eigen::VectorXd dense_gradient = qp.hessian * found + qp.gradient;
    Gradient<Axes>(problem, input, gradient);
    const double size = 1e-9 * (qp.hessian.norm() * found.norm() + qp.gradient.norm());
    for (std::size_t j = 0; j < horizon; ++j) {
      for (std::size_t i = 0; i < Axes; ++i) {
        const double dense = dense_gradient(static_cast<Eigen::Index>(j * Axes + i));
        EXPECT_NEAR(gradient[j][i], dense, size);
        if (holding[j].how[i] == Hold::kFixed) {
          EXPECT_NEAR(derivative[j][i], dense, size);
        } else {
          EXPECT_EQ(derivative[j][i], 0.0);
        }
      }
    }
  }
}

TEST(Riccati, HeldInputsAsInTheDenseProblemOneAxis) { CompareHeld<1>(1); }
TEST(Riccati, HeldInputsAsInTheDenseProblemTwoAxes) { CompareHeld<2>(2); }
TEST(Riccati, HeldInputsAsInTheDenseProblemThreeAxes) { CompareHeld<3>(3); }

TEST(Riccati, CostDiffersByTheDenseQuadraticForm) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int n = 0; n < 50; ++n) {
    const QpProblem<2> problem = RandomProblem<2>(random, 15, false);
    const test::DenseQp qp = Condense(problem);
    Riccati<2>::Inputs input{}, none{};
    for (auto& stage : input) {
      for (double& u : stage) u = unit(random);
    }
    const Eigen::VectorXd x = Stacked<2>(15, input);
    const double dense = 0.5 * x.dot(qp.hessian * x) + qp.gradient.dot(x);
    const double base = Cost<2>(problem, none);
    EXPECT_NEAR(Cost<2>(problem, input) - base, dense, 1e-9 * (std::abs(dense) + base));
  }
}

TEST(Riccati, FactoringAgainFromTheChangedStageIsEnough) {
  std::mt19937_64 random(5);
  const QpProblem<2> problem = RandomProblem<2>(random, 20, false);
  auto partly = std::make_unique<Riccati<2>>();
  auto wholly = std::make_unique<Riccati<2>>();
  Riccati<2>::Holding holding{};
  partly->Factor(problem, holding, 19);
  holding[7].how[1] = Hold::kFixed;
  holding[7].value[1] = 0.3;
  partly->Factor(problem, holding, 7);
  wholly->Factor(problem, holding, 19);
  Riccati<2>::Inputs a{}, b{}, gradient{};
  partly->RollOut(problem, holding, a, gradient);
  wholly->RollOut(problem, holding, b, gradient);
  for (std::size_t j = 0; j < 20; ++j) EXPECT_EQ(a[j], b[j]);
}

}  // namespace
}  // namespace contour
