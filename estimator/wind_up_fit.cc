#include "estimator/wind_up_fit.h"

#include <algorithm>
#include <cmath>

#include "estimator/exponential.h"
#include "estimator/share_of_period.h"

namespace contour {
namespace {

// What is followed after a reversal, in presliding lengths, and how it is divided.
constexpr double kWindow = 6.0;
constexpr double kBlockShare = kWindow / 128.0;
constexpr int kLeastInBlock = 4;
constexpr std::size_t kLeastBlocks = 16;
constexpr std::size_t kBlocksPerCycle = 8;
// Near its level the bristle moves any way for the same force: rows there weigh no less than this.
constexpr double kLeastWeight = 0.1;
// How far residuals may hang together: 2 when they do not. By a drive's commanded torque a Maxwell-slip
// friction gives 0.1 to 0.8 and LuGre 2 to 3, by its reported torque, which is noisier, 0.2 to 1.6 and 1
// to 2.8. The mean over the reversals counts, beginning with one of kIndependent.
constexpr double kIndependent = 2.0;
constexpr double kLeastIndependence = 1.3;
constexpr double kMostJudged = 20.0;
constexpr double kMostLevelError = 2.0;
// Stribeck curve and damping of the bristle are believed. What they are wrong by looks like this share of the
// bristle's compliance, and like one of the screw's; and the faster it goes the more.
constexpr double kLawOfBristle = 0.01;
constexpr double kLawAtSpeed = 0.03;  // per Stribeck velocity at the end of the window
constexpr double kLawOfScrew = 0.05;
constexpr double kMostLaw = 0.25;   // of the commissioned compliance
constexpr double kMostSpeed = 0.4;  // Stribeck velocities at the end of the window
// Standard deviations that an axis moving alone stays short by.
constexpr double kDoubts = 5.0;
// What is stated may be quite wrong: its tails are those of a Student distribution.
constexpr double kTailDegrees = 4.0;
constexpr int kTailPasses = 4;
// Share of a new answer that is put to use per millisecond.
constexpr double kUseShare = 0.02;

/// Solves a x = b for a symmetric positive definite a, in place; false when it is not. Returns x in b.
template <std::size_t N, std::size_t R>
bool Solve(std::array<std::array<double, N>, N>& a, std::array<std::array<double, N>, R>& b) noexcept {
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      if (i != j) {
        a[i][j] = sum / a[j][j];
      } else {
        if (!(sum > 1e-12 * a[i][i])) return false;
        a[i][i] = std::sqrt(sum);
      }
    }
  }
  for (auto& x : b) {
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t k = 0; k < i; ++k) x[i] -= a[i][k] * x[k];
      x[i] /= a[i][i];
    }
    for (std::size_t i = N; i-- > 0;) {
      for (std::size_t k = i + 1; k < N; ++k) x[i] -= a[k][i] * x[k];
      x[i] /= a[i][i];
    }
  }
  return true;
}

}  // namespace

WindUpFit::WindUpFit(const Tuning& tuning) noexcept
    : tuning_(tuning), use_share_(ShareOfPeriod(kUseShare, tuning.period_s)) {
  Reset();
}

void WindUpFit::Reset() noexcept {
  compliance_m_N_ = 1.0 / tuning_.stiffness_N_m;
  stated_std_m_N_ = std_m_N_ = tuning_.stiffness_std * compliance_m_N_;
  stated_certainty_ = certainty_ = learns() ? 1.0 / (std_m_N_ * std_m_N_) : 0.0;
  found_m_N_ = found_certainty_ = same_m2_N2_ = law_m2_N2_ = 0.0;
  independence_ = kIndependent;
  judged_ = 1.0;
  used_m_N_ = 0.0;
  reversals_ = 0;
  Pause();
}

void WindUpFit::Pause() noexcept {
  phase_ = Phase::kIdle;
  direction_ = 0;
  known_ = 0;
}

