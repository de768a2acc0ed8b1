#include "design/spectral_radius.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace contour {
namespace {

// A search for loops asks for the eigenvalues of thousands of matrices of some twenty rows, and for nothing
// else of them. With that in mind only rows and columns of the part that is still coupled are turned, as
// EISPACK's hqr does (Martin, Peters and Wilkinson, Numerische Mathematik 14, 1970); Eigen turns all of the
// matrix, and took more than twice as long.
using Rows = std::array<std::array<double, kMostClosedStates>, kMostClosedStates>;
constexpr int kMostStepsPerRow = 40;  // of all rows together, as in Eigen
constexpr int kUnusualShift = 10;     // after so many steps for one eigenvalue

bool IsNothingBeside(double small, double large) { return large + small == large; }

double WithSignOf(double magnitude, double sign) { return std::copysign(magnitude, sign); }

/// To Hessenberg form by reflections.
void Reduce(Rows& h, std::size_t n) {
  std::array<double, kMostClosedStates> v{}, onto{};
  for (std::size_t k = 0; k + 2 < n; ++k) {
    double below = 0.0;
    for (std::size_t i = k + 2; i < n; ++i) below += h[i][k] * h[i][k];
    if (below == 0.0) continue;
    const double head = h[k + 1][k];
    const double length = WithSignOf(std::sqrt(head * head + below), head);
    for (std::size_t i = k + 1; i < n; ++i) v[i] = h[i][k];
    v[k + 1] += length;
    const double scale = 1.0 / (length * v[k + 1]);
    h[k + 1][k] = -length;
    for (std::size_t i = k + 2; i < n; ++i) h[i][k] = 0.0;
    std::fill(onto.begin(), onto.end(), 0.0);
    for (std::size_t i = k + 1; i < n; ++i)
      for (std::size_t j = k + 1; j < n; ++j) onto[j] += v[i] * h[i][j];
    for (std::size_t i = k + 1; i < n; ++i)
      for (std::size_t j = k + 1; j < n; ++j) h[i][j] -= scale * v[i] * onto[j];
    for (std::size_t i = 0; i < n; ++i) {
      double along = 0.0;
      for (std::size_t j = k + 1; j < n; ++j) along += h[i][j] * v[j];
      for (std::size_t j = k + 1; j < n; ++j) h[i][j] -= scale * along * v[j];
    }
  }
}

/// Shifts of a double step, by their sum and product of the lowest two rows: x and y are the diagonal, w what
/// couples them.
struct Shift {
  double x, y, w;
};

/// The first column of the shifted square, in the rows from `row` on.
struct Column {
  std::size_t row;
  double p, q, r;
};

/// Where the double step may begin: as low as two small numbers under the diagonal allow.
Column Begin(const Rows& h, std::size_t first, std::size_t last, const Shift& shift) {
  for (std::size_t m = last - 2;; --m) {
    const double z = h[m][m], r0 = shift.x - z, s0 = shift.y - z;
    double p = (r0 * s0 - shift.w) / h[m + 1][m] + h[m][m + 1];
    double q = h[m + 1][m + 1] - z - r0 - s0;
    double r = h[m + 2][m + 1];
    const double size = std::fabs(p) + std::fabs(q) + std::fabs(r);
    p /= size;
    q /= size;
    r /= size;
    if (m == first) return {m, p, q, r};
    const double left = std::fabs(h[m][m - 1]) * (std::fabs(q) + std::fabs(r));
    const double around = std::fabs(h[m - 1][m - 1]) + std::fabs(z) + std::fabs(h[m + 1][m + 1]);
    if (IsNothingBeside(left, std::fabs(p) * around)) return {m, p, q, r};
  }
}

/// A reflection: what is taken of each of three rows, and what they count for beside the first.
struct Reflection {
  double x, y, z, q, r;
};

/// Of three rows and columns (of two at the end), within the coupled part alone.
void Turn(Rows& h, std::size_t k, std::size_t first, std::size_t last, const Reflection& by) {
  const auto [x, y, z, q, r] = by;
  const bool three = k + 1 != last;
  double* const a = h[k].data();
  double* const b = h[k + 1].data();
  if (three) {
    double* const c = h[k + 2].data();
#pragma GCC ivdep  // they are rows of one matrix, each to itself
    for (std::size_t j = k; j <= last; ++j) {
      const double sum = a[j] + q * b[j] + r * c[j];
      a[j] -= sum * x;
      b[j] -= sum * y;
      c[j] -= sum * z;
    }
  } else {
#pragma GCC ivdep  // as above
    for (std::size_t j = k; j <= last; ++j) {
      const double sum = a[j] + q * b[j];
      a[j] -= sum * x;
      b[j] -= sum * y;
    }
  }
  for (std::size_t i = first; i <= std::min(last, k + 3); ++i) {
    double* const row = h[i].data() + k;
    double sum = x * row[0] + y * row[1];
    if (three) {
      sum += z * row[2];
      row[2] -= sum * r;
    }
    row[1] -= sum * q;
    row[0] -= sum;
  }
}

void DoubleStep(Rows& h, std::size_t first, std::size_t last, const Shift& shift) {
  auto [m, p, q, r] = Begin(h, first, last, shift);
  for (std::size_t i = m + 2; i <= last; ++i) {
    h[i][i - 2] = 0.0;
    if (i != m + 2) h[i][i - 3] = 0.0;
  }
  for (std::size_t k = m; k < last; ++k) {
    double size = 1.0;
    if (k != m) {
      p = h[k][k - 1];
      q = h[k + 1][k - 1];
      r = k + 1 != last ? h[k + 2][k - 1] : 0.0;
      size = std::fabs(p) + std::fabs(q) + std::fabs(r);
      if (size == 0.0) continue;
      p /= size;
      q /= size;
      r /= size;
    }
    const double s = WithSignOf(std::sqrt(p * p + q * q + r * r), p);
    if (s == 0.0) continue;
    if (k != m)
      h[k][k - 1] = -s * size;
    else if (first != m)
      h[k][k - 1] = -h[k][k - 1];
    p += s;
    Turn(h, k, first, last, {p / s, q / s, r / s, q / p, r / p});
  }
}

/// The larger magnitude of the two eigenvalues of the rows last - 1 and last.
double LargerOfTwo(const Rows& h, std::size_t last, double shifted) {
  const double x = h[last][last], y = h[last - 1][last - 1], w = h[last][last - 1] * h[last - 1][last];
  const double p = 0.5 * (y - x), q = p * p + w, root = std::sqrt(std::fabs(q)), at = x + shifted;
  if (q < 0.0) return std::hypot(at + p, root);
  const double z = p + WithSignOf(root, p);
  return std::max(std::fabs(at + z), std::fabs(z != 0.0 ? at - w / z : at + z));
}

}  // namespace

