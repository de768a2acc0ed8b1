#pragma once

#include <limits>

#include "analysis/diagnosis/result/finding.h"

namespace contour::diagnosis::test {

/// One of everything that is told.
inline Diagnosis Example() {
  Diagnosis d;
  d.verdict = Verdict::kAmbiguous;
  Cause c;
  c.kind = "cogging";
  c.parameters["amplitude_Nm"] = {0.0191, 0.0185, 0.0197};
  c.parameters["order_per_rev"] = {12, 12, 12};
  c.log_evidence_gain = 345.6;
  c.heldout_rms_before = 0.02;
  c.heldout_rms_after = 0.01;
  c.heldout_gain = 0.5;
  c.heldout_gain_low = 0.45;
  c.heldout_gain_high = std::numeric_limits<double>::quiet_NaN();
  c.unit = "Nm";
  c.indistinguishable_from = {"friction_ripple"};
  c.deciding_experiment = "Sweep both ways.";
  d.causes = {c};
  d.not_excited = {"backlash", "temperature_viscosity"};
  d.smallest_detectable["cogging"]["amplitude_Nm"] = 0.001;
  d.false_alarm_rate = 0.01;
  d.data_quality = {100, 1, 2, 3};
  return d;
}

}  // namespace contour::diagnosis::test
