#include "analysis/prediction_error/simd/lane_loops.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "analysis/prediction_error/products.h"
#include "analysis/prediction_error/simd/lane_linear.h"
#include "analysis/prediction_error/simd/lane_run.h"

namespace contour::diagnosis {
namespace {

constexpr std::size_t kRows = 700;

/// Of this machine: those that multiply and add in one rounding.
std::vector<const LaneLoops*> Fused() {
  std::vector<const LaneLoops*> out;
  if (HasAvx2()) out.push_back(&kAvx2Loops);
  if (HasAvx512()) out.push_back(&kAvx512Loops);
  return out;
}

double Largest(const std::vector<double>& x) {
  double largest = 0.0;
  for (const double v : x) largest = std::max(largest, std::fabs(v));
  return largest;
}

/// The baseline rounds twice where the others round once.
void ExpectNear(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  std::vector<double> difference(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) difference[i] = a[i] - b[i];
  EXPECT_LT(Largest(difference), 1e-9 * Largest(b));
}

std::vector<double> Noise(std::size_t size, double scale, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, scale);
  std::vector<double> out(size);
  for (double& x : out) x = normal(random);
  return out;
}

enum class Neighbour { kNothing, kAfter, kBefore };

// Runs of a table axis, every lane with parameters of its own, through rest, slides and reversals; another
// bundle may run next to it.
std::vector<double> RunOf(const LaneLoops& loops, bool two, bool soft, bool square, bool bare,
                          Neighbour neighbour = Neighbour::kNothing) {
  constexpr int kSubsteps = 4;
  Lanes m{};
  m.rows = kRows;
  m.substeps = kSubsteps;
  m.period_s = 1e-3;
  m.two = two;
  m.on_load = two;
  m.soft = soft;
  m.fading = true;
  m.gap = m.payload = !bare;
  m.linear = square ? 0.0 : 1.0;
  m.square = square ? 1.0 : 0.0;
  m.full = m.trace = true;
  std::vector<double> torque(kRows * kSubsteps), measured(kRows);
  for (std::size_t i = 0; i < torque.size(); ++i)
    torque[i] = 0.05 * std::sin(0.004 * static_cast<double>(i)) + 1e-3;
  for (std::size_t k = 0; k < kRows; ++k) measured[k] = 2.0 - 2.0 * std::cos(0.016 * static_cast<double>(k));
  const std::vector<double> noise = Noise(kRows + 1, 1e-3, 5), late = Noise(kRows * kSubsteps, 1e-12, 6);
  std::vector<std::uint8_t> valid(kRows, 1);
  valid[300] = 0;
  m.measured = measured.data();
  m.valid = valid.data();
  m.l[0] = m.l[2] = 0.2;
  m.l[1] = m.l[3] = 20.0;
  std::vector<double> out(4 * kLanes * kRows);
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double x = 1.0 + 0.03 * static_cast<double>(i);
    m.torque.at[i] = torque.data();
    m.late.at[i] = late.data();
    for (LaneSignal* s : {&m.motor, &m.load, &m.level}) {
      s->from.at[i] = noise.data();
      s->to.at[i] = noise.data() + 1;
    }
    m.viscous.at[i] = noise.data();
    m.reading.at[i] = late.data();
    m.inv_motor[i] = 1e4 / x;
    m.inv_load[i] = 2e4;
    m.inv_payload[i] = 9e3;
    m.payload_row[i] = static_cast<std::int64_t>(400 + i);
    for (LaneFlow* flow : {&m.flow, &m.flow_payload}) {
      flow->dd[i] = 0.91 + 0.001 * x;
      flow->dr[i] = flow->ra[i] = 2.4e-4;
      flow->da[i] = 3e-8;
      flow->rd[i] = -700.0 * x;
      flow->rr[i] = 0.85;
      flow->half_rd[i] = -370.0 * x;
      flow->half_rr[i] = 0.93;
      flow->half_ra[i] = 1.2e-4;
      flow->stiff[i] = 3e6 * x;
      flow->damp[i] = 300.0;
      flow->motor_share[i] = flow == &m.flow ? 0.7 : 0.5;
      flow->load_share[i] = 1.0 - flow->motor_share[i];
    }
    m.half_gap[i] = 1e-5 * static_cast<double>(i);
    m.Fc_plus[i] = 0.02;
    m.Fc_minus[i] = 0.021;
    m.dF_plus[i] = m.dF_minus[i] = 0.004 * x;
    m.inv_vs[i] = 0.7;
    m.s0[i] = 1.4 * x;
    m.s1[i] = 1e-3;
    m.inv_vd[i] = 0.4;
    m.s2[i] = 1e-4;
    m.smallest[i] = 1e-6;
    m.gain[i] = 1.0;
    m.saturation[i] = 0.1;
    m.soft_level[i] = 0.2;
    m.soft_s0[i] = 0.1;
    m.rough[i] = 1e-4;
    m.innovation[i] = &out[i * kRows];
    m.table[i] = &out[(kLanes + i) * kRows];
    m.velocity[i] = &out[(2 * kLanes + i) * kRows];
    m.friction[i] = &out[(3 * kLanes + i) * kRows];
  }
  std::vector<double> spare(kRows);
  Lanes other = m;
  for (std::size_t i = 0; i < kLanes; ++i) {
    other.Fc_plus[i] = 0.03;
    other.flow.rd[i] = -900.0;
    other.innovation[i] = other.table[i] = other.velocity[i] = other.friction[i] = spare.data();
  }
  if (neighbour == Neighbour::kNothing) loops.run(m);
  if (neighbour == Neighbour::kAfter) loops.run_both(m, other);
  if (neighbour == Neighbour::kBefore) loops.run_both(other, m);
  return out;
}

