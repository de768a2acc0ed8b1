#include "design/loop_plant.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>
#include <utility>

#include "core/wide_vectors.h"

namespace contour {
namespace {

using Index = Eigen::Index;

constexpr Index kStates = 6;  // p1 v1 p2 v2 u z, then position and velocity of each part that swings
// A drive without a lag has one of a thousandth of the period, as in core/two_inertia_loop.cc.
constexpr double kLeastLag = 1e-3;

/// Parts of the table on springs beside the screw. Their masses are the table's: its acceleration, which was
/// that of all of it, becomes that of what is left.
void AddSideModes(const LoopMember& m, double period_s, LoopMatrix& rate) {
  double left = 1.0;
  for (const SideMode& mode : m.side_modes) left -= mode.mass_share_rel;
  rate.row(3) /= left;
  for (std::size_t i = 0; i < m.side_modes.size(); ++i) {
    const SideMode& mode = m.side_modes[i];
    const Index p = kStates + 2 * static_cast<Index>(i), v = p + 1;
    const double omega = 2.0 * std::numbers::pi * mode.frequency_Hz * period_s;
    const double k = omega * omega, c = 2.0 * mode.damping_ratio * omega;
    const double on_table = mode.mass_share_rel / left;
    rate(p, v) = 1.0;
    rate(v, 2) = k;
    rate(v, 3) = c;
    rate(v, p) = -k;
    rate(v, v) = -c;
    rate(3, 2) -= on_table * k;
    rate(3, 3) -= on_table * c;
    rate(3, p) += on_table * k;
    rate(3, v) += on_table * c;
  }
}

Index StatesOf(const LoopMember& m) { return kStates + 2 * static_cast<Index>(m.side_modes.size()); }

/// Exact motion over a share of a period; columns after the states: command, force on the table. Time in
/// periods, lengths in metres, forces in `force_N`.
LoopMatrix Over(const LoopMember& m, double period_s, double force_N, double share) {
  const TwoInertiaAxis& a = m.axis;
  const double t2 = period_s * period_s;
  const double k1 = a.stiffness_N_m * t2 / a.motor_mass_kg, k2 = a.stiffness_N_m * t2 / a.table_mass_kg;
  const double c1 = a.damping_Ns_m * period_s / a.motor_mass_kg;
  const double c2 = a.damping_Ns_m * period_s / a.table_mass_kg;
  const double f1 = force_N * t2 / a.motor_mass_kg, f2 = force_N * t2 / a.table_mass_kg;
  const TableBristle& b = m.bristle;
  // At rest the bristle's state is the table's position; what would be its own would never move. It dies out
  // unheard, as where there is no bristle.
  const bool sticks = b.decay_1_s <= 0.0;
  const double by_state = sticks ? 0.0 : b.stiffness_N_m - b.damping_Ns_m * b.decay_1_s;
  const double by_position = sticks ? b.stiffness_N_m * b.rate : 0.0;
  const double decay = sticks ? 1.0 : b.decay_1_s * period_s;
  const Index command = StatesOf(m), force = command + 1;
  LoopMatrix rate = LoopMatrix::Zero(force + 1, force + 1);
  rate(0, 1) = 1.0;
  rate.row(1).head(5) << -k1 - m.motor_hold_N_m * t2 / a.motor_mass_kg, -c1, k1, c1, f1;
  rate(2, 3) = 1.0;
  rate.row(3).head(6) << k2, c2, -k2 - by_position * t2 / a.table_mass_kg,
      -c2 - (a.viscous_Ns_m + b.damping_Ns_m * b.rate) * period_s / a.table_mass_kg, 0.0,
      -by_state * t2 / a.table_mass_kg;
  rate(3, force) = -f2;
  AddSideModes(m, period_s, rate);
  const double lag = std::max(a.lag_s / period_s, kLeastLag);
  rate(4, 4) = -1.0 / lag;
  rate(4, command) = 1.0 / lag;
  rate(5, 3) = sticks ? 0.0 : b.rate;
  rate(5, 5) = -decay;
  const LoopMatrix scaled = rate * share;
  return scaled.exp();
}

Eigen::MatrixXcd Resolvent(const LinearSystem& s, double frequency, const Eigen::MatrixXcd& right) {
  Eigen::MatrixXcd shifted = -s.a.cast<Complex>();
  shifted.diagonal().array() += std::polar(1.0, 2.0 * std::numbers::pi * frequency);
  return shifted.partialPivLu().solve(right);
}

/// States of the controller: the motion, b, d, the queue, two of the torque filter.
constexpr Index kMotion = kLoopMotion, kBias = kMotion, kForce = kBias + 1, kQueue = kForce + 1;

/// Forces in units of force_N, so that all states are of a size.
double UnitOf(Index state, double force_N) { return state == 4 || state == kForce ? force_N : 1.0; }

/// The observer's step to the next sample: over the states, and over the command.
std::pair<LoopMatrix, LoopMatrix> Prediction(const TwoInertiaLoop& loop, double force_N, Index n) {
  const auto queued = static_cast<Index>(loop.queued);
  LoopMatrix next = LoopMatrix::Zero(n, n), from_command = LoopMatrix::Zero(n, 1);
  for (Index i = 0; i < kMotion; ++i) {
    const auto row = static_cast<std::size_t>(i);
    const double unit = UnitOf(i, force_N);
    for (Index j = 0; j < kMotion; ++j)
      next(i, j) = loop.motion_from_motion[row][static_cast<std::size_t>(j)] * UnitOf(j, force_N) / unit;
    next(i, kForce) = loop.motion_from_disturbance[row] * force_N / unit;
    for (Index j = 0; j < 2; ++j) {
      const double value = loop.motion_from_input[static_cast<std::size_t>(j)][row] * force_N / unit;
      if (j < queued)
        next(i, kQueue + j) = value;
      else if (j == queued)
        from_command(i, 0) += value;
    }
  }
  next(kBias, kBias) = next(kForce, kForce) = 1.0;
  for (Index i = 0; i + 1 < queued; ++i) next(kQueue + i, kQueue + i + 1) = 1.0;
  if (queued > 0) from_command(kQueue + queued - 1, 0) = 1.0;
  return {next, from_command};
}

/// A system whose matrix is of Hessenberg form, with two inputs and one output.
struct HessenbergSystem {
  LoopMatrix a, b, c;
};

/// Frequencies side by side, as the vectors of the processor take them.
constexpr std::size_t kLanes = 4;
using Lane = std::array<double, kLanes>;
constexpr std::size_t kMostColumns = kMostClosedStates + 2;
using LaneRow = std::array<Lane, kMostColumns>;

/// Rows i and i + 1 of (z - a | b): what stands under the diagonal goes, with the larger of the two pivots on
/// it.
CONTOUR_WIDE_VECTORS void EliminateBelow(std::size_t i, std::size_t columns, LaneRow& upper_re,
                                         LaneRow& upper_im, LaneRow& lower_re, LaneRow& lower_im) {
  Lane factor_re, factor_im, swaps;
  for (std::size_t l = 0; l < kLanes; ++l) {
    const double a = upper_re[i][l], b = upper_im[i][l], c = lower_re[i][l], d = lower_im[i][l];
    const double upper2 = a * a + b * b, lower2 = c * c + d * d;
    const bool swap = lower2 > upper2;
    swaps[l] = swap ? 1.0 : 0.0;
    const double most2 = swap ? lower2 : upper2;
    // The smaller over the larger: conjugate where they change places.
    factor_re[l] = (c * a + d * b) / most2;
    factor_im[l] = (swap ? b * c - a * d : d * a - c * b) / most2;
  }
  for (std::size_t k = i; k < columns; ++k)
    for (std::size_t l = 0; l < kLanes; ++l) {
      const bool swap = swaps[l] != 0.0;
      const double up_re = swap ? lower_re[k][l] : upper_re[k][l],
                   up_im = swap ? lower_im[k][l] : upper_im[k][l];
      const double low_re = swap ? upper_re[k][l] : lower_re[k][l],
                   low_im = swap ? upper_im[k][l] : lower_im[k][l];
      upper_re[k][l] = up_re;
      upper_im[k][l] = up_im;
      lower_re[k][l] = low_re - (factor_re[l] * up_re - factor_im[l] * up_im);
      lower_im[k][l] = low_im - (factor_re[l] * up_im + factor_im[l] * up_re);
    }
}

/// From the last row up: x_i of one column on the right, into its place.
CONTOUR_WIDE_VECTORS void Substitute(std::size_t n, std::size_t right,
                                     std::array<LaneRow, kMostClosedStates>& re,
                                     std::array<LaneRow, kMostClosedStates>& im) {
  for (std::size_t i = n; i-- > 0;) {
    Lane x_re = re[i][right], x_im = im[i][right];
    for (std::size_t k = i + 1; k < n; ++k)
      for (std::size_t l = 0; l < kLanes; ++l) {
        x_re[l] -= re[i][k][l] * re[k][right][l] - im[i][k][l] * im[k][right][l];
        x_im[l] -= re[i][k][l] * im[k][right][l] + im[i][k][l] * re[k][right][l];
      }
    for (std::size_t l = 0; l < kLanes; ++l) {
      const double a = re[i][i][l], b = im[i][i][l], size2 = a * a + b * b;
      re[i][right][l] = (x_re[l] * a + x_im[l] * b) / size2;
      im[i][right][l] = (x_im[l] * a - x_re[l] * b) / size2;
    }
  }
}

/// c (z - a)^-1 b of both inputs at z = cosine + i sine.
void RespondInLanes(const HessenbergSystem& s, const Lane& cosine, const Lane& sine,
                    std::array<Lane, 2>& real, std::array<Lane, 2>& imaginary) {
  const auto n = static_cast<std::size_t>(s.a.rows());
  std::array<LaneRow, kMostClosedStates> re, im;
  for (std::size_t i = 0; i < n; ++i) {
    const auto row = static_cast<Index>(i);
    for (std::size_t k = i > 0 ? i - 1 : 0; k < n + 2; ++k) {
      re[i][k].fill(k < n ? -s.a(row, static_cast<Index>(k)) : s.b(row, static_cast<Index>(k - n)));
      im[i][k].fill(0.0);
    }
    for (std::size_t l = 0; l < kLanes; ++l) re[i][i][l] += cosine[l];
    im[i][i] = sine;
  }
  for (std::size_t i = 0; i + 1 < n; ++i) EliminateBelow(i, n + 2, re[i], im[i], re[i + 1], im[i + 1]);
  for (std::size_t j = 0; j < 2; ++j) {
    Substitute(n, n + j, re, im);
    real[j].fill(0.0);
    imaginary[j].fill(0.0);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t l = 0; l < kLanes; ++l) {
        real[j][l] += s.c(0, static_cast<Index>(i)) * re[i][n + j][l];
        imaginary[j][l] += s.c(0, static_cast<Index>(i)) * im[i][n + j][l];
      }
  }
}

}  // namespace

