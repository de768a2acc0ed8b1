#pragma once

#include <string>
#include <vector>

#include "config/loop_axis.h"

namespace contour {

/// What holds the table besides viscous friction, linear about one state of the friction:
/// z' = rate v2 - decay z, force = stiffness z + damping z'.
struct TableBristle {
  double stiffness_N_m = 0.0;
  double damping_Ns_m = 0.0;
  double rate = 0.0;
  double decay_1_s = 0.0;
};

/// How far from the stated axis a member of the uncertainty set is, and so which limit holds for it.
/// kCreeping has none: what becomes of it is for design/creep.h.
enum class MemberKind { kAsStated, kFarOff, kLate, kHeld, kCreeping };
inline constexpr std::size_t kMemberKinds = 5;
[[nodiscard]] double PeakLimit(const LoopLimits& limits, MemberKind kind);

/// One axis that the stated one might be, on which its loop must be stable.
struct LoopMember {
  std::string name;
  MemberKind kind = MemberKind::kAsStated;
  TwoInertiaAxis axis;
  TableBristle bristle;
  double motor_hold_N_m = 0.0;  ///< of the friction before the screw, at rest
  std::vector<SideMode> side_modes;
};

[[nodiscard]] inline bool HasBristle(const LoopMember& m) { return m.bristle.stiffness_N_m > 0.0; }

/// The stated axis, sliding.
LoopMember SlidingMember(const LoopAxis& axis);
/// The stated axis, at rest: held by the bristle.
LoopMember RestingMember(const LoopAxis& axis);
/// The stated axis, creeping at this speed on the falling slope of its friction.
LoopMember CreepingMember(const LoopAxis& axis, double velocity_m_s);
/// All that the loop must bear. The first is SlidingMember.
std::vector<LoopMember> UncertaintySet(const LoopAxis& axis);
/// The same for an axis whose friction leaves no loop to bear all of it: what the bristle holds, and what is
/// on the falling slope, are kinds of their own.
std::vector<LoopMember> CreepingSet(const LoopAxis& axis);
/// Speeds on the falling slope of its friction at which the set has members.
std::vector<double> SlopeSpeeds_m_s(const LoopAxis& axis);

/// LuGre friction about steady sliding at this speed.
TableBristle BristleAt(const Friction& friction, double velocity_m_s);

}  // namespace contour
