#pragma once

#include <string>
#include <vector>

#include "config/loop_axis.h"
#include "config/machine_config.h"

namespace contour {

/// A loop that a machine file states for an axis in torque mode.
struct StatedLoop {
  std::string axis_name;
  std::string key;     ///< of its tuning, "axes.x.loop" or "axes.x.scale_loop"
  bool scale = false;  ///< it takes the linear scale
  LoopAxis axis;
  LoopTuning tuning;
};
/// Of one axis, the loop without its scale first; none in csp, where the drive closes them.
std::vector<StatedLoop> StatedLoopsOf(const MachineConfig& machine, const std::string& name);

/// A loop that breaks a limit of `contour check`; whether it may move its axis all the same is LoopDemand's.
struct LoopFault {
  StatedLoop loop;
  std::string wrong;                ///< which limit it breaks, in one sentence
  bool unstable = false;            ///< on the stated axis or another one of its set; or it is no loop at all
  bool unstable_as_stated = false;  ///< on the stated axis or hardly off it
};
/// `key: what was found, what was expected and what would help`.
std::string WhyRefused(const LoopFault& fault, const std::vector<std::string>& help);
std::string WhyRefused(const LoopFault& fault, double period_s);  ///< tries what would help, for seconds

/// Of the loops that the machine moves by, those that break a limit; as it is, without what is missing
/// (LoopsThatAreMissing). Some 20 ms for a loop.
std::vector<LoopFault> LoopFaults(const MachineConfig& machine);

/// What is asked of a loop before it may move its axis: to be stable on the stated axis and on all of its
/// uncertainty set, or a loop to commission with (WhyNotToStartWith); or to be stable on the stated axis and
/// its nearest neighbours (MemberKind::kAsStated).
enum class LoopDemand { kStability, kStabilityAsStated };

/// In the words of `contour check`, each message behind its key. Nothing is tried that would help: that takes
/// longer than whoever starts or asks wants to wait, and it is named who tries it.
struct LoopVerdicts {
  std::vector<std::string> refused;
  std::vector<std::string> warned;  ///< what breaks a limit and may run all the same
};
LoopVerdicts JudgeStatedLoops(const MachineConfig& machine, LoopDemand demand);

}  // namespace contour