TEST(LaneLoops, RunsGiveTheSameBitsWithEveryFusedInstructionSet) {
  for (const bool two : {false, true})
    for (const bool soft : {false, true})
      for (const auto& [square, bare] :
           {std::pair(false, false), std::pair(true, false), std::pair(true, true)}) {
        const std::vector<double> baseline = RunOf(kBaselineLoops, two, soft, square, bare);
        EXPECT_TRUE(std::isfinite(Largest(baseline)) && Largest(baseline) > 0.1);
        for (const Neighbour neighbour : {Neighbour::kAfter, Neighbour::kBefore})
          EXPECT_EQ(RunOf(kBaselineLoops, two, soft, square, bare, neighbour), baseline);
        if (Fused().empty()) continue;
        const std::vector<double> expected = RunOf(*Fused()[0], two, soft, square, bare);
        ExpectNear(baseline, expected);
        for (const LaneLoops* loops : Fused())
          for (const Neighbour neighbour : {Neighbour::kNothing, Neighbour::kAfter, Neighbour::kBefore})
            EXPECT_EQ(RunOf(*loops, two, soft, square, bare, neighbour), expected);
      }
}

TEST(LaneLoops, WhiteningAndColumnsGiveTheSameBitsWithEveryFusedInstructionSet) {
  constexpr std::size_t kStates = 4,
                        kStride = kStates * kStates + 2 * kStates + kLinearInputs * (kStates + 1);
  const std::vector<double> numbers = Noise(kRows * kStride, 0.2, 7),
                            signals = Noise(9 * (kRows + 1), 1.0, 8);
  const std::vector<float> step(numbers.begin(), numbers.end());
  const std::vector<std::uint8_t> valid(kRows, 1);
  const std::vector<double> taps = Noise(kWhitenTaps, 0.3, 9);
  const auto work = [&](const LaneLoops& loops) {
    std::vector<double> out(3 * kLanes * kRows);
    LaneColumns c;
    c.rows = kRows;
    c.stride = kStride;
    c.states = kStates;
    c.step = step.data();
    c.valid = valid.data();
    c.has_motor = c.has_level = c.has_reading = true;
    LaneWhiten w;
    w.rows = kRows;
    w.stride = kStride;
    w.states = kStates;
    w.step = step.data();
    w.gain = step.data() + 11;
    w.taps = taps.data();
    w.counted = valid.data();
    w.weight = signals.data();
    for (std::size_t i = 0; i < kLanes; ++i) {
      const double* s = &signals[i * (kRows + 1)];
      for (LaneSignal* lane : {&c.motor, &c.load, &c.level}) {
        lane->from.at[i] = s;
        lane->to.at[i] = s + 1;
      }
      c.reading[i] = s;
      c.innovation[i] = &out[i * kRows];
      w.in[0][i] = w.in[1][kLanes - 1 - i] = s;
      for (std::size_t g = 0; g < kMostGroups; ++g) w.out[g][i] = &out[((1 + g) * kLanes + i) * kRows];
    }
    loops.columns(c);
    w.groups = kMostGroups;
    loops.whiten(w);
    // One group alone gives what it gives next to another.
    const std::vector<double> both = out;
    std::fill_n(out.begin() + kLanes * kRows, kLanes * kRows, 0.0);
    w.groups = 1;
    loops.whiten(w);
    EXPECT_EQ(both, out);
    for (std::size_t i = 0; i < kLanes; ++i)
      EXPECT_EQ(out[(kLanes + i) * kRows + kRows / 2], out[(3 * kLanes - 1 - i) * kRows + kRows / 2]);
    return out;
  };
  const std::vector<double> baseline = work(kBaselineLoops);
  EXPECT_NE(baseline[kRows / 2], 0.0);
  EXPECT_NE(baseline.back(), 0.0);
  for (const LaneLoops* loops : Fused()) {
    const std::vector<double> fused = work(*loops);
    ExpectNear(baseline, fused);
    EXPECT_EQ(fused, work(*Fused()[0]));
  }
}

