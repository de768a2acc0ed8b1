// The plan of a commissioning: its motions, limits and refusals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "config/config_error.h"
#include "config/load_machine.h"
#include "config/loop_axis.h"
#include "daemon/program/motion_plan.h"
#include "daemon/program_limits.h"
#include "design/catalogue_doubt.h"
#include "design/commission_plan.h"

namespace contour::test {
namespace {

MachineConfig Example() { return LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml"); }

std::string Refusal(double position_mm, const CommissionLimits& limits) {
  try {
    PlanCommissioning(Example(), "x", position_mm, limits);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return {};
}

TEST(CommissionPlanTest, KeepsToTheTravelAlsoNearAnEnd) {
  const MachineConfig machine = Example();
  const CommissionLimits limits = DefaultCommissionLimits(machine.axes.at("x"));
  EXPECT_DOUBLE_EQ(limits.travel_mm, 20.0);
  EXPECT_DOUBLE_EQ(limits.max_speed_mm_s, 100.0);
  for (const double position_mm : {0.0, 199.0, -195.0}) {
    const CommissionPlan plan = PlanCommissioning(machine, "x", position_mm, limits);
    EXPECT_NEAR(plan.high_mm - plan.low_mm, limits.travel_mm, 1e-9);
    EXPECT_GE(plan.low_mm, -200.0);
    EXPECT_LE(plan.high_mm, 200.0);
    EXPECT_LE(plan.low_mm, position_mm);
    EXPECT_GE(plan.high_mm, position_mm);
    EXPECT_LT(plan.largest_torque_Nm, limits.max_torque_Nm);
  }
}

TEST(CommissionPlanTest, DefaultLimitsAreEnoughForEverySteepness) {
  MachineConfig machine = LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml");
  AxisConfig& axis = machine.axes.at("x");
  for (const double lead_mm : {1.0, 5.0, 40.0}) {
    axis.model.mechanics.lead_mm = lead_mm;
    axis.limits.torque_Nm = 20.0;
    EXPECT_NO_THROW(PlanCommissioning(machine, "x", 0.0, DefaultCommissionLimits(axis))) << lead_mm;
  }
}

// Of a drive sized by its ramps, 60 % of the limit may be less than the ramps take.
TEST(CommissionPlanTest, DefaultTorqueIsEnoughForTheRampsWhereTheLimitIs) {
  MachineConfig machine = Example();
  AxisConfig& axis = machine.axes.at("x");
  axis.limits.torque_Nm = 20.0;
  const double ramps_Nm =
      PlanCommissioning(machine, "x", 0.0, DefaultCommissionLimits(axis)).largest_torque_Nm;
  axis.limits.torque_Nm = 1.01 * ramps_Nm;
  EXPECT_NO_THROW(PlanCommissioning(machine, "x", 0.0, DefaultCommissionLimits(axis)));
  axis.limits.torque_Nm = 0.99 * ramps_Nm;
  try {
    PlanCommissioning(machine, "x", 0.0, DefaultCommissionLimits(axis));
    ADD_FAILURE() << "its ramps take more than its limit";
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("allow more (axes.x.limits.torque_Nm, too)"), std::string::npos)
        << e.what();
  }
}

// Reports of a drive that closes the loop have noise of that loop.
TEST(CommissionPlanTest, ShakesMoreWhereTheDriveLeads) {
  MachineConfig machine = Example();
  AxisConfig& axis = machine.axes.at("x");
  const auto chirp_Nm = [&] {
    const CommissionPlan plan = PlanCommissioning(machine, "x", 0.0, DefaultCommissionLimits(axis));
    for (const CommissionMotion& motion : plan.motions) {
      if (motion.yaml.find("kind: chirp") == std::string::npos) continue;
      const std::string key = "amplitude_Nm: ";
      return std::stod(motion.yaml.substr(motion.yaml.find(key) + key.size()));
    }
    return 0.0;
  };
  axis.drive.mode = DriveMode::kCst;
  const double torque_mode_Nm = chirp_Nm();
  EXPECT_GT(torque_mode_Nm, 0.0);
  axis.drive.mode = DriveMode::kCsp;
  EXPECT_NEAR(chirp_Nm(), 2.0 * torque_mode_Nm, 1e-6);
}

double NumberOf(const std::string& yaml, const std::string& key) {
  return std::stod(yaml.substr(yaml.find(key) + key.size()));
}

std::string StepsOfTorque(const CommissionPlan& plan) {
  for (const CommissionMotion& motion : plan.motions)
    if (motion.yaml.find("torque_steps") != std::string::npos) return motion.yaml;
  ADD_FAILURE() << "no steps of torque";
  return {};
}

// The steps' spring is the axis's loop, weaker: one that is too weak for 0.3 mm gets more way, and in the end
// less torque.
TEST(CommissionPlanTest, StepsOfTorqueAreWhatTheLoopCanHold) {
  MachineConfig machine = Example();
  AxisConfig& axis = machine.axes.at("x");
  axis.loop = LoopTuning{.regulator_Hz = 12.0,
                         .windup_weight = 0.2,
                         .velocity_weight = 0.35,
                         .disturbance_Hz = 100.0,
                         .motor_force_Hz = 400.0,
                         .table_force_Hz = 60.0,
                         .notch_ratio = 0.7,
                         .notch_pole_damping = 0.7,
                         .notch_zero_damping = 0.2};
  PerAxis<double> start_m;
  start_m.resize(machine.axes.size());
  for (const double regulator_Hz : {12.0, 3.0, 1.0}) {
    axis.loop->regulator_Hz = regulator_Hz;
    const CommissionPlan plan = PlanCommissioning(machine, "x", 0.0, DefaultCommissionLimits(axis));
    PerAxis<PlanLimits> limits = ProgramLimits(machine);
    limits[0].stiffest_spring_N_m = StiffestSpring_N_m(axis, 1e-3);
    const std::string steps = StepsOfTorque(plan);
    EXPECT_NO_THROW(PlanMotion(ParseProgram(steps, "steps", ProgramFormat::kYaml), start_m, limits))
        << regulator_Hz << steps;
  }
  axis.limits.following_error_mm = 1.0;
  // Where the drive holds the axis no spring acts, and none gives it more way.
  EXPECT_GT(NumberOf(StepsOfTorque(PlanCommissioning(machine, "x", 0.0, DefaultCommissionLimits(axis))),
                     "travel_mm: "),
            0.3);
  axis.drive.mode = DriveMode::kCsp;
  EXPECT_EQ(NumberOf(StepsOfTorque(PlanCommissioning(machine, "x", 0.0, DefaultCommissionLimits(axis))),
                     "travel_mm: "),
            0.3);
}

/// The least speed of the motor in its slowest stroke, as a share of it, while the chirp of the plan goes
/// through the screw's mode; on an axis as stated but for this share of the motor.
double SlowestOverStroke(const AxisConfig& axis, const CommissionMotion& motion, double motor_share) {
  const Mechanics m = ToSi(axis.model.mechanics);
  const double motor_kg = motor_share * (m.mass_kg - m.table_mass_kg);
  const double force_N = NumberOf(motion.yaml, "amplitude_Nm: ") / m.radius_m_rad;
  const double from_Hz = NumberOf(motion.yaml, "frequency_min_hz: ");
  const double to_Hz = NumberOf(motion.yaml, "frequency_max_hz: ");
  const double sweep_s = NumberOf(motion.yaml, "period_s: ");
  const double stroke_m_s = 1e-3 * NumberOf(motion.yaml, "velocities_mm_s: [");
  constexpr double kStep_s = 1e-5;
  double motor_m = 0.0, motor_m_s = 0.0, table_m = 0.0, table_m_s = 0.0, slowest = 1.0;
  for (double t = 0.0; t < sweep_s; t += kStep_s) {
    const double growth = (to_Hz - from_Hz) / sweep_s;
    const double push_N = force_N * std::sin(2.0 * M_PI * (from_Hz + 0.5 * growth * t) * t);
    const double screw_N = m.stiffness_N_m * (motor_m - table_m) + m.damping_Ns_m * (motor_m_s - table_m_s);
    motor_m_s += (push_N - screw_N) / motor_kg * kStep_s;
    table_m_s += screw_N / m.table_mass_kg * kStep_s;
    motor_m += motor_m_s * kStep_s;
    table_m += table_m_s * kStep_s;
    // The motor's share of what the two swing by.
    const double swing_m_s = (motor_m_s - table_m_s) * m.table_mass_kg / (motor_kg + m.table_mass_kg);
    slowest = std::min(slowest, 1.0 + swing_m_s / stroke_m_s);
  }
  return slowest;
}

// The screw is seen in strokes that go on: a motor that the chirp turns back at the mode sticks, and cuts
// them.
TEST(CommissionPlanTest, TheChirpTurnsNoMotorBackHoweverHeavyItsTable) {
  MachineConfig machine = Example();
  AxisConfig& axis = machine.axes.at("x");
  const double motor_kg = ToSi(axis.model.mechanics).mass_kg - axis.model.mechanics.table_mass_kg;
  for (const DriveMode mode : {DriveMode::kCst, DriveMode::kCsp})
    for (const double table_over_motor : {0.13, 0.5, 1.0, 1.75, 3.0}) {
      axis.drive.mode = mode;
      axis.model.mechanics.table_mass_kg = table_over_motor * motor_kg;
      axis.limits.torque_Nm = 20.0;
      const CommissionPlan plan = PlanCommissioning(machine, "x", 0.0, DefaultCommissionLimits(axis));
      for (const CommissionMotion& motion : plan.motions) {
        if (motion.yaml.find("kind: chirp") == std::string::npos) continue;
        EXPECT_GT(SlowestOverStroke(axis, motion, 1.0), 0.0) << table_over_motor << ", " << motion.what;
        EXPECT_GT(SlowestOverStroke(axis, motion, 0.7), 0.0) << table_over_motor << ", " << motion.what;
      }
    }
}

// A chirp has a range however slow the cycle; before, one of 5 ms gave speeds that were no numbers.
TEST(CommissionPlanTest, SlowCyclesHaveAChirpToo) {
  MachineConfig machine = Example();
  for (const int cycle_us : {1000, 5000, 20000}) {
    machine.machine.cycle_us = cycle_us;
    const CommissionPlan plan =
        PlanCommissioning(machine, "x", 0.0, DefaultCommissionLimits(machine.axes.at("x")));
    for (const CommissionMotion& motion : plan.motions) {
      EXPECT_EQ(motion.yaml.find("nan"), std::string::npos) << cycle_us << ": " << motion.yaml;
      if (motion.yaml.find("kind: chirp") == std::string::npos) continue;
      const auto number = [&](const std::string& key) {
        return std::stod(motion.yaml.substr(motion.yaml.find(key) + key.size()));
      };
      EXPECT_LE(number("frequency_min_hz: "), 0.6 * number("frequency_max_hz: ")) << cycle_us;
    }
  }
}

// Before: "found 6, expected 20 to 15", whatever was asked for.
TEST(CommissionPlanTest, ASlowAxisOfAFineLeadIsCommissionedAtItsOwnSpeeds) {
  for (const double velocity_mm_s : {15.0, 3.0}) {
    MachineConfig machine = Example();
    AxisConfig& axis = machine.axes.at("x");
    axis.model.mechanics.lead_mm = 1.0;
    axis.limits.velocity_mm_s = velocity_mm_s;
    axis.limits.acceleration_mm_s2 = 200.0;  // what the torque allows with such a lead
    const CommissionLimits limits = DefaultCommissionLimits(axis);
    EXPECT_LE(limits.max_speed_mm_s, velocity_mm_s);
    CommissionLimits all_it_has = limits;
    all_it_has.max_torque_Nm = axis.limits.torque_Nm;
    std::size_t instants = 0;
    for (const CommissionMotion& motion : PlanCommissioning(machine, "x", 0.0, all_it_has).motions) {
      const auto plan = PlanMotion(ParseProgram(motion.yaml, motion.what, ProgramFormat::kYaml),
                                   PerAxis<double>(2), ProgramLimits(machine));
      PerAxis<ReferencePoint> at(2);
      for (double t_s = 0.0; t_s < plan->duration_s(); t_s += 5e-3, ++instants) {
        plan->At(t_s, at);
        ASSERT_LE(1e3 * std::abs(at[0].velocity_m_s), 1.001 * limits.max_speed_mm_s) << motion.yaml;
      }
    }
    EXPECT_GT(instants, 1000U);
  }
}

TEST(CommissionPlanTest, NamesAWayThatShowsMoreOfTheScrewWhereThereIsOne) {
  AxisConfig axis = Example().axes.at("x");
  axis.limits.position_mm = {-15.0, 15.0};
  EXPECT_NE(MoreOfTheScrew(axis, 3.0).find("--travel_mm 20 (it was 3)"), std::string::npos);
  axis.limits.position_mm = {-5.0, 5.0};
  EXPECT_NE(MoreOfTheScrew(axis, 3.0).find("--travel_mm 10 (it was 3)"), std::string::npos);
  EXPECT_EQ(MoreOfTheScrew(axis, 10.0).find("--travel_mm"), std::string::npos);
}

// What nothing showed is as unsure as before, however well the sum of the masses is known.
TEST(CommissionPlanTest, AScrewThatDidNotShowIsAsOpenAsItWas) {
  ModelConfig stated = Example().axes.at("x").model;
  stated.uncertainty.clear();
  ModelConfig found = stated;
  found.uncertainty = {{"motor_inertia_kgm2", 0.007}, {"table_mass_kg", 0.007}, {"Fc_plus_N", 0.01}};
  LeaveScrewOpen(found, stated, false);
  EXPECT_NEAR(found.uncertainty.at("screw_stiffness_N_um"), 0.5 * std::log(2.0), 1e-12);
  EXPECT_NEAR(found.uncertainty.at("motor_inertia_kgm2"), 0.15, 1e-12);
  EXPECT_NEAR(found.uncertainty.at("table_mass_kg"), 0.15, 1e-12);
  EXPECT_EQ(found.uncertainty.at("Fc_plus_N"), 0.01);
  // Doubt that the model states itself is smaller.
  stated.uncertainty["screw_stiffness_N_um"] = 0.1;
  found.uncertainty.erase("screw_stiffness_N_um");
  LeaveScrewOpen(found, stated, false);
  EXPECT_NEAR(found.uncertainty.at("screw_stiffness_N_um"), 0.1, 1e-12);
  // Stiffness that a linear scale showed is known.
  found.uncertainty = {{"screw_stiffness_N_um", 0.02}};
  LeaveScrewOpen(found, stated, true);
  EXPECT_EQ(found.uncertainty.at("screw_stiffness_N_um"), 0.02);
  EXPECT_NEAR(found.uncertainty.at("table_mass_kg"), 0.15, 1e-12);
}

TEST(CommissionPlanTest, RefusesWhatDoesNotFitAndSaysWhatDoes) {
  EXPECT_NE(Refusal(0.0, {500.0, 100.0, 0.9}).find("--travel_mm: found 500"), std::string::npos);
  EXPECT_NE(Refusal(0.0, {3.0, 100.0, 0.9}).find("whole turn"), std::string::npos);
  EXPECT_NE(Refusal(0.0, {20.0, 300.0, 0.9}).find("--max_speed_mm_s: found 300"), std::string::npos);
  EXPECT_NE(Refusal(0.0, {20.0, 100.0, 2.0}).find("--max_torque_Nm: found 2"), std::string::npos);
  EXPECT_NE(Refusal(0.0, {20.0, 100.0, 0.2}).find("--max_torque_Nm: found 0.2"), std::string::npos);
  EXPECT_NE(Refusal(199.9, {20.0, 100.0, 0.9}).find("move it away from its end"), std::string::npos);
  EXPECT_EQ(Refusal(0.0, {20.0, 100.0, 0.9}), "");
}

}  // namespace
}  // namespace contour::test