void WindUpFit::Learn(const Sample& s) noexcept {
  used_m_N_ += use_share_ * (Believed_m_N(s.alone) - used_m_N_);
  const double velocity_m_s = (s.position_m - position_m_) / tuning_.period_s;
  const double acceleration_m_s2 = (velocity_m_s - velocity_m_s_) / tuning_.period_s;
  // The second difference belongs to the sample before.
  const double at_m = position_m_;
  const double at_m_s = 0.5 * (velocity_m_s + velocity_m_s_);
  const double at_N = 0.5 * (s.force_N + force_N_) - s.mass_kg * acceleration_m_s2;
  position_m_ = s.position_m;
  velocity_m_s_ = velocity_m_s;
  force_N_ = s.force_N;
  if (known_ < 3) {
    ++known_;
    direction_ = s.direction;
    return;
  }
  if (phase_ == Phase::kFitting) {
    const std::size_t end = std::min(next_ + kBlocksPerCycle, count_);
    while (next_ < end) Take(blocks_[next_++]);
    if (next_ == count_) EndPass();
  }
  if (s.direction != direction_ && phase_ != Phase::kFitting) {
    phase_ = Phase::kIdle;
    if (s.direction != 0 && direction_ != 0) Begin(s, at_m);
  }
  direction_ = s.direction;
  if (phase_ == Phase::kFollowing)
    Follow(direction_ * at_m, direction_ * at_N, direction_ * at_m_s, s.level_ratio);
}

// Where only this axis moves, being short along the path is no error of the contour, and going past its ends
// is: what counts then is the smallest compliance that may well be. Where others move too, an error either
// way is as bad.
double WindUpFit::Believed_m_N(bool alone) const noexcept {
  const double extra_m_N = compliance_m_N_ - 1.0 / tuning_.stiffness_N_m;
  if (!alone || !learns()) return extra_m_N;
  // What the law is wrong by is the same at every reversal.
  const double law_m_N = kLawOfScrew * compliance_m_N_ * FoundCertainty() / certainty_;
  return extra_m_N - kDoubts * std::sqrt(1.0 / certainty_ + law_m_N * law_m_N);
}

void WindUpFit::Begin(const Sample& s, double position_m) noexcept {
  if (!(s.level_N > 0.0) || !(s.sigma0_N_m > 0.0)) return;
  phase_ = Phase::kFollowing;
  level_N_ = s.level_N;
  sigma0_N_m_ = s.sigma0_N_m;
  length_m_ = level_N_ / sigma0_N_m_;
  begin_m_ = block_begin_m_ = s.direction * position_m;
  sum_ = {};
  in_block_ = 0;
  count_ = 0;
}

void WindUpFit::Follow(double position_m, double force_N, double velocity_m_s, double level_ratio) noexcept {
  sum_.position_m += position_m - begin_m_;
  sum_.force_N += force_N;
  sum_.velocity_m_s += velocity_m_s;
  sum_.level_ratio += level_ratio;
  ++in_block_;
  if (in_block_ >= kLeastInBlock && position_m - block_begin_m_ >= kBlockShare * length_m_) {
    CloseBlock();
    block_begin_m_ = position_m;
  }
  if (position_m - begin_m_ > kWindow * length_m_ || count_ == kMostBlocks) {
    phase_ = Phase::kIdle;
    end_m_s_ = velocity_m_s;
    if (count_ < kLeastBlocks || velocity_m_s > kMostSpeed * tuning_.vs_m_s) return;
    phase_ = Phase::kFitting;
    pass_ = 0;
    BeginPass();
  }
}

void WindUpFit::CloseBlock() noexcept {
  const double share = 1.0 / in_block_;
  blocks_[count_++] = {share * sum_.position_m, share * sum_.force_N, share * sum_.velocity_m_s,
                       share * sum_.level_ratio};
  sum_ = {};
  in_block_ = 0;
}

