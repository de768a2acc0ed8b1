// The machine that the prediction simulates has all of a cause: what the extended model knows of it is
// gained.
#include "tools/contour_gain/contour_gain.h"

#include <gtest/gtest.h>

#include "config/load_machine.h"
#include "tests/config/test_files.h"

namespace contour::diagnosis {
namespace {

Cause ViscousCause(double torque_Nm, double exponent, double knee_rad_s) {
  Cause c;
  c.kind = "viscous_nonlinear";
  c.parameters["torque_at_max_speed_Nm"].value = torque_Nm;
  c.parameters["max_speed_rad_s"].value = 100.0;
  c.parameters["exponent"].value = exponent;
  if (knee_rad_s > 0.0) c.parameters["knee_rad_s"].value = knee_rad_s;
  return c;
}

ContourGain GainBy(const std::vector<Cause>& causes) {
  const MachineConfig machine = LoadMachine(ExampleMachine("xy_emulated.yaml"), {});
  Diagnosis found;
  found.causes = causes;
  return PredictContourGain(machine, "x", found, {}, UsualCircle(machine)).value();
}

TEST(ContourGain, OfAViscousFrictionWithAKnee) {
  const ContourGain gain = GainBy({ViscousCause(0.05, 2.0, 5.0)});
  EXPECT_LT(gain.after_um, 0.5 * gain.before_um) << gain.before_um << " to " << gain.after_um;
}

TEST(ContourGain, OfFurtherViscousCurves) {
  const ContourGain one = GainBy({ViscousCause(0.01, 2.0, 0.0)});
  const ContourGain both = GainBy({ViscousCause(0.01, 2.0, 0.0), ViscousCause(0.05, 2.0, 5.0)});
  EXPECT_GT(both.before_um, one.before_um + 0.5);
  EXPECT_LT(both.after_um, 0.5 * both.before_um) << both.before_um << " to " << both.after_um;
}

}  // namespace
}  // namespace contour::diagnosis
