#include "estimator/friction_learner.h"

#include <algorithm>
#include <cmath>

#include "core/wide_numbers.h"
#include "core/wide_vectors.h"

namespace contour {
namespace {

// Of the level: what remains in a sample that friction along the reference does not know of. Errors of
// neighbouring samples hang together, so it is far above what one of them is off by: with less, terms of
// short lengths, which the observer hardly sees, take what the motion is off by at a reversal
// (docs/laboratory/two_inertia_loop.md).
constexpr double kNoise = 0.25;
// Variance that a millisecond of motion adds, as a share of the one at the start: a third of its standard
// deviation in ten seconds.
constexpr double kDrift_1_ms = 1e-5;
// In Stribeck velocities: below the first the axis as good as stands and nothing is told apart, from the
// second on parameters drift at their full rate.
constexpr double kSlowest = 0.0025, kFull = 0.1;
// A force beyond that share of the level is from outside, unless the level itself is known no better; for a
// while after it the axis comes back to its path.
constexpr double kOutside = 0.6, kOutsideStds = 3.0;
constexpr double kWait_s = 0.15;
// What lasts longer than this in motion may be friction that was stated far too low after all: without an end
// to the waiting nobody would ever learn it.
constexpr double kLongest_s = 0.5;
// Standard deviations from the commissioned value.
constexpr double kBound = 4.0;
// Parameters that explain less than commissioned ones have run away; over that time, beyond that.
constexpr double kJudge_s = 0.5;
constexpr double kWorse = 1.5;
// A level may be on the edge of its range for good.
constexpr double kBeyondRange = 1.5;
constexpr double kNegligible = 0.02;  // of the level

constexpr std::size_t kQuads = kFrictionTerms / 4;
using Quads = wide::Quad[kQuads];
constexpr wide::Quad kOnes{1.0, 1.0, 1.0, 1.0};

}  // namespace

FrictionLearner::FrictionLearner(const Setup& setup) noexcept
    : setup_(setup),
      noise_N2_(kNoise * setup.level_N * kNoise * setup.level_N * 1e-3 / setup.period_s),
      outside_N_(std::max(kOutside, kOutsideStds * setup.level_std) * setup.level_N),
      judge_share_(std::min(1.0, setup.period_s / kJudge_s)),
      wait_(static_cast<int>(kWait_s / setup.period_s)),
      longest_(static_cast<int>(kLongest_s / setup.period_s)) {
  // An observer that is slow compared with the taps there are takes the rest with the last.
  double rest = 1.0;
  for (const double h : setup_.response) rest -= h;
  setup_.response.back() += rest;
  for (std::size_t i = 0; i < kFrictionTerms; ++i) {
    for (std::size_t j = 0; j < kFrictionTerms; ++j) {
      initial_[i][j] = setup.level_std * setup.parameters[i] * setup.level_std * setup.parameters[j] +
                       setup.per_std[i] * setup.per_std[j] + setup.per_law[i] * setup.per_law[j];
    }
    initial_[i][i] += setup.std[i] * setup.std[i];
    drift_[i] = kDrift_1_ms * 1e3 * setup.period_s * setup.std[i] * setup.std[i];
    double bound = kBound * std::sqrt(initial_[i][i]);
    if (i == friction_term::kConstant) {
      directions_N_ = std::abs(setup.parameters[i]) + bound;
      bound += setup.weight_N;
    }
    least_[i] = setup.parameters[i] - bound;
    most_[i] = setup.parameters[i] + bound;
  }
  Reset();
}

void FrictionLearner::Reset() noexcept {
  parameters_ = setup_.parameters;
  covariance_ = initial_;
  with_N2_ = without_N2_ = 0.0;
  bounded_ = false;
  Forget();
}

void FrictionLearner::Forget() noexcept {
  for (FrictionTerms& terms : past_) terms.fill(0.0);
  newest_ = 0;
  wait_cycles_ = waited_cycles_ = 0;
}

double FrictionLearner::Level_N(bool forward) const noexcept {
  double sum = 0.0;
  for (std::size_t i = friction_term::kDahl; i < friction_term::kConstant; ++i) sum += parameters_[i];
  const double differs_N = parameters_[friction_term::kConstant] - Weight_N();
  return forward ? sum + differs_N : sum - differs_N;
}

double FrictionLearner::Weight_N() const noexcept {
  const double constant_N = parameters_[friction_term::kConstant];
  return constant_N - std::clamp(constant_N, -directions_N_, directions_N_);
}

double FrictionLearner::SlidingLevel_N(bool forward, double speed_m_s) const noexcept {
  using namespace friction_term;  // NOLINT(google-build-using-namespace): names of terms only
  const std::array<double, 3> at = LinearFriction::StribeckAt(speed_m_s / setup_.vs_m_s);
  const double even_N = parameters_[kEvenStribeck] * at[2];
  return Level_N(forward) + parameters_[kStribeck] * at[0] + parameters_[kStribeck + 1] * at[1] +
         parameters_[kSlowBristle] * at[2] + (forward ? even_N : -even_N);
}

// The newest period shows at this sample with tap 1.
[[gnu::always_inline]] inline void FrictionLearner::Filter(FrictionTerms& filtered) const noexcept {
  Quads sum{};
  std::size_t tap = 1;
  // From the newest back to where the ring begins, then from its end.
  for (std::size_t from = newest_ + 1; tap < kLoopTaps; from = kLoopTaps) {
    const std::size_t to = from - std::min(from, kLoopTaps - tap);
    for (std::size_t at = from; at-- > to; ++tap) {
      const double* terms = past_[at].data();
      const double h = setup_.response[tap];
      for (std::size_t q = 0; q < kQuads; ++q) {
        wide::Quad term;
        wide::Load(terms + 4 * q, term);
        sum[q] += h * term;
      }
    }
  }
  for (std::size_t q = 0; q < kQuads; ++q) wide::Store(filtered.data() + 4 * q, sum[q]);
}

[[gnu::always_inline]] inline void FrictionLearner::Along(const FrictionTerms& filtered,
                                                          FrictionTerms& along) const noexcept {
  Quads sum{};
  for (std::size_t i = 0; i < friction_term::kUsed; ++i) {
    const double f = filtered[i];
    const double* row = covariance_[i].data();
    for (std::size_t q = 0; q < kQuads; ++q) {
      wide::Quad element;
      wide::Load(row + 4 * q, element);
      sum[q] += f * element;
    }
  }
  for (std::size_t q = 0; q < kQuads; ++q) wide::Store(along.data() + 4 * q, sum[q]);
}

[[gnu::always_inline]] inline void FrictionLearner::Shrink(const FrictionTerms& along) noexcept {
  Quads of{};
  for (std::size_t q = 0; q < kQuads; ++q) wide::Load(along.data() + 4 * q, of[q]);
  for (std::size_t i = 0; i < friction_term::kUsed; ++i) {
    const double part = along[i];
    double* row = covariance_[i].data();
    for (std::size_t q = 0; q < kQuads; ++q) {
      wide::Quad element;
      wide::Load(row + 4 * q, element);
      element -= part * of[q];
      wide::Store(row + 4 * q, element);
    }
  }
}

// Parameters go on by `gain` times `along`, as far as their bounds.
[[gnu::always_inline]] inline void FrictionLearner::Bound(double gain, const FrictionTerms& along) noexcept {
  wide::Quad changed{}, sum{};
  for (std::size_t q = 0; q < kQuads; ++q) {
    wide::Quad parameter, a, from, to;
    wide::Load(parameters_.data() + 4 * q, parameter);
    wide::Load(along.data() + 4 * q, a);
    wide::Load(least_.data() + 4 * q, from);
    wide::Load(most_.data() + 4 * q, to);
    const wide::Quad wanted = parameter + gain * a;
    const wide::Quad above = wanted < from ? from : wanted;
    const wide::Quad next = to < above ? to : above;
    changed = next != wanted ? kOnes : changed;
    sum += next;
    wide::Store(parameters_.data() + 4 * q, next);
  }
  bounded_ = changed[0] + changed[1] + changed[2] + changed[3] != 0.0;
  // What is no number stays none.
  sound_ = std::isfinite(sum[0] + sum[1] + sum[2] + sum[3]);
}

[[gnu::always_inline]] inline void FrictionLearner::Update(const FrictionTerms& filtered,
                                                           double unexplained_N, double moving,
                                                           double noise_N2) noexcept {
  FrictionTerms along;  // covariance times terms
  // Noise of the readings, and what comes with it: under a drive that answers each count of a coarse encoder
  // the axis shakes, and its friction is not what the terms say by the more, the more of it there is.
  const double read_N2 = setup_.together * noise_N2;
  const double sample_N2 = noise_N2_ + read_N2 * (1.0 + read_N2 / noise_N2_);
  Along(filtered, along);
  // What a force that accelerates the axis is off by is no friction.
  const double inertial_N = setup_.inertial_kg * filtered[friction_term::kMass];
  const double per_variance = 1.0 / (sample_N2 + inertial_N * inertial_N + Sum(filtered, along));
  const double gain = unexplained_N * per_variance;
  Bound(gain, along);
  // Each factor on its own, so that rounding keeps it symmetric.
  const double root = std::sqrt(per_variance);
  for (double& a : along) a *= root;
  Shrink(along);
  // What nothing excites does not become less known than it was at the start.
  for (std::size_t i = 0; i < kFrictionTerms; ++i) {
    double& variance = covariance_[i][i];
    if (variance < initial_[i][i]) variance += moving * drift_[i];
    sound_ &= variance >= 0.0;
  }
}

// What commissioned parameters would have left of the same samples.
void FrictionLearner::Judge(const FrictionTerms& filtered, double disturbance_N) noexcept {
  FrictionTerms learnt;
  for (std::size_t i = 0; i < kFrictionTerms; ++i) learnt[i] = parameters_[i] - setup_.parameters[i];
  const double without_N = disturbance_N + Sum(filtered, learnt);
  with_N2_ += judge_share_ * (disturbance_N * disturbance_N - with_N2_);
  without_N2_ += judge_share_ * (without_N * without_N - without_N2_);
}

bool FrictionLearner::Waits(double disturbance_N, double noise_N2) noexcept {
  const double outside_N = noise_N2 > 0.0
                               ? std::sqrt(outside_N_ * outside_N_ + kOutsideStds * kOutsideStds * noise_N2)
                               : outside_N_;
  if (std::abs(disturbance_N) > outside_N)
    wait_cycles_ = wait_;
  else if (wait_cycles_ > 0)
    --wait_cycles_;
  waited_cycles_ = wait_cycles_ > 0 ? std::min(waited_cycles_ + 1, longest_) : 0;
  return wait_cycles_ > 0 && waited_cycles_ < longest_;
}

CONTOUR_WIDE_VECTORS
double FrictionLearner::Learn(const FrictionTerms& terms, double used_N, double disturbance_N,
                              double speed_m_s, bool may, double noise_N2) noexcept {
  newest_ = newest_ + 1 == kLoopTaps ? 0 : newest_ + 1;
  past_[newest_] = terms;
  past_[newest_][friction_term::kUsed] = used_N;
  FrictionTerms filtered;
  Filter(filtered);
  const double found_N = disturbance_N + filtered[friction_term::kUsed];
  filtered[friction_term::kUsed] = 0.0;
  const double unexplained_N = found_N - Sum(parameters_, filtered);
  if (!setup_.learns || !may || speed_m_s < kSlowest * setup_.vs_m_s) {
    if (wait_cycles_ > 0) --wait_cycles_;
    return unexplained_N;
  }
  Judge(filtered, unexplained_N);
  if (Waits(unexplained_N, noise_N2)) return unexplained_N;
  Update(filtered, unexplained_N, std::min(1.0, speed_m_s / (kFull * setup_.vs_m_s)), noise_N2);
  if (!sound_) {
    Reset();
    ++brought_back_;
    return disturbance_N;
  }
  return found_N - Sum(parameters_, filtered);
}

void FrictionLearner::Rest() noexcept {
  const double negligible_N = kNegligible * setup_.level_N;
  const bool worse = with_N2_ > kWorse * without_N2_ + negligible_N * negligible_N;
  bool beyond = false;
  for (const bool forward : {true, false}) {
    double commissioned_N = 0.0;
    for (std::size_t i = friction_term::kDahl; i < friction_term::kConstant; ++i)
      commissioned_N += setup_.parameters[i];
    // Beside a weight nothing says what of the constant is a difference between the directions.
    const double level_N = Weight_N() != 0.0 ? 0.5 * (Level_N(true) + Level_N(false)) : Level_N(forward);
    const double ratio = level_N / commissioned_N;
    const double range = kBeyondRange * setup_.level_range;
    beyond = beyond || !(ratio < range) || !(ratio > 1.0 / range);
  }
  if (!worse && !beyond) return;
  parameters_ = setup_.parameters;
  covariance_ = initial_;
  with_N2_ = without_N2_ = 0.0;
  ++brought_back_;
}

}  // namespace contour