LoopPlant MakePlant(const LoopMember& m, double period_s, double force_N) {
  const double delay = std::max(0.0, m.axis.delay_cycles + m.axis.dead_time_s / period_s);
  const double whole = std::floor(delay + 1e-9);
  const double rest = delay - whole > 1e-9 ? delay - whole : 0.0;
  const Index queued = static_cast<Index>(whole) + (rest > 0.0 ? 1 : 0);
  const Index states = StatesOf(m);
  const LoopMatrix all = Over(m, period_s, force_N, 1.0);
  const LoopMatrix second = Over(m, period_s, force_N, 1.0 - rest);
  LoopMatrix input = LoopMatrix::Zero(states, 2);
  input.col(rest > 0.0 ? 1 : 0) = second.block(0, states, states, 1);
  if (rest > 0.0)
    input.col(0) =
        second.block(0, 0, states, states) * Over(m, period_s, force_N, rest).block(0, states, states, 1);

  const Index n = states + queued;
  LoopPlant plant;
  plant.force_N = force_N;
  LinearSystem& s = plant.system;
  s.a = LoopMatrix::Zero(n, n);
  s.b = LoopMatrix::Zero(n, 2);
  s.c = LoopMatrix::Zero(2, n);
  s.d = LoopMatrix::Zero(2, 2);
  s.a.topLeftCorner(states, states) = all.topLeftCorner(states, states);
  for (Index i = 0; i < 2; ++i) {
    if (i < queued)
      s.a.block(0, states + i, states, 1) = input.col(i);
    else if (i == queued)
      s.b.block(0, 0, states, 1) += input.col(i);
  }
  for (Index i = 0; i + 1 < queued; ++i) s.a(states + i, states + i + 1) = 1.0;
  if (queued > 0) s.b(n - 1, 0) = 1.0;
  s.b.block(0, 1, states, 1) = all.block(0, states + 1, states, 1);
  s.c(0, 0) = s.c(1, 2) = 1.0;
  return plant;
}