constexpr std::size_t kN = 4, kTransition = kN * kN + 2 * kN + kLinearInputs * (kN + 1);

/// x' = A x + B u + G r, e = valid r - c x - d u, one column in plain numbers: motor force and level u,
/// reading r.
std::vector<double> ScalarColumn(const std::vector<float>& step, const double* u, const double* level,
                                 const double* reading) {
  std::vector<double> e(kRows, 0.0), x(kN, 0.0);
  for (std::size_t k = 0; k + 1 < kRows; ++k) {
    const float* p = &step[k * kTransition];
    const auto at = [&](std::size_t i) { return static_cast<double>(p[i]); };
    std::vector<double> next(kN, 0.0);
    for (std::size_t i = 0; i < kN; ++i) {
      e[k + 1] -= at(kN * kN + i) * x[i];
      for (std::size_t j = 0; j < kN; ++j) next[i] += at(i * kN + j) * x[j];
    }
    const auto act = [&](std::size_t input, double value) {
      const std::size_t b = kN * kN + 2 * kN + input * (kN + 1);
      e[k + 1] -= at(b) * value;
      for (std::size_t i = 0; i < kN; ++i) next[i] += at(b + 1 + i) * value;
    };
    act(0, u[k]);
    act(1, u[k + 1]);
    act(4, level[k]);
    act(5, level[k + 1]);
    e[k + 1] -= reading[k + 1];
    for (std::size_t i = 0; i < kN; ++i) next[i] -= at(kN * kN + kN + i) * reading[k + 1];
    x = next;
  }
  return e;
}

