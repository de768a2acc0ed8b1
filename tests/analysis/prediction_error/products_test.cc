#include "analysis/prediction_error/products.h"

#include <gtest/gtest.h>

#include <random>

namespace contour::diagnosis {
namespace {

Eigen::MatrixXd Noise(Eigen::Index rows, Eigen::Index columns) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

// More columns than one batch takes, and a length that is no multiple of the lanes.
TEST(Products, AreThoseOfTheMatrices) {
  const Eigen::MatrixXd a = Noise(1003, 37), b = Noise(1003, 41);
  const Eigen::MatrixXd got = ProductsOf(ColumnsOf(a), ColumnsOf(b), 1003);
  EXPECT_LT((got - a.transpose() * b).norm(), 1e-10);
}

TEST(Products, ColumnsBeginWhereTheMatrixHasThem) {
  const Eigen::MatrixXd a = Noise(5, 3);
  const auto columns = ColumnsOf(a);
  ASSERT_EQ(columns.size(), 3U);
  EXPECT_EQ(columns[2][1], a(1, 2));
}

TEST(Products, AddedColumnsCompleteTheNormalMatrix) {
  const Eigen::MatrixXd j = Noise(500, 9);
  Eigen::MatrixXd normal = j.leftCols(6).transpose() * j.leftCols(6);
  AddProducts(j, 6, normal);
  EXPECT_LT((normal - j.transpose() * j).norm(), 1e-10);
  EXPECT_LT((normal - normal.transpose()).norm(), 1e-12);
}

TEST(Products, TheGradientIsJacobianTimesResidual) {
  const Eigen::MatrixXd j = Noise(300, 4), r = Noise(300, 1);
  const std::vector<double> residual(r.data(), r.data() + r.size());
  EXPECT_LT((GradientOf(j, residual) - j.transpose() * r.col(0)).norm(), 1e-11);
}

TEST(Products, BlocksTogetherAreTheWhole) {
  const Eigen::MatrixXd a = Noise(600, 3), b = Noise(600, 2), r = Noise(600, 1);
  const ProductsInBlocks blocks = MakeProductsInBlocks(ColumnsOf(a), ColumnsOf(b), r.data(), 300, 600, 7);
  EXPECT_LT((blocks.products - a.transpose() * b).norm(), 1e-10);
  EXPECT_LT((blocks.with_r.rowwise().sum() - b.transpose() * r.col(0)).norm(), 1e-10);
  // The first block of the second run goes to the first block.
  const Eigen::Index rows = 300 / 7;
  const Eigen::VectorXd first = b.topRows(rows).transpose() * r.col(0).head(rows) +
                                b.middleRows(300, rows).transpose() * r.col(0).segment(300, rows);
  EXPECT_LT((blocks.with_r.col(0) - first).norm(), 1e-11);
}

}  // namespace
}  // namespace contour::diagnosis
