#include "daemon/torque_mode.h"

#include "config/config_error.h"
#include "daemon/loaded_model.h"

namespace contour {
namespace {

/// These loops know no other.
constexpr const char* kFriction = "control.friction=linear";

std::string Mode(const std::string& axis) { return "axes." + axis + ".drive.mode=cst"; }
std::string Loop(const std::string& axis) { return "axes." + axis + ".loop="; }

}  // namespace

std::vector<std::string> TorqueModeOverrides(const TorqueMode& mode) {
  std::vector<std::string> set;
  if (mode.loops.empty()) return set;
  for (const std::string& loop : mode.loops) {
    const std::size_t equals = loop.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == loop.size())
      throw ConfigError({"--torque-loop " + loop +
                         ": expected an axis and its loop, as in --torque-loop x={regulator_Hz: 20, ...}"});
    const std::string axis = loop.substr(0, equals);
    set.push_back(Mode(axis));
    set.push_back(Loop(axis) + loop.substr(equals + 1));
  }
  for (const std::string& model : mode.models) set.push_back(ModelOverride(model));
  set.emplace_back(kFriction);
  return set;
}

std::vector<std::string> WithoutTorqueMode(const std::vector<std::string>& axes,
                                           std::vector<std::string> overrides) {
  for (const std::string& axis : axes)
    std::erase_if(overrides,
                  [&](const std::string& o) { return o == Mode(axis) || o.starts_with(Loop(axis)); });
  std::erase(overrides, kFriction);
  return overrides;
}

}  // namespace contour