void WindUpFit::BeginPass() noexcept {
  next_ = 1;  // the first block has the reversal in it
  rows_ = 0;
  integral_ = 0.0;
  moments_ = steps_ = {};
}

// Forces in levels, ways in presliding lengths.
void WindUpFit::Take(const Block& b) noexcept {
  const double per_level = 1.0 / level_N_;
  const double slip = std::clamp(1.0 - b.force_N * per_level, 0.0, 2.0);
  const double table_m_s = b.velocity_m_s / (1.0 + sigma0_N_m_ * slip / tuning_.stiffness_N_m);
  const double u = b.velocity_m_s / tuning_.sigma1_decay_m_s;
  const double damping_N =
      tuning_.sigma2_Ns_m * b.velocity_m_s + tuning_.sigma1_Ns_m * Exp(-u * u) * table_m_s * slip;
  double share = (b.force_N - damping_N) * per_level;
  // The level falls with speed, and the bristle with it as far as it has come to it.
  share /= 1.0 - (1.0 - b.level_ratio) * std::clamp(share, 0.0, 1.0);
  const double way = b.position_m / length_m_;
  if (rows_ == 0) {
    first_m_ = last_m_ = way;
    first_share_ = last_share_ = share;
  }
  integral_ += 0.5 * (share + last_share_) * (way - last_m_);
  last_m_ = way;
  last_share_ = share;
  const double w = std::max(1.0 - share, kLeastWeight);
  const Row row{w * (share - first_share_), w * integral_,
                w * 0.5 * (share * share - first_share_ * first_share_), w, w * (way - first_m_)};
  for (std::size_t i = 0; i < kRow; ++i)
    for (std::size_t j = 0; j <= i; ++j) moments_[i][j] += row[i] * row[j];
  if (rows_ != 0) {
    for (std::size_t i = 0; i < kRow; ++i)
      for (std::size_t j = 0; j <= i; ++j) steps_[i][j] += (row[i] - row_[i]) * (row[j] - row_[j]);
  }
  row_ = row;
  ++rows_;
}

void WindUpFit::EndPass() noexcept {
  phase_ = Phase::kIdle;
  std::array<std::array<double, kUnknowns>, kUnknowns> normal{};
  for (std::size_t i = 0; i < kUnknowns; ++i)
    for (std::size_t j = 0; j <= i; ++j) normal[i][j] = moments_[i][j];
  // The answer, and the columns of the inverse that belong to 1/G and 1/(G K).
  std::array<std::array<double, kUnknowns>, 3> x{};
  for (std::size_t i = 0; i < kUnknowns; ++i) x[0][i] = moments_[kUnknowns][i];
  x[1][1] = x[2][2] = 1.0;
  if (!Solve(normal, x)) return;
  const auto& theta = x[0];
  const double per_level = theta[1];
  if (!(per_level > 1.0 / kMostLevelError && per_level < kMostLevelError)) return;
  if (++pass_ == 1) {
    level_N_ /= per_level;
    length_m_ = level_N_ / sigma0_N_m_;
    phase_ = Phase::kFitting;
    BeginPass();
    return;
  }
  const std::array<double, kRow> minus{-theta[0], -theta[1], -theta[2], -theta[3], 1.0};
  const auto quadratic = [&minus](const Moments& m) {
    double sum = 0.0;
    for (std::size_t i = 0; i < kRow; ++i)
      for (std::size_t j = 0; j <= i; ++j) sum += (i == j ? 1.0 : 2.0) * m[i][j] * minus[i] * minus[j];
    return sum;
  };
  const double residual2 = quadratic(moments_);
  if (!(residual2 > 0.0)) return;
  const double independence = quadratic(steps_) / residual2;
  if (!Follows(independence)) return;
  const double noise2 = residual2 / static_cast<double>(rows_ - kUnknowns);
  const double compliance_m_N = -theta[2] / (per_level * sigma0_N_m_);
  const double by_level = -compliance_m_N / per_level, by_square = -1.0 / (per_level * sigma0_N_m_);
  const double variance = noise2 * (by_level * by_level * x[1][1] + 2.0 * by_level * by_square * x[1][2] +
                                    by_square * by_square * x[2][2]);
  Conclude(compliance_m_N, std::sqrt(std::max(variance, 0.0)), independence);
}