TEST(LaneLoops, ColumnsAreTheRecursionOfTheLinearModel) {
  const std::vector<double> numbers = Noise(kRows * kTransition, 0.2, 17);
  const std::vector<float> step(numbers.begin(), numbers.end());
  const std::vector<double> signals = Noise(3 * kLanes * (kRows + 1), 1.0, 18);
  const std::vector<std::uint8_t> valid(kRows, 1);
  const auto signal = [&](std::size_t which, std::size_t lane) {
    return &signals[(which * kLanes + lane) * (kRows + 1)];
  };
  std::vector<double> out(kLanes * kRows);
  LaneColumns c;
  c.rows = kRows;
  c.stride = kTransition;
  c.states = kN;
  c.step = step.data();
  c.valid = valid.data();
  c.has_motor = c.has_level = c.has_reading = true;
  const std::vector<double> zeros(kRows + 1, 0.0);
  for (std::size_t i = 0; i < kLanes; ++i) {
    c.motor.from.at[i] = signal(0, i);
    c.motor.to.at[i] = signal(0, i) + 1;
    c.level.from.at[i] = signal(1, i);
    c.level.to.at[i] = signal(1, i) + 1;
    c.load.from.at[i] = c.load.to.at[i] = zeros.data();
    c.reading[i] = signal(2, i);
    c.innovation[i] = &out[i * kRows];
  }
  BestLoops().columns(c);
  for (std::size_t i = 0; i < kLanes; ++i)
    ExpectNear(std::vector<double>(c.innovation[i], c.innovation[i] + kRows),
               ScalarColumn(step, signal(0, i), signal(1, i), signal(2, i)));
}

/// nu = (r + c x) / sqrt(S), x' = A x + kappa (r + c x); then the taps over the rows that count, times the
/// weight.
std::vector<double> ScalarWhite(const std::vector<float>& step, const std::vector<float>& gain,
                                const std::vector<double>& taps, const std::vector<std::uint8_t>& counted,
                                const double* weight, const double* in) {
  std::vector<double> nu(kRows, 0.0), out(kRows, 0.0), x(kN, 0.0);
  for (std::size_t k = 1; k < kRows; ++k) {
    const float* p = &step[(k - 1) * kTransition];
    const float* g = &gain[(k - 1) * (kN + 1)];
    double v = in[k];
    for (std::size_t j = 0; j < kN; ++j) v += static_cast<double>(p[kN * kN + j]) * x[j];
    std::vector<double> next(kN);
    for (std::size_t i = 0; i < kN; ++i) {
      next[i] = static_cast<double>(g[i]) * v;
      for (std::size_t j = 0; j < kN; ++j) next[i] += static_cast<double>(p[i * kN + j]) * x[j];
    }
    x = next;
    nu[k] = counted[k] != 0 ? v * static_cast<double>(g[kN]) : 0.0;
  }
  for (std::size_t k = 0; k < kRows; ++k)
    for (std::size_t t = 0; t < std::min(taps.size(), k + 1); ++t) out[k] += taps[t] * nu[k - t] * weight[k];
  return out;
}

TEST(LaneLoops, WhiteningIsTheRecursionOfTheKalmanFilterAndTheTaps) {
  const std::vector<double> numbers = Noise(kRows * kTransition, 0.2, 19),
                            gains = Noise(kRows * (kN + 1), 0.2, 20);
  const std::vector<float> step(numbers.begin(), numbers.end()), gain(gains.begin(), gains.end());
  const std::vector<double> signals = Noise(kLanes * kRows, 1.0, 21), weight = Noise(kRows, 1.0, 22);
  const std::vector<double> taps = Noise(kWhitenTaps, 0.3, 23);
  std::vector<std::uint8_t> counted(kRows, 1);
  counted[200] = 0;
  std::vector<double> out(kLanes * kRows);
  LaneWhiten w;
  w.rows = kRows;
  w.stride = kTransition;
  w.states = kN;
  w.step = step.data();
  w.gain = gain.data();
  w.taps = taps.data();
  w.counted = counted.data();
  w.weight = weight.data();
  for (std::size_t i = 0; i < kLanes; ++i) {
    w.in[0][i] = &signals[i * kRows];
    w.out[0][i] = &out[i * kRows];
  }
  BestLoops().whiten(w);
  for (std::size_t i = 0; i < kLanes; ++i)
    ExpectNear(std::vector<double>(w.out[0][i], w.out[0][i] + kRows),
               ScalarWhite(step, gain, taps, counted, weight.data(), w.in[0][i]));
}