LinearSystem MakeController(const TwoInertiaLoop& loop, double force_N) {
  const auto queued = static_cast<Index>(loop.queued);
  const Index filter = kQueue + queued, n = filter + 2;

  // After the correction: rows of motion, b and d over the states before it and over y.
  LoopMatrix on_state = LoopMatrix::Identity(n, n), on_y = LoopMatrix::Zero(n, 2);
  for (std::size_t i = 0; i < kObserverStates; ++i) {
    const auto row = static_cast<Index>(i);
    const double scale = UnitOf(row, force_N);
    for (Index j = 0; j < 2; ++j) on_y(row, j) = loop.gain[i][static_cast<std::size_t>(j)] / scale;
  }
  on_state.col(0) -= on_y.col(0);
  on_state.col(kBias) -= on_y.col(0);
  on_state.col(2) -= on_y.col(1);
  if (!loop.scale) on_state.row(kBias).setZero();

  LoopMatrix wanted = LoopMatrix::Zero(1, n);
  for (Index i = 0; i < kMotion; ++i)
    wanted(0, i) = -loop.regulator_motion[static_cast<std::size_t>(i)] * UnitOf(i, force_N) / force_N;
  wanted(0, kForce) = loop.disturbance_to_command;
  for (Index i = 0; i < queued; ++i)
    wanted(0, kQueue + i) = -loop.regulator_queue[static_cast<std::size_t>(i)];
  const LoopMatrix wanted_state = wanted * on_state, wanted_y = wanted * on_y;

  const Biquad& f = loop.filter;
  LinearSystem s;
  s.c = f.b0 * wanted_state;
  s.c(0, filter) += 1.0;
  s.d = f.b0 * wanted_y;

  auto [next, from_command] = Prediction(loop, force_N, n);
  // Direct form II, transposed.
  from_command(filter, 0) = -f.a1;
  from_command(filter + 1, 0) = -f.a2;
  s.a = next * on_state + from_command * s.c;
  s.b = next * on_y + from_command * s.d;
  s.a.row(filter) += f.b1 * wanted_state;
  s.a(filter, filter + 1) += 1.0;
  s.a.row(filter + 1) += f.b2 * wanted_state;
  s.b.row(filter) += f.b1 * wanted_y;
  s.b.row(filter + 1) += f.b2 * wanted_y;
  return s;
}

