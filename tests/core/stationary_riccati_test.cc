#include "core/stationary_riccati.h"

#include <gtest/gtest.h>

#include <cmath>

namespace contour {
namespace {

double Residual(const SmallMatrix& x, const SmallMatrix& a, const SmallMatrix& b, const SmallMatrix& q,
                const SmallMatrix& r) {
  const SmallMatrix left = a.transpose() * x * b;
  const SmallMatrix denominator = r + b.transpose() * x * b;
  const SmallMatrix next = a.transpose() * x * a - left * denominator.ldlt().solve(left.transpose()) + q;
  return (next - x).cwiseAbs().maxCoeff() / x.cwiseAbs().maxCoeff();
}

TEST(SolveRiccati, AgreesWithTheScalarFormula) {
  // x = x - x^2 / (1 + x) + 1: the golden ratio.
  const SmallMatrix one = SmallMatrix::Constant(1, 1, 1.0);
  const auto x = SolveRiccati(one, one, one, one);
  ASSERT_TRUE(x);
  EXPECT_NEAR((*x)(0, 0), 0.5 * (1.0 + std::sqrt(5.0)), 1e-14);
}

TEST(SolveRiccati, AgreesWithScipy) {
  // scipy.linalg.solve_discrete_are([[1, .1, 0], [0, 1.02, .1], [0, -.3, .9]], [[0], [.01], [.1]],
  //                                 diag([1, 0, .1]), [[.5]])
  SmallMatrix a(3, 3), b(3, 1), q = SmallMatrix::Zero(3, 3);
  a << 1, .1, 0, 0, 1.02, .1, 0, -.3, .9;
  b << 0, .01, .1;
  q.diagonal() << 1, 0, .1;
  const SmallMatrix r = SmallMatrix::Constant(1, 1, 0.5);
  const auto x = SolveRiccati(a, b, q, r);
  ASSERT_TRUE(x);
  SmallMatrix expected(3, 3);
  expected << 22.91649078501169, 11.634101863020309, 6.211263959684096, 11.634101863020309,
      10.574028260162672, 4.135533657170624, 6.211263959684096, 4.135533657170624, 3.452971745440744;
  EXPECT_LT((*x - expected).cwiseAbs().maxCoeff(), 1e-9 * expected.cwiseAbs().maxCoeff());
  EXPECT_LT(Residual(*x, a, b, q, r), 1e-12);
}

TEST(SolveRiccati, SaysWhenAModeCannotBeReached) {
  // The second state grows, and no input touches it.
  SmallMatrix a(2, 2), b(2, 1);
  a << 0.5, 0, 0, 1.1;
  b << 1, 0;
  EXPECT_FALSE(SolveRiccati(a, b, SmallMatrix::Identity(2, 2), SmallMatrix::Identity(1, 1)));
}

}  // namespace
}  // namespace contour
