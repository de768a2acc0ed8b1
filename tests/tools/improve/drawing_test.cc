#include "tools/improve/drawing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "config/load_machine.h"
#include "daemon/program/program.h"
#include "daemon/program_limits.h"

namespace contour::improve {
namespace {

// At its ends the cable pulls harder than a machine file may state for these motors.
MachineConfig Machine(bool cable = false, bool constant = false) {
  MachineConfig machine = LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml");
  ExtensionsConfig& e = machine.axes.at("x").model.extensions;
  if (cable) e.cable_spring = CableSpringExtension{0.0, {-200, 200}, {2, -2}};
  if (constant) e.constant_torque = ConstantTorqueExtension{0.2};
  return machine;
}

constexpr double kFriction_N = 30.0;

/// A circle on which the table is where it is to be: the motor leads by friction, the cable's pull and what
/// accelerates the table. `drawn_with`: what was not in it is told as friction.
Drawing Perfect(const ProgramText& program, const PerAxis<PlanLimits>& limits, const MachineConfig& truth,
                const MachineConfig& drawn_with) {
  Drawing d;
  d.start_m.resize(2);
  d.start_m[0] = d.start_m[1] = 0.0;
  d.known = KnownOf(drawn_with);
  const PerAxis<KnownEffects> is = KnownOf(truth);
  const auto plan = PlanMotion(ParseProgram(program.text, program.name, program.format), d.start_m, limits);
  PerAxis<ReferencePoint> at(2);
  for (double t = 0.0; t < plan->duration_s(); t += 0.02) {
    plan->At(t, at);
    DrawnCycle& c = d.cycles.emplace_back();
    c.path_time_s = t;
    std::size_t i = 0;
    for (const auto& [name, axis] : truth.axes) {
      const Mechanics m = ToSi(axis.model.mechanics);
      const ReferencePoint& p = at[i];
      const double friction_N = std::copysign(kFriction_N, p.velocity_m_s);
      const double wound_m =
          (friction_N - is[i].TableForce_N(p.position_m) + m.table_mass_kg * p.acceleration_m_s2) /
          m.stiffness_N_m;
      const double told_N = friction_N - is[i].Force_N(p.position_m) + d.known[i].Force_N(p.position_m);
      c.axes.push_back({p.position_m, p.acceleration_m_s2, p.position_m + wound_m, kNoTruth, told_N, 0.0});
      ++i;
    }
  }
  return d;
}

// The table is where it is whatever the model that it was drawn with knows: by one model for all drawings.
TEST(Drawing, TheBelievedTableDoesNotDependOnWhatWasToldAsFriction) {
  const MachineConfig old = Machine();
  const PerAxis<PlanLimits> limits = ProgramLimits(old);
  const ProgramText circle{"a circle", "shape: circle\nradius_mm: 10\nfeed_mm_min: 3000\nturns: 3\n",
                           ProgramFormat::kYaml};
  for (const auto& [cable, constant] : {std::pair{true, false}, {false, true}, {true, true}}) {
    const MachineConfig truth = Machine(cable, constant);
    for (const MachineConfig& drawn_with : {old, truth}) {
      const PathErrors e =
          ErrorsOf(Perfect(circle, limits, truth, drawn_with), circle, limits, truth, nullptr);
      EXPECT_LT(e.believed.peak_um, 0.01) << cable << constant;
      EXPECT_GT(e.encoder.peak_um, 0.5) << cable << constant;
    }
  }
}

}  // namespace
}  // namespace contour::improve
