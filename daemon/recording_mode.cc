#include "daemon/recording_mode.h"

#include <algorithm>

#include "config/config_error.h"
#include "daemon/loaded_model.h"

namespace contour {
namespace {

/// The loops know no other; nor is there one in csp that a catalogue could lead astray.
constexpr const char* kFriction = "control.friction=linear";

std::string Mode(const std::string& axis) { return "axes." + axis + ".drive.mode="; }
std::string Loop(const std::string& axis) { return "axes." + axis + ".loop="; }

}  // namespace

std::vector<std::string> RecordingOverrides(const RecordingMode& mode) {
  std::vector<std::string> set;
  if (mode.loops.empty() && mode.csp_axes.empty()) return set;
  for (const std::string& axis : mode.csp_axes) set.push_back(Mode(axis) + "csp");
  for (const std::string& loop : mode.loops) {
    const std::size_t equals = loop.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == loop.size())
      throw ConfigError({"--torque-loop " + loop +
                         ": expected an axis and its loop, as in --torque-loop x={regulator_Hz: 20, ...}"});
    const std::string axis = loop.substr(0, equals);
    set.push_back(Mode(axis) + "cst");
    set.push_back(Loop(axis) + loop.substr(equals + 1));
  }
  for (const std::string& model : mode.models) set.push_back(ModelOverride(model));
  set.emplace_back(kFriction);
  return set;
}

std::optional<std::string> RecordingModeText(const RecordingMode& mode) {
  if (mode.loops.empty() && mode.csp_axes.empty()) return std::nullopt;
  return std::string("all axes are in ") +
         (mode.loops.empty() ? "csp, held by their drives," : "torque mode, with loops") +
         " for commissioning, and control.friction is linear, whatever the machine file says; "
         "contourd started anew has the machine file's own";
}

std::vector<std::string> WithoutRecordingMode(const RecordingMode& mode, std::vector<std::string> overrides) {
  for (const std::string& assignment : RecordingOverrides(mode)) {
    const auto last = std::find(overrides.rbegin(), overrides.rend(), assignment);
    if (last != overrides.rend()) overrides.erase(std::next(last).base());
  }
  return overrides;
}

}  // namespace contour