double SpectralRadius(const LoopMatrix& matrix) {
  const auto n = static_cast<std::size_t>(matrix.rows());
  Rows h{};
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      h[i][j] = matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  const double norm = matrix.cwiseAbs().sum();
  if (!std::isfinite(norm)) return std::numeric_limits<double>::infinity();
  // What a queue leaves behind are eigenvalues of nothing, of which rounding makes a cluster that never
  // parts.
  const double nothing =
      norm * std::numeric_limits<double>::epsilon() * std::numeric_limits<double>::epsilon();
  Reduce(h, n);
  double largest = 0.0, shifted = 0.0;
  int steps = 0;
  std::size_t all_steps = 0;
  for (std::size_t left = n; left > 0;) {  // rows whose eigenvalues are not known yet
    const std::size_t last = left - 1;
    std::size_t first = last;
    for (; first > 0; --first) {
      const double diagonal = std::fabs(h[first - 1][first - 1]) + std::fabs(h[first][first]);
      const double below = std::fabs(h[first][first - 1]);
      if (below <= nothing || IsNothingBeside(below, diagonal)) break;
    }
    if (first == last || first + 1 == last) {
      largest = std::max(largest,
                         first == last ? std::fabs(h[last][last] + shifted) : LargerOfTwo(h, last, shifted));
      left = first;
      steps = 0;
      continue;
    }
    if (all_steps++ == kMostStepsPerRow * n) return std::numeric_limits<double>::infinity();
    Shift shift{h[last][last], h[last - 1][last - 1], h[last][last - 1] * h[last - 1][last]};
    if (steps > 0 && steps % kUnusualShift == 0) {
      shifted += shift.x;
      for (std::size_t i = 0; i <= last; ++i) h[i][i] -= shift.x;
      const double size = std::fabs(h[last][last - 1]) + std::fabs(h[last - 1][last - 2]);
      shift = {0.75 * size, 0.75 * size, -0.4375 * size * size};
    }
    ++steps;
    DoubleStep(h, first, last, shift);
  }
  return largest;
}

}  // namespace contour
