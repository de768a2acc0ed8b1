#include "config/idle_keys.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "drivers/cia402/mode_for.h"

namespace contour {
namespace {

/// Of the filter with one rigid mass alone, which `friction: srukf` is.
constexpr std::string_view kOfFilter[] = {"position_noise_um", "velocity_noise_mm_s",
                                          "timing_noise",      "bristle_noise_rel",
                                          "level_noise_rel",   "disturbance_noise_mm_s2",
                                          "log_sigma0_noise",  "disturbance_decay_ms",
                                          "motion_gate_mm_s",  "rest_noise",
                                          "log_sigma0_range",  "ripple_rate",
                                          "stribeck_rate",     "mass_rate",
                                          "delay_rate",        "viscous_rate",
                                          "level_error",       "level_asymmetry"};

class Finder {
 public:
  explicit Finder(const YamlValue& tree) : tree_(tree) {}

  /// Every key that is stated below `section`.
  void All(const std::string& section, const std::string& why) {
    if (const YamlValue* value = Find(section))
      for (const YamlEntry& entry : value->entries) Add(section + "." + entry.key, entry.where, why);
  }
  template <class Keys>
  void Of(const std::string& section, const Keys& keys, const std::string& why) {
    const YamlValue* value = Find(section);
    if (value == nullptr) return;
    for (const std::string_view key : keys)
      if (const YamlEntry* entry = value->Find(key)) Add(section + "." + entry->key, entry->where, why);
  }
  void One(const std::string& section, std::string_view key, const std::string& why) {
    Of(section, std::vector<std::string_view>{key}, why);
  }
  std::vector<std::string> Take() { return std::move(found_); }

 private:
  void Add(const std::string& key, const std::string& where, const std::string& why) {
    found_.push_back(where + ": " + key + ": " + why);
  }
  [[nodiscard]] const YamlValue* Find(std::string_view dotted) const {
    const YamlValue* at = &tree_;
    while (!dotted.empty()) {
      const std::size_t end = std::min(dotted.find('.'), dotted.size());
      const YamlEntry* entry = at->Find(dotted.substr(0, end));
      if (entry == nullptr) return nullptr;
      at = &entry->value;
      dotted.remove_prefix(std::min(end + 1, dotted.size()));
    }
    return at;
  }

  const YamlValue& tree_;
  std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> IdleKeys(const YamlValue& tree, const MachineConfig& machine) {
  Finder finder(tree);
  if (machine.machine.controller != ControllerName::kFull || machine.axes.empty()) return finder.Take();
  const bool linear = machine.control.friction == FrictionKind::kLinear;
  const bool cascade =
      ModeFor(machine.machine.controller, machine.axes.begin()->second.drive) == DriveMode::kCsp;
  const std::string no_effect = "no effect with control.friction: ";
  if (cascade)
    finder.All("control.full",
               "in csp the drive closes the loop; only the slowest swing that is watched goes by it");
  else if (linear)
    finder.All("control.full", no_effect + "linear in torque mode; the loop is tuned by axes.<name>.loop");
  if (linear) {
    // By a scale in torque mode the motor's mass is learnt, by that rate.
    const bool by_scale =
        !cascade && std::any_of(machine.axes.begin(), machine.axes.end(),
                                [](const auto& axis) { return axis.second.scale_loop.has_value(); });
    for (const std::string_view key : kOfFilter)
      if (!(by_scale && key == "mass_rate"))
        finder.One("estimator", key, no_effect + "linear; it is of the filter with one rigid mass");
  }
  for (const auto& [name, axis] : machine.axes) {
    const std::string section = "axes." + name;
    for (const std::string_view loop : {"loop", "scale_loop"}) {
      if (cascade)
        finder.One(section, loop, "no effect in csp; the drive closes the loop");
      else if (!linear)
        finder.One(section, loop, no_effect + "srukf; that loop is tuned by control.full");
    }
    if (!cascade) finder.One(section + ".drive", "csp_acceleration_share", "no effect in torque mode");
  }
  return finder.Take();
}

}  // namespace contour
