#include "analysis/axis_model/extension_keys.h"

#include <array>
#include <cctype>
#include <span>
#include <string_view>

namespace contour::diagnosis {
namespace {

struct Key {
  std::string_view ours, in_file;
};
constexpr std::array<Key, 9> kLinear = {{{"amplitude_Nm", "amplitude_N"},
                                         {"torque_Nm", "force_N"},
                                         {"torque_at_stroke_end_Nm", "force_at_stroke_end_N"},
                                         {"torque_at_max_speed_Nm", "force_at_max_speed_N"},
                                         {"max_speed_rad_s", "max_speed_m_s"},
                                         {"knee_rad_s", "knee_m_s"},
                                         {"vs_rad_s", "vs_m_s"},
                                         {"stiffness_Nm_rad", "stiffness_N_m"},
                                         {"limit_Nm", "limit_N"}}};
constexpr std::array<Key, 1> kTurning = {{{"position_mm", "position_mrad"}}};

std::span<const Key> KeysOf(ExtensionUnits units) {
  if (units == ExtensionUnits::kOfLinearAxis) return kLinear;
  if (units == ExtensionUnits::kOfTurningAxis) return kTurning;
  return {};
}

bool IsWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

}  // namespace

ExtensionUnits UnitsOf(const YamlValue& model) {
  if (model.Find("mass_kg") != nullptr) return ExtensionUnits::kOfLinearAxis;
  return model.Find("lead_mm") == nullptr ? ExtensionUnits::kOfTurningAxis : ExtensionUnits::kOfScrew;
}

void RenameFromFile(ExtensionUnits units, YamlValue& value) {
  for (YamlEntry& e : value.entries) {
    for (const Key& key : KeysOf(units)) {
      if (e.key == key.in_file)
        e.key = key.ours;
      else if (e.key == key.ours)
        e.key += " (expected " + std::string(key.in_file) + " on this axis)";
      else
        continue;
      break;
    }
    RenameFromFile(units, e.value);
  }
  for (YamlValue& item : value.items) RenameFromFile(units, item);
}

std::string RenamedToFile(ExtensionUnits units, std::string text) {
  for (const Key& key : KeysOf(units))
    for (std::size_t at = text.find(key.ours); at != std::string::npos; at = text.find(key.ours, at + 1)) {
      const std::size_t end = at + key.ours.size();
      if ((at > 0 && IsWord(text[at - 1])) || (end < text.size() && IsWord(text[end]))) continue;
      text.replace(at, key.ours.size(), key.in_file);
    }
  return text;
}

}  // namespace contour::diagnosis
