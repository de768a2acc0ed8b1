#include "tools/validation/hidden/hide_effect.h"

#include <algorithm>
#include <cmath>

#include "tools/machine/assigned_axis.h"
#include "tools/validation/hidden/specimens.h"

namespace contour::hidden {

const std::vector<std::string>& OutsideKinds() {
  static const std::vector<std::string> kinds = {"stick_spot", "cable_hysteresis", "telegraph_torque",
                                                 "lubrication", "speed_band_torque"};
  return kinds;
}

void HideEffect(const Hidden& h, const Setting& s, double begin_s, double duration_s,
                EmulatedAxisConfig& axis) {
  const diagnosis::SpecimenMachine machine = MachineOf(s);
  if (const diagnosis::Specimen* specimen = SpecimenOf(h.kind)) {
    axis = Assigned(axis, (*specimen->effect)(DrawnOf(h), machine, {begin_s, duration_s}));
    return;
  }
  OutsideEffectsConfig o = axis.effects.outside.value_or(OutsideEffectsConfig{});
  if (h.kind == "stick_spot")
    o.stick_spot = StickSpotEffect{h.size, h.order * s.truth.half_stroke_mm, 3.0, h.second > 0.0 ? 1 : -1};
  if (h.kind == "cable_hysteresis") o.cable_hysteresis = CableHysteresisEffect{h.size, 15.0};
  if (h.kind == "telegraph_torque") o.telegraph_torque = TelegraphTorqueEffect{h.size, 0.4};
  if (h.kind == "lubrication") o.lubrication = LubricationEffect{h.size, 700.0};
  if (h.kind == "speed_band_torque")
    o.speed_band_torque = SpeedBandTorqueEffect{h.size, h.second * machine.speed_limit_rad_s,
                                                (h.second + 0.3) * machine.speed_limit_rad_s};
  axis.effects.outside = o;
}

std::map<std::string, double> TruthOf(const Hidden& h, const LogSpan& span) {
  const diagnosis::Specimen* specimen = SpecimenOf(h.kind);
  return specimen == nullptr ? std::map<std::string, double>{} : (*specimen->truth)(DrawnOf(h), span);
}

double LargestSize(const Hidden& h) {
  if (const diagnosis::Specimen* specimen = SpecimenOf(h.kind)) return specimen->largest_size;
  if (h.kind == "stick_spot") return 15.0;
  if (h.kind == "lubrication") return 2.0;
  return diagnosis::kNoLargestSize;
}

}  // namespace contour::hidden
