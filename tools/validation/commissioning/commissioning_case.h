#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "design/torque_loops.h"
#include "tools/validation/commissioning/catalogue.h"
#include "tools/validation/commissioning/virtual_commissioning.h"

namespace contour {

/// One emulated machine to commission.
struct CommissioningCase {
  std::string machine;  ///< base (config/xy_emulated.yaml), or one of config/family
  std::string effect;   ///< a name of CommissioningEffects()
  std::uint64_t seed = 1;
  std::string axis = "x";
  std::string mode = "cst";        ///< of the drives: cst or csp
  bool stay = false;               ///< recorded in csp, though there may be loops for torque mode
  std::vector<std::string> set{};  ///< on top of the machine's file, as --set has it
};

/// What the axes have besides screw and friction: none, cogging3, cogging6 (thousandths of a Nm for a motor
/// of 0.637 Nm, the same share of rated torque for others), ripple, wobble, motor_friction, side_mode.
const std::vector<std::string>& CommissioningEffects();

/// Loops found from catalogue data before, by machine, seed and mass.
using KnownTorqueLoops = std::map<std::string, TorqueLoops>;
/// The machine as it is while an axis is recorded for good, as `contour commission` has it: where drives
/// lead, or no loop holds all that a catalogue leaves open, in torque mode where there are loops for it, from
/// the catalogue or from what records in csp tell.
struct Recorded {
  EmulatedMachineFile file;
  std::string how;  ///< for people
};
Recorded AsRecorded(const EmulatedMachineFile& file, const CommissioningCase& c, KnownTorqueLoops& known);

/// The machine with its effect, its model from a catalogue, its loops to begin with.
EmulatedMachineFile MachineOf(const CommissioningCase& c, KnownLoops& known);

}  // namespace contour
