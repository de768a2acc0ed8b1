#pragma once

#include <array>
#include <cstddef>

namespace contour {

/// Compliance of the screw, learnt on line from reversals, without a scale. From one presliding length to the
/// next the motor moves by the bristle's travel and by the screw's wind-up. With s = +-1 the direction, x the
/// table, p = x + F / K the motor, a LuGre bristle dF/dx = sigma0 (1 - s F / G) integrates to
///
///   p - p0 = (1/sigma0 + 1/K) (F - F0) + (1/G) int F dp - (1/(G K)) (F^2 - F0^2) / 2      (s = 1)
///
/// which is linear in what is not known. The two compliances differ in shape: that of the bristle grows as F
/// comes to its level, that of the screw does not. Weighted least squares over the travel after a reversal,
/// in units of force; the level found goes into a second pass (weights, damping of the bristle). What does
/// not follow this law teaches nothing: another kind of friction leaves residuals that hang together (Durbin
/// and Watson), a coarse encoder a wide answer.
class WindUpFit {
 public:
  struct Tuning {
    double period_s = 1e-3;
    double stiffness_N_m = 1.0;  ///< as commissioned
    double stiffness_std = 0.0;  ///< relative; 0: nothing is learnt
    double vs_m_s = 1.0;
    double sigma1_Ns_m = 0.0;
    double sigma1_decay_m_s = 1.0;
    double sigma2_Ns_m = 0.0;
    /// What an answer may be uncertain by, as a share of the commissioned compliance.
    double most_std = 0.08;
    /// Share of the friction that does not come through the screw. The law has none: a bristle on either side
    /// is another one, and the answer counts less by as much.
    double before_screw = 0.0;
    /// What an answer may be off by, as a share of the commissioned compliance or of the answer.
    double most_change = 2.0;
    /// Share of the law's variance that is the same at every reversal: more of them do not make it less.
    double same_law = 0.0;
  };
  struct Sample {
    double position_m = 0.0;
    double force_N = 0.0;  ///< of the drive, mean over the period that ends here
    double mass_kg = 0.0;
    int direction = 0;         ///< commanded; 0: none
    bool alone = false;        ///< no other axis moves
    double level_N = 0.0;      ///< friction level at the lowest speed
    double level_ratio = 1.0;  ///< level at the present speed over it
    double sigma0_N_m = 0.0;
  };

  WindUpFit() noexcept = default;
  explicit WindUpFit(const Tuning& tuning) noexcept;

  void Reset() noexcept;
  /// Something has happened that the law does not know: what was being followed counts for nothing.
  void Pause() noexcept;

  [[nodiscard]] bool learns() const noexcept { return tuning_.stiffness_std > 0.0; }
  /// By how much the screw yields more than commissioned. It changes slowly.
  [[nodiscard]] double extra_compliance_m_N() const noexcept { return used_m_N_; }
  /// As stated and found together, m/N, and one standard deviation of it.
  [[nodiscard]] double compliance_m_N() const noexcept { return compliance_m_N_; }
  [[nodiscard]] double compliance_std_m_N() const noexcept { return std_m_N_; }
  /// Reversals that have taught something.
  [[nodiscard]] int reversals() const noexcept { return reversals_; }

  /// Whether the levels of the next sample matter.
  [[nodiscard]] bool NeedsLevels(int direction) const noexcept {
    return phase_ == Phase::kFollowing || direction != direction_;
  }
  void Learn(const Sample& sample) noexcept;

 private:
  static constexpr std::size_t kMostBlocks = 128;
  static constexpr std::size_t kUnknowns = 4;
  static constexpr std::size_t kRow = kUnknowns + 1;
  using Row = std::array<double, kRow>;
  using Moments = std::array<Row, kRow>;
  /// Means over a stretch, in the direction of motion.
  struct Block {
    double position_m = 0.0, force_N = 0.0, velocity_m_s = 0.0, level_ratio = 0.0;
  };
  enum class Phase { kIdle, kFollowing, kFitting };

  [[nodiscard]] double Believed_m_N(bool alone) const noexcept;
  /// Of all reversals together: what the law is wrong by is partly the same at each.
  [[nodiscard]] double FoundCertainty() const noexcept {
    return found_certainty_ / (1.0 + found_certainty_ * same_m2_N2_);
  }
  void Begin(const Sample& sample, double position_m) noexcept;
  void Follow(double position_m, double force_N, double velocity_m_s, double level_ratio) noexcept;
  void CloseBlock() noexcept;
  void BeginPass() noexcept;
  void Take(const Block& block) noexcept;
  void EndPass() noexcept;
  [[nodiscard]] bool Follows(double independence) noexcept;
  void Weigh() noexcept;
  void Conclude(double compliance_m_N, double std_m_N, double independence) noexcept;

  Tuning tuning_;
  double use_share_ = 0.0;       // per period
  double compliance_m_N_ = 0.0;  // estimate and the inverse of its variance
  double certainty_ = 0.0;
  double std_m_N_ = 0.0;
  double stated_std_m_N_ = 0.0;
  double stated_certainty_ = 0.0;
  double found_m_N_ = 0.0;  // by reversals alone
  double found_certainty_ = 0.0;
  double same_m2_N2_ = 0.0;    // variance that they share
  double law_m2_N2_ = 0.0;     // variance by the law, of each
  double independence_ = 0.0;  // of the residuals, mean over so many reversals
  double judged_ = 0.0;
  double end_m_s_ = 0.0;  // speed where a window ended
  double used_m_N_ = 0.0;
  int reversals_ = 0;

  double position_m_ = 0.0, velocity_m_s_ = 0.0, force_N_ = 0.0;  // of the sample before
  int known_ = 0;

  Phase phase_ = Phase::kIdle;
  int direction_ = 0;
  double begin_m_ = 0.0, length_m_ = 0.0;  // a presliding length, G / sigma0
  double level_N_ = 0.0, sigma0_N_m_ = 0.0;
  Block sum_;
  int in_block_ = 0;
  double block_begin_m_ = 0.0;
  std::size_t count_ = 0;
  std::array<Block, kMostBlocks> blocks_{};

  int pass_ = 0;
  std::size_t next_ = 0;
  std::size_t rows_ = 0;
  double first_m_ = 0.0, first_share_ = 0.0, last_m_ = 0.0, last_share_ = 0.0, integral_ = 0.0;
  Row row_{};
  Moments moments_{}, steps_{};
};

}  // namespace contour
