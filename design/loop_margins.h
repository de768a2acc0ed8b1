#pragma once

#include <array>
#include <string>
#include <vector>

#include "design/loop_member.h"
#include "design/loop_plant.h"

namespace contour {

/// How far a loop is from instability on one axis. L is the loop opened at the torque.
struct LoopMargins {
  bool stable = false;
  double growth_per_cycle = 0.0;  ///< largest eigenvalue of the closed loop
  double peak = 0.0;              ///< 1 / min |1 + L|; the modulus margin is 1 / peak
  double peak_Hz = 0.0;
  double gain_up = 0.0;       ///< the gain may rise by this factor; infinite when it never matters
  double gain_down = 0.0;     ///< and fall to this share; 0 when it may vanish
  double phase_deg = 0.0;     ///< smallest distance of the phase from -180 degrees where |L| = 1
  double bandwidth_Hz = 0.0;  ///< lowest frequency at which |L| falls to 1
};
/// Of the loop opened at the torque, L of negative feedback at rising frequencies; stability is not asked.
LoopMargins MarginsOf(const std::vector<Complex>& open, const std::vector<double>& frequencies_Hz);
LoopMargins MarginsOn(const LoopMember& member, const TwoInertiaLoop& loop, double period_s);

/// The closed loop's largest eigenvalue alone.
double GrowthOn(const LoopMember& member, const TwoInertiaLoop& loop, double period_s);

/// Where a force acts that the loop is not told of. On the motor: what its mass, its friction or the drive's
/// torque is off by.
enum class ForcePlace { kTable, kMotor };

/// The table under a force that steps through a lag of 4 ms, on the stated axis, sliding, with nothing
/// learnt.
struct ForceStep {
  double peak_m = 0.0;
  double mean_m = 0.0;  ///< of the absolute error over 200 ms
  double rms_m = 0.0;   ///< from 10 to 200 ms after it
  double left_m = 0.0;  ///< of the error, 200 ms after it
  double gone_s = 0.0;  ///< from then on no more than a tenth of the peak; 200 ms and more: not within them
};
ForceStep UnderForceStep(const LoopMember& member, const TwoInertiaLoop& loop, double period_s,
                         double force_N, ForcePlace place = ForcePlace::kTable);

/// The worst of the members of one kind.
struct WorstMember {
  std::string name;
  bool stable = true;
  double peak = 0.0;
  double growth_per_cycle = 0.0;
  double limit = 0.0;
};

/// All that a loop is judged by.
struct LoopVerdict {
  std::array<WorstMember, kMemberKinds> worst;  ///< by MemberKind
  ForceStep step;
  /// With a linear scale the same on screws that are as far off as may be, the worst. How fast the observer
  /// lets encoder and scale drift apart (bias_Hz) matters there alone: it looks best at rest where the screw
  /// is as stated, and takes the wind-up of another one for a force of the table's. Without one, `step`.
  ForceStep step_astray;
  /// With a linear scale the same of a force on the motor. An observer that takes what the encoder does by
  /// itself for an error of the screw does not see such a force, and makes up for it late. Without one,
  /// `step`: there a force is the same wherever it acts.
  ForceStep step_of_motor;
  double torque_noise = 0.0;  ///< from the resolution of the encoder (and scale), in rated torque
  double noise_limit = 0.0;
};
/// What loops are compared by: peak and twice the mean of the error under a step of force, the mean of one on
/// the table, on the worst screw, and of one on the motor.
[[nodiscard]] double StepError_m(const LoopVerdict& verdict);
/// Every limit is kept, but for this share. Members that creep have none.
[[nodiscard]] bool Acceptable(const LoopVerdict& verdict, double tolerance = 0.02);
/// What is nearest to its limit; of an axis that creeps, where on the slope it is worst.
[[nodiscard]] const WorstMember& Binding(const LoopVerdict& verdict);
/// What is nearest to its limit of all that has one.
[[nodiscard]] const WorstMember& Limiting(const LoopVerdict& verdict);

/// Judges loops of one axis; what does not depend on the loop is computed once.
class LoopJudge {
 public:
  LoopJudge(const LoopAxis& axis, double period_s);
  /// On these members; the first is the axis as stated.
  LoopJudge(const LoopAxis& axis, double period_s, const std::vector<LoopMember>& members);
  [[nodiscard]] LoopVerdict Judge(const TwoInertiaLoop& loop) const;

 private:
  struct Member {
    LoopMember member;
    LinearSystem plant;
    std::vector<std::array<Complex, 2>> response;
  };
  LoopAxis axis_;
  double period_s_;
  std::vector<double> frequencies_;
  std::vector<Member> members_;
};

}  // namespace contour