std::vector<std::array<Complex, 2>> Response(const LinearSystem& s, Eigen::Index input,
                                             const std::vector<double>& frequencies) {
  std::vector<std::array<Complex, 2>> out;
  out.reserve(frequencies.size());
  const Eigen::MatrixXcd right = s.b.col(input).cast<Complex>();
  for (const double f : frequencies) {
    const Eigen::MatrixXcd y = s.c.cast<Complex>() * Resolvent(s, f, right);
    out.push_back({y(0, 0) + s.d(0, input), y(1, 0) + s.d(1, input)});
  }
  return out;
}

std::vector<std::array<Complex, 2>> ResponseToBoth(const LinearSystem& s,
                                                   const std::vector<double>& frequencies) {
  // One Hessenberg form serves all frequencies: then each is one elimination along the subdiagonal.
  const Eigen::HessenbergDecomposition<LoopMatrix> form(s.a);
  const LoopMatrix q = form.matrixQ();
  const HessenbergSystem system{form.matrixH(), q.transpose() * s.b, s.c * q};
  std::vector<std::array<Complex, 2>> out(frequencies.size(), {s.d(0, 0), s.d(0, 1)});
  Lane cosine{}, sine{};
  std::array<Lane, 2> real{}, imaginary{};
  for (std::size_t from = 0; from < out.size(); from += kLanes) {
    const std::size_t count = std::min(kLanes, out.size() - from);
    for (std::size_t l = 0; l < kLanes; ++l) {  // what is over repeats the last
      const double angle = 2.0 * std::numbers::pi * frequencies[from + std::min(l, count - 1)];
      cosine[l] = std::cos(angle);
      sine[l] = std::sin(angle);
    }
    RespondInLanes(system, cosine, sine, real, imaginary);
    for (std::size_t l = 0; l < count; ++l)
      for (std::size_t j = 0; j < 2; ++j) out[from + l][j] += Complex(real[j][l], imaginary[j][l]);
  }
  return out;
}

}  // namespace contour
