#include "analysis/diagnosis/decision/chi_square.h"

#include <gtest/gtest.h>

#include <cstddef>

namespace contour::diagnosis {
namespace {

struct Quantile {
  std::size_t degrees;
  double probability, value;
};

// Pearson and Hartley, Biometrika Tables for Statisticians, table 8; 0.2 % by scipy.stats.chi2.isf.
constexpr Quantile kTable[] = {{1, 0.05, 3.841459},   {1, 0.002, 9.549536},  {2, 0.05, 5.991465},
                               {2, 0.002, 12.429216}, {3, 0.05, 7.814728},   {3, 0.002, 14.795517},
                               {4, 0.01, 13.276704},  {10, 0.05, 18.307038}, {60, 0.001, 99.607233}};

TEST(ChiSquareQuantile, IsThatOfTheTables) {
  for (const Quantile& q : kTable)
    EXPECT_NEAR(ChiSquareQuantile(q.degrees, q.probability), q.value, 1e-5)
        << q.degrees << " degrees at " << q.probability;
}

}  // namespace
}  // namespace contour::diagnosis
