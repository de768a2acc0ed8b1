#pragma once

#include <array>
#include <cstdint>

namespace contour {

/// What an oscillation must exceed to be one, from the axis's own numbers.
struct OscillationBounds {
  double period_s = 1e-3;
  double low_Hz = 2.0;            ///< lowest frequency at rest
  double low_moving_Hz = 8.0;     ///< in motion, where the path itself is slow
  double high_Hz = 250.0;         ///< mode of the screw, or what the cycle can show
  double swing_m = 1e-7;          ///< at rest: peak to peak beyond what counts and steps of torque explain
  double swing_N = 2.0;           ///< at rest: two steps of torque
  double swing_moving_N = 100.0;  ///< in motion: beyond what friction that turns round explains
  double mass_kg = 1.0;
  double growing_m = 1e-4;  ///< amplitude above which growing is a danger
  int half_waves = 12;      ///< in a row; 0: not watched
  /// Mean change of the force from cycle to cycle beyond what is any use: a swing too fast for half waves to
  /// be told apart; 0: not watched.
  double chatter_N = 0.0;
  double violent_N = 1e9;  ///< peak to peak: beyond it a swing is no nuisance but a danger
  double answered = 4.0;   ///< times what an experiment pushes with, a loop in order swings at most
};

struct OscillationSample {
  double following_error_m = 0.0;
  double force_N = 0.0;  ///< as the drive reports it, at the table
  double reference_velocity_m_s = 0.0;
  double reference_acceleration_m_s2 = 0.0;
  /// Of an experiment: it explains what the loop answers to it, and more than that must be violent.
  double pushed_N = 0.0;
};

enum class Oscillation : std::uint8_t { kNone, kLasting, kGrowing };

/// Finds a sustained oscillation of one axis that its reference does not contain: half waves of the following
/// error and of the torque that follow each other with one period and do not decay. A few additions per
/// cycle; everything else once per half wave.
class OscillationDetector {
 public:
  OscillationDetector() noexcept = default;
  explicit OscillationDetector(const OscillationBounds& bounds) noexcept;

  void Reset() noexcept;
  /// Once per cycle. Tells once for every `half_waves` half waves in a row.
  Oscillation Step(const OscillationSample& now) noexcept;

  [[nodiscard]] int run() const noexcept { return run_; }
  /// What was told last took so much force and was not about to die out, as what a shock leaves is: the newer
  /// half of its half waves, or a swing from cycle to cycle that has grown, or that has stayed as
  /// large as it was for longer than a shock rings.
  [[nodiscard]] bool violent() const noexcept { return violent_; }

 private:
  struct HalfWave {
    std::uint32_t cycles = 0;
    double peak_m = 0.0;
    double peak_N = 0.0;
  };
  [[nodiscard]] Oscillation EndHalfWave() noexcept;
  /// Changes of the force from cycle to cycle; but for the mean since they were quiet, or were told.
  struct Chatter {
    double mean_N = 0.0;
    double change_N = 0.0;  ///< newest
    double sum_N = 0.0;
    double moment_N = 0.0;  ///< each times its time in cycles
    std::uint32_t cycles = 0;
  };
  [[nodiscard]] bool Chatters(double force_N, double pushed_N) noexcept;
  /// Of a swing from cycle to cycle that is told again and again: its mean change, span by span.
  struct Lasting {
    double sum_N = 0.0;
    std::uint32_t cycles = 0;
    std::uint32_t told_ago = 0;  ///< cycles
    double first_N = 0.0, newest_N = 0.0;
    int spans = 0;
    bool goes_on = false;
  };
  void SeeLasting(double two_N) noexcept;
  [[nodiscard]] bool Stays() const noexcept;
  [[nodiscard]] bool GoesOn(const HalfWave& before) const noexcept;

  OscillationBounds bounds_;
  double share_ = 0.0;  ///< of the slow mean that is taken away, at rest
  double moving_share_ = 0.0;
  double reference_velocity_m_s_ = 0.0;
  double mean_m_ = 0.0;
  double mean_N_ = 0.0;
  double before_N_ = 0.0;
  Chatter chatter_;
  Lasting lasting_;
  bool started_ = false;
  int sign_ = 0;
  HalfWave now_;
  std::array<HalfWave, 2> before_{};  ///< newest first
  double highest_m_s2_ = 0.0;         ///< of the reference, in this half wave and the one before
  double lowest_m_s2_ = 0.0;
  double pushed_N_ = 0.0;  ///< most of it, likewise
  double before_pushed_N_ = 0.0;
  double before_highest_m_s2_ = 0.0;
  double before_lowest_m_s2_ = 0.0;
  std::uint32_t moved_ago_ = 0;  ///< cycles since the reference last moved
  int run_ = 0;
  int violent_run_ = 0;  ///< of them, the newest in a row that were
  double violent_first_N_ = 0.0;
  bool violent_ = false;
  int growing_ = 0;
};

}  // namespace contour
