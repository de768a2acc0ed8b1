#include "analysis/prediction_error/products.h"

#include <algorithm>

#include "analysis/prediction_error/simd/lane_linear.h"
#include "analysis/prediction_error/simd/lane_loops.h"

namespace contour::diagnosis {

Eigen::MatrixXd ProductsOf(std::span<const double* const> a, std::span<const double* const> b,
                           std::size_t size) {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(a.size()), static_cast<Eigen::Index>(b.size()));
  std::vector<double> part(kMostProducts * kMostProducts);
  for (std::size_t i = 0; i < a.size(); i += kMostProducts)
    for (std::size_t j = 0; j < b.size(); j += kMostProducts) {
      LaneProducts m;
      m.size = size;
      const std::size_t rows = std::min(kMostProducts, a.size() - i),
                        columns = std::min(kMostProducts, b.size() - j);
      m.a_count = rows;
      m.b_count = columns;
      m.a = a.data() + i;
      m.b = b.data() + j;
      m.out = part.data();
      m.alike = rows == columns && std::equal(m.a, m.a + rows, m.b);
      BestLoops().products(m);
      for (std::size_t r = 0; r < rows; ++r)
        for (std::size_t c = 0; c < columns; ++c)
          out(static_cast<Eigen::Index>(i + r), static_cast<Eigen::Index>(j + c)) =
              part[m.alike && c < r ? c * columns + r : r * columns + c];
    }
  return out;
}

ProductsInBlocks MakeProductsInBlocks(std::span<const double* const> a, std::span<const double* const> b,
                                      const double* r, std::size_t rows, std::size_t size,
                                      std::size_t blocks) {
  const auto count = static_cast<Eigen::Index>(a.size()), columns = static_cast<Eigen::Index>(b.size());
  ProductsInBlocks out{Eigen::MatrixXd::Zero(count, columns),
                       Eigen::MatrixXd::Zero(columns, static_cast<Eigen::Index>(blocks))};
  std::vector<const double*> left(a.begin(), a.end()), right(b.begin(), b.end());
  left.push_back(r);
  for (std::size_t base = 0; base < size; base += rows)
    for (std::size_t i = 0; i < blocks; ++i) {
      const std::size_t from = base + rows * i / blocks, to = base + rows * (i + 1) / blocks;
      for (std::size_t c = 0; c < left.size(); ++c) left[c] = (c < a.size() ? a[c] : r) + from;
      for (std::size_t c = 0; c < right.size(); ++c) right[c] = b[c] + from;
      const Eigen::MatrixXd part = ProductsOf(left, right, to - from);
      out.products += part.topRows(count);
      out.with_r.col(static_cast<Eigen::Index>(i)) += part.row(count).transpose();
    }
  return out;
}

std::vector<const double*> ColumnsOf(const Eigen::MatrixXd& j) {
  std::vector<const double*> out;
  for (Eigen::Index i = 0; i < j.cols(); ++i) out.push_back(j.col(i).data());
  return out;
}

void AddProducts(const Eigen::MatrixXd& j, Eigen::Index from, Eigen::MatrixXd& normal) {
  const std::vector<const double*> columns = ColumnsOf(j);
  const Eigen::Index count = j.cols() - from;
  const Eigen::MatrixXd products =
      ProductsOf(columns, std::span(columns).subspan(static_cast<std::size_t>(from)),
                 static_cast<std::size_t>(j.rows()));
  normal.conservativeResize(j.cols(), j.cols());
  normal.rightCols(count) = products;
  normal.bottomRows(count) = products.transpose();
}

Eigen::VectorXd GradientOf(const Eigen::MatrixXd& j, const std::vector<double>& r) {
  const double* one[] = {r.data()};
  return ProductsOf(ColumnsOf(j), one, r.size());
}

}  // namespace contour::diagnosis
