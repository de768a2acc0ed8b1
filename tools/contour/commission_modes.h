#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "config/machine_config.h"
#include "design/torque_loops.h"
#include "tools/contour/commission_options.h"
#include "tools/contour/mode_stay.h"

namespace contour {

inline constexpr const char* kCspInstead =
    "; contour commission --mode csp records it there, held by the drive's own loop";

inline constexpr const char* kRecordedInCsp =
    "note: recorded in csp, where the drive's reports are what is known of its torque: ";

/// What the drives are in while an axis is recorded. In torque mode every force is known that acts, but a
/// loop from here has to hold the axes, whatever the models leave open; in csp the drive's own does.
struct RecordingModes {
  /// Where the machine's own mode and loops do not do: to be recorded in torque mode with these, and the axes
  /// that lack one in csp before.
  TorqueLoops torque;
  /// Of a machine in torque mode: recorded in csp, and that is all.
  bool to_csp = false;

  [[nodiscard]] bool torque_wanted() const { return !torque.loops.empty() || !torque.lacking.empty(); }
};

/// Chosen before anything moves; says so where it is not the machine's own. Throws ConfigError where the
/// machine, or what was asked for, leaves none.
RecordingModes ChooseModes(const MachineConfig& own, const nlohmann::json& status,
                           const CommissionOptions& options);

/// The machine as it is while the axis is recorded, as far as is known before anything moves.
MachineConfig AsRecorded(const MachineConfig& own, const RecordingModes& modes);

/// What will be done, for people.
std::string Describe(const MachineConfig& own, const RecordingModes& modes, const nlohmann::json& status,
                     const CommissionOptions& options);

/// Throws std::runtime_error where contourd or the drives do not take it.
void EnterCsp(ModeStay& stay);
/// Where they do not, `torque` says why.
void EnterTorqueMode(ModeStay& stay, const std::map<std::string, ModelConfig>& models, TorqueLoops& torque);

}  // namespace contour