// Whether residuals hang together shows over some reversals, not at each. If they do, nothing has been
// learnt.
bool WindUpFit::Follows(double independence) noexcept {
  judged_ = std::min(judged_ + 1.0, kMostJudged);
  independence_ += (independence - independence_) / judged_;
  if (independence_ > kLeastIndependence) return true;
  found_m_N_ = found_certainty_ = same_m2_N2_ = law_m2_N2_ = 0.0;
  Weigh();
  return false;
}

void WindUpFit::Conclude(double compliance_m_N, double std_m_N, double independence) noexcept {
  const double commissioned_m_N = 1.0 / tuning_.stiffness_N_m;
  if (!(std_m_N < tuning_.most_std * commissioned_m_N)) return;
  if (!(compliance_m_N > commissioned_m_N / (1.0 + tuning_.most_change) &&
        compliance_m_N < commissioned_m_N * (1.0 + tuning_.most_change)))
    return;
  const double bristle_m_N = (kLawOfBristle + kLawAtSpeed * end_m_s_ / tuning_.vs_m_s) / sigma0_N_m_;
  // Of a soft bristle and a stiff screw, the law's errors drown the screw.
  if (!(bristle_m_N < kMostLaw * commissioned_m_N)) return;
  const double law = std::sqrt(kLawOfScrew * kLawOfScrew + tuning_.before_screw * tuning_.before_screw);
  const double screw_m_N = law * compliance_m_N;
  const double whole = std::min(1.0, independence / kIndependent);
  const double certainty =
      whole * whole / (std_m_N * std_m_N + bristle_m_N * bristle_m_N + screw_m_N * screw_m_N);
  found_certainty_ += certainty;
  found_m_N_ += certainty / found_certainty_ * (compliance_m_N - found_m_N_);
  law_m2_N2_ = bristle_m_N * bristle_m_N + screw_m_N * screw_m_N;
  same_m2_N2_ = tuning_.same_law * law_m2_N2_;
  ++reversals_;
  Weigh();
}

// What was stated has a Student distribution with kTailDegrees of freedom: the farther from it the answer
// comes to lie, the less it counts. Of two modes, the one that is nearer to what was stated, unless what was
// found is far off in standard deviations of both.
void WindUpFit::Weigh() noexcept {
  const double stated_m_N = 1.0 / tuning_.stiffness_N_m;
  compliance_m_N_ = stated_m_N;
  certainty_ = stated_certainty_;
  std_m_N_ = stated_std_m_N_;
  if (found_certainty_ == 0.0) return;
  const double found = FoundCertainty();
  const double off_m_N = found_m_N_ - stated_m_N;
  double off2 = off_m_N * off_m_N / (1.0 / stated_certainty_ + 1.0 / found);
  double moved_m_N = 0.0;
  for (int pass = 0; pass < kTailPasses; ++pass) {
    certainty_ = stated_certainty_ * (kTailDegrees + 1.0) / (kTailDegrees + off2) + found;
    moved_m_N = found / certainty_ * off_m_N;
    off2 = moved_m_N * moved_m_N * stated_certainty_;
  }
  compliance_m_N_ += moved_m_N;
  // By friction that is not as stated every reversal is off alike, the more so the more they count.
  const double of_found = found / certainty_;
  std_m_N_ = std::min(stated_std_m_N_, std::sqrt(1.0 / certainty_ + of_found * of_found * law_m2_N2_));
}

}  // namespace contour