TEST(LaneLoops, ProductsGiveTheSameBitsWithEveryFusedInstructionSetAndTheRightSums) {
  constexpr std::size_t kSize = 1237, kA = 7, kB = 5;
  const std::vector<double> numbers = Noise((kA + kB) * kSize, 1.0, 10);
  const double* columns[kA + kB];
  for (std::size_t i = 0; i < kA + kB; ++i) columns[i] = &numbers[i * kSize];
  const auto work = [&](const LaneLoops& loops) {
    std::vector<double> out(kA * kB);
    LaneProducts m;
    m.size = kSize;
    m.a_count = kA;
    m.b_count = kB;
    m.a = columns;
    m.b = columns + kA;
    m.out = out.data();
    loops.products(m);
    return out;
  };
  const std::vector<double> expected = work(kBaselineLoops);
  for (const LaneLoops* loops : Fused()) {
    ExpectNear(work(*loops), expected);
    EXPECT_EQ(work(*loops), work(*Fused()[0]));
  }
  for (std::size_t i = 0; i < kA; ++i)
    for (std::size_t j = 0; j < kB; ++j) {
      double sum = 0.0;
      for (std::size_t k = 0; k < kSize; ++k) sum += columns[i][k] * columns[kA + j][k];
      EXPECT_NEAR(expected[i * kB + j], sum, 1e-10);
    }
}

TEST(LaneLoops, ProductsOfColumnsWithThemselvesAreMirrored) {
  constexpr std::size_t kSize = 611, kCount = 9;
  const std::vector<double> numbers = Noise(kCount * kSize, 1.0, 11);
  std::vector<const double*> a, b;
  for (std::size_t i = 0; i < kCount; ++i) a.push_back(&numbers[i * kSize]);
  const Eigen::MatrixXd own = ProductsOf(a, a, kSize);
  for (std::size_t i = 0; i < kCount; ++i)
    for (std::size_t j = 0; j < kCount; ++j) {
      const double* one[] = {a[i]};
      const double* other[] = {a[j]};
      EXPECT_NEAR(own(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)),
                  ProductsOf(one, other, kSize)(0, 0), 1e-10);
    }
}

TEST(LaneLoops, ProductsInBlocksAddUp) {
  constexpr std::size_t kSize = 500, kRuns = 2, kBlocks = 7;
  const std::vector<double> numbers = Noise(4 * kRuns * kSize, 1.0, 12);
  const auto column = [&](std::size_t i) { return &numbers[i * kRuns * kSize]; };
  const double* a[] = {column(0), column(1)};
  const double* b[] = {column(2)};
  const double* r = column(3);
  const ProductsInBlocks got = MakeProductsInBlocks(a, b, r, kSize, kRuns * kSize, kBlocks);
  ASSERT_EQ(got.with_r.cols(), static_cast<Eigen::Index>(kBlocks));
  const double* one[] = {r};
  EXPECT_NEAR(got.with_r.sum(), ProductsOf(b, one, kRuns * kSize)(0, 0), 1e-10);
  EXPECT_LT((got.products - ProductsOf(a, b, kRuns * kSize)).norm(), 1e-10);
  double third = 0.0;
  for (std::size_t run = 0; run < kRuns; ++run)
    for (std::size_t k = kSize * 2 / kBlocks; k < kSize * 3 / kBlocks; ++k)
      third += b[0][run * kSize + k] * r[run * kSize + k];
  EXPECT_NEAR(got.with_r(0, 2), third, 1e-10);
}

}  // namespace
}  // namespace contour::diagnosis
