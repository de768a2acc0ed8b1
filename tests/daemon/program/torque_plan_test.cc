#include "daemon/program/torque_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "daemon/program/torque_steps_plan.h"
#include "tests/daemon/program/on_a_table.h"

namespace contour {
namespace {

using testing::ErrorOf;
using testing::PlanOf;
using testing::Yaml;

ReferencePoint At(const MotionPlan& plan, double time_s, std::size_t axis = 0) {
  PerAxis<ReferencePoint> axes;
  plan.At(time_s, axes);
  return axes[axis];
}

TEST(TorquePlan, ChirpRidesOnTheMotion) {
  const std::string motion = "shape: line\ndx_mm: 100\nfeed_mm_min: 3000\n";
  const auto bare = PlanOf(Yaml(motion));
  const auto plan =
      PlanOf(Yaml(motion + "torque: {axis: x, kind: chirp, amplitude_Nm: 0.1, frequency_min_hz: 100, "
                           "frequency_max_hz: 480, period_s: 1}\n"));
  EXPECT_EQ(plan->duration_s(), bare->duration_s());
  double peak = 0.0;
  int crossings = 0;
  double previous = 0.0;
  for (int k = 0; k < 20000; ++k) {
    const double t = 1.0 + 5e-5 * k;  // one period of the chirp, away from the fades
    const ReferencePoint p = At(*plan, t);
    EXPECT_EQ(p.position_m, At(*bare, t).position_m);
    peak = std::max(peak, std::abs(p.extra_torque_Nm));
    if ((p.extra_torque_Nm > 0.0) != (previous > 0.0)) ++crossings;
    previous = p.extra_torque_Nm;
  }
  EXPECT_NEAR(peak, 0.1, 1e-3);
  EXPECT_NEAR(crossings, 2.0 * 290.0, 4.0) << "mean frequency of 290 Hz over one second";
  EXPECT_EQ(At(*plan, 0.0).extra_torque_Nm, 0.0);
  EXPECT_EQ(At(*plan, plan->duration_s()).extra_torque_Nm, 0.0);
  EXPECT_EQ(At(*plan, 1.3, 1).extra_torque_Nm, 0.0);
}

TEST(TorquePlan, PulsesBringSpeedAndPositionBack) {
  const auto plan =
      PlanOf(Yaml("shape: hold\nseconds: 2\n"
                  "torque: {axis: y, kind: pulses, amplitude_Nm: 0.5, width_s: 0.004, period_s: 0.25}\n"));
  double speed = 0.0;
  double way = 0.0;
  double furthest = 0.0;
  for (int k = 0; k < 100000; ++k) {  // four groups, away from the fades and from the edges of the pulses
    speed += 1e-5 * At(*plan, 0.45 + 1e-5 * (k + 0.5), 1).extra_torque_Nm;
    way += 1e-5 * speed;
    furthest = std::max(furthest, std::abs(way));
  }
  EXPECT_GT(furthest, 0.5 * 0.004 * 0.004 * 0.9);
  EXPECT_NEAR(speed, 0.0, 0.02 * 0.5 * 0.004);
  EXPECT_NEAR(way, 0.0, 0.02 * furthest);
}

TEST(TorquePlan, MultisineStaysWithinTheTorqueItWasCheckedFor) {
  const std::string text =
      "shape: hold\nseconds: 3\n"
      "torque: {axis: x, kind: multisine, amplitude_Nm: 0.15, frequency_min_hz: 5, frequency_max_hz: 150, "
      "lines: 10}\n";
  double peak = 0.0;
  const auto plan = PlanOf(Yaml(text));
  for (double t = 0.0; t < 3.0; t += 1e-4) peak = std::max(peak, std::abs(At(*plan, t).extra_torque_Nm));
  EXPECT_GT(peak, 0.4);
  EXPECT_LT(peak, 1.5);
  std::string louder = text;
  louder.replace(louder.find("0.15"), 4, "0.9");
  EXPECT_NE(ErrorOf([&] { PlanOf(Yaml(louder)); }).find("axis x: extra torque of"), std::string::npos);
}

TEST(TorquePlan, RefusesFrequenciesFromHalfTheCyclesRateOn) {
  PerAxis<PlanLimits> limits = testing::TableLimits();
  for (PlanLimits& l : limits) l.cycle_s = 1e-3;
  for (const char* kind : {"chirp", "multisine"}) {
    const auto error = [&](const std::string& highest_hz) {
      const std::string text =
          std::string("shape: hold\nseconds: 2\ntorque: {axis: x, kind: ") + kind +
          ", amplitude_Nm: 0.01,\n  frequency_min_hz: 10, frequency_max_hz: " + highest_hz + "}\n";
      return ErrorOf([&] { PlanMotion(Yaml(text), testing::Point(0.0, 0.0), limits); });
    };
    EXPECT_EQ(error("2000"),
              "test.yaml:4: torque.frequency_max_hz: found 2000, expected less than 500, half the cycle's "
              "rate: the torque is set once per cycle");
    EXPECT_NE(error("500"), "");
    EXPECT_EQ(error("499"), "");
  }
}

TEST(TorquePlan, TheAxisMustExist) {
  EXPECT_NE(ErrorOf([] {
              PlanOf(Yaml("shape: hold\nseconds: 3\ntorque: {axis: z, kind: pulses, amplitude_Nm: 0.2}\n"));
            }).find("axis z: the machine has no such axis"),
            std::string::npos);
}

const std::string kSteps = "shape: torque_steps\naxis: x\ntravel_mm: 0.25\ntorques_Nm: [0.04, -0.06]\n";

TEST(TorqueStepsPlan, StepsInOrderWithAWeakSpring) {
  const auto plan = PlanOf(Yaml(kSteps));
  const auto* steps = dynamic_cast<const TorqueStepsPlan*>(plan.get());
  ASSERT_NE(steps, nullptr);
  // 0.06 Nm are 75 N at this screw; they may push the axis by 0.25 mm.
  EXPECT_NEAR(steps->spring_N_m(), 75.0 / 0.25e-3, 1.0);
  const double begin = 0.3;
  EXPECT_NEAR(At(*plan, begin + 0.1).extra_torque_Nm, 0.02, 1e-12) << "half risen";
  EXPECT_NEAR(At(*plan, begin + 0.35).extra_torque_Nm, 0.04, 1e-12);
  EXPECT_NEAR(At(*plan, begin + 0.85).extra_torque_Nm, 0.0, 1e-12);
  EXPECT_NEAR(At(*plan, begin + 1.35).extra_torque_Nm, -0.06, 1e-12);
  for (double t = 0.01; t < plan->duration_s() - 0.01; t += 0.01) {
    EXPECT_GE(At(*plan, t).spring_N_m, steps->spring_N_m() * (1.0 - 1e-12)) << t;
    EXPECT_EQ(At(*plan, t).position_m, 0.003);
    EXPECT_EQ(At(*plan, t, 1).spring_N_m, 0.0);
  }
  EXPECT_GT(At(*plan, plan->duration_s() - 1e-3).spring_N_m, 5.0 * steps->spring_N_m());
  EXPECT_EQ(At(*plan, plan->duration_s()).spring_N_m, 0.0);
  EXPECT_NEAR(plan->duration_s(), 0.6 + 2.0 * 1.0, 1e-12);
}

TEST(TorqueStepsPlan, RefusesWhatIsNotSafe) {
  const auto error = [](const char* from, const char* to) {
    std::string text = kSteps;
    text.replace(text.find(from), std::string(from).size(), to);
    return ErrorOf([&] { PlanOf(Yaml(text)); });
  };
  EXPECT_NE(error("-0.06", "-1.6").find("axis x: torques_Nm: 1.6 is beyond the limit of 1.5 Nm"),
            std::string::npos);
  EXPECT_NE(error("0.25", "0.6").find("axis x: travel_mm 0.6 is beyond the limit of 0.45 mm"),
            std::string::npos);
  EXPECT_NE(error("0.25", "0.02").find("travel_mm 0.02 is too short"), std::string::npos);
}

// A loop that knows two inertias is the spring itself, and no stiffer than it can be.
TEST(TorqueStepsPlan, IsNoStifferThanTheAxissLoopCanBe) {
  PerAxis<PlanLimits> limits = testing::TableLimits();
  const double needed_N_m = 75.0 / 0.25e-3;
  limits[0].stiffest_spring_N_m = 1.5 * needed_N_m;
  const auto plan = PlanMotion(Yaml(kSteps), testing::Point(0.0, 0.0), limits);
  EXPECT_NEAR(At(*plan, 1e-6).spring_N_m, 1.5 * needed_N_m, 1e-3 * needed_N_m);
  limits[0].stiffest_spring_N_m = 0.5 * needed_N_m;
  EXPECT_NE(ErrorOf([&] {
              PlanMotion(Yaml(kSteps), testing::Point(0.0, 0.0), limits);
            }).find("travel_mm 0.25 is too short to hold 0.06 Nm by a spring, expected at least 0.5"),
            std::string::npos);
}

TEST(CombinedPlans, ASequenceGoesOnWhereTheLastPartEnded) {
  const auto plan = PlanOf(Yaml(
      "sequence:\n  - {shape: line, dx_mm: 10, dy_mm: 2, feed_mm_min: 600}\n  - {shape: hold, seconds: 1}\n"
      "repeats: 3\n"));
  EXPECT_NEAR(At(*plan, plan->duration_s()).position_m, 0.003 + 0.030, 1e-12);
  EXPECT_NEAR(At(*plan, plan->duration_s(), 1).position_m, -0.004 + 0.006, 1e-12);
  double last = 0.003;
  for (double t = 0.0; t < plan->duration_s(); t += 1e-3) {
    const double now = At(*plan, t).position_m;
    EXPECT_LT(std::abs(now - last), 1.1e-5) << "no jump at " << t;
    last = now;
  }
  EXPECT_NE(ErrorOf([] {
              PlanOf(Yaml("sequence:\n  - {shape: line, dx_mm: 100, feed_mm_min: 6000}\nrepeats: 3\n"));
            }).find("position 203 mm"),
            std::string::npos)
      << "the limits hold where each part begins";
}

TEST(CombinedPlans, TogetherMovesEachAxisByItsOwnPart) {
  const auto plan =
      PlanOf(Yaml("together:\n  - {shape: sine, axis: y, amplitude_mm: 5, frequency_hz: 1, cycles: 4}\n"
                  "  - {shape: creep, axis: x, stroke_mm: 10, velocities_mm_s: [20]}\n"));
  const auto sine = PlanOf(Yaml("{shape: sine, axis: y, amplitude_mm: 5, frequency_hz: 1, cycles: 4}"));
  const auto creep = PlanOf(Yaml("{shape: creep, axis: x, stroke_mm: 10, velocities_mm_s: [20]}"));
  EXPECT_EQ(plan->duration_s(), std::max(sine->duration_s(), creep->duration_s()));
  for (double t = 0.0; t < plan->duration_s(); t += 0.01) {
    EXPECT_EQ(At(*plan, t).position_m, At(*creep, t).position_m);
    EXPECT_EQ(At(*plan, t, 1).position_m, At(*sine, t, 1).position_m);
  }
  EXPECT_NE(ErrorOf([] {
              PlanOf(
                  Yaml("together:\n  - {shape: sine, axis: x, amplitude_mm: 5, frequency_hz: 1}\n"
                       "  - {shape: creep, axis: x, stroke_mm: 10, velocities_mm_s: [20]}\n"));
            }).find("axis x is moved by two parts"),
            std::string::npos);
}

TEST(CombinedPlans, DistanceOfWhatRunsTogetherIsThatOfEachFigureInItsAxes) {
  PerAxis<PlanLimits> limits = testing::TableLimits();
  for (const char* axis : {"z", "u", "w"}) {
    limits.push_back(limits[0]);
    limits[limits.size() - 1].axis = axis;
  }
  const PerAxis<double> start(limits.size());
  const auto plan =
      PlanMotion(Yaml("together:\n  - {shape: circle, radius_mm: 5, feed_mm_min: 2000, axes: [x, y]}\n"
                      "  - {sequence: [{shape: creep, axis: z, stroke_mm: 3, velocities_mm_s: [20]}, "
                      "{shape: creep, axis: u, stroke_mm: 4, velocities_mm_s: [20]}]}\n"),
                 start, limits);
  for (double t = 0.0; t < plan->duration_s(); t += 0.01) {
    PerAxis<ReferencePoint> at;
    plan->At(t, at);
    PerAxis<double> place_m;
    for (const ReferencePoint& p : at) place_m.push_back(p.position_m);
    ASSERT_LT(plan->Distance_m(place_m), 1e-12) << t;
    // The axis that nothing moves, away from where it stands.
    place_m[4] += 4e-6;
    ASSERT_NEAR(plan->Distance_m(place_m), 4e-6, 1e-12) << t;
    // Away from the circle, along its radius from the centre that it turns about.
    const double centre_m[2] = {-0.005, 0.0};
    for (std::size_t i = 0; i < 2; ++i) place_m[i] += 3e-6 * (place_m[i] - centre_m[i]) / 0.005;
    ASSERT_NEAR(plan->Distance_m(place_m), 5e-6, 1e-12) << t;
  }
}

TEST(CombinedPlans, ReversalsReachEveryAmplitude) {
  const auto plan =
      PlanOf(Yaml("{shape: reversals, axis: x, amplitudes_mm: [0.001, 0.1, 2], frequency_hz: 2, cycles: 3}"));
  double first = 0.0;
  double all = 0.0;
  for (double t = 0.0; t < plan->duration_s(); t += 1e-3) {
    const double away = std::abs(At(*plan, t).position_m - 0.003);
    if (t < 1.5) first = std::max(first, away);
    all = std::max(all, away);
  }
  EXPECT_NEAR(first, 1e-6, 1e-8);
  EXPECT_NEAR(all, 2e-3, 1e-5);
}

}  // namespace
}  // namespace contour
