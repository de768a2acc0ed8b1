#include "design/drive_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/drive_loop/report_noise.h"
#include "design/drive_motions.h"
#include "design/drive_report.h"
#include "tools/simulate/virtual_machine.h"

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;

TwoInertiaAxis Axis() { return {79.0, 10.0, 4e7, 2000.0, 500.0, 2e-4, 1, 0.0}; }

TEST(DriveLoop, FiguresOfARigidAxisAreThoseOfTheFormula) {
  TwoInertiaAxis rigid = Axis();
  rigid.stiffness_N_m = 1e12;
  rigid.viscous_Ns_m = 0.0;
  rigid.lag_s = 0.0;
  const double mass_kg = rigid.motor_mass_kg + rigid.table_mass_kg;
  // Almost no integral and no delay: L = kv (kp + s) / s^2, |L| = 1 in closed form.
  const DriveLoop loop{mass_kg * 1000.0, 250.0, 1e-3, 0.0, 0.0};
  const DriveLoopFigures f = FiguresOf(rigid, loop, 100.0);
  const double w2 = 0.5 * (1e6 + std::sqrt(1e12 + 4.0 * 1e6 * 250.0 * 250.0));
  EXPECT_NEAR(f.bandwidth_Hz, std::sqrt(w2) / (2.0 * std::numbers::pi), 0.02 * f.bandwidth_Hz);
  EXPECT_NEAR(f.phase_margin_deg, std::atan(std::sqrt(w2) / 250.0) * 180.0 / std::numbers::pi, 1.0);
  EXPECT_NEAR(f.stiffness_1Hz_N_um, 1e-6 * mass_kg * 1000.0 * 250.0, 0.02 * f.stiffness_1Hz_N_um);
  // A slow force moves it by force over stiffness, and not far beyond.
  EXPECT_NEAR(f.step_peak_m, 100.0 / (mass_kg * 1000.0 * 250.0), 0.05 * f.step_peak_m);
}

/// A sliding axis under a periodic chirp, answering by the loop's own response, line by line.
std::vector<DriveSample> Recorded(const DriveLoop& loop, double noise_m) {
  constexpr std::size_t kLength = 500;
  std::vector<double> force(kLength, 0.0), motion(kLength, 0.0);
  const DriveLoopOn on(Axis(), loop);
  for (std::size_t n = 2; n < 180; ++n) {
    const double f = static_cast<double>(n) / (kLength * kPeriod_s);
    const double phase = 0.013 * static_cast<double>(n * n);
    const auto answer = on.OffsetToMotor(f, kPeriod_s);
    for (std::size_t k = 0; k < kLength; ++k) {
      const double turn = 2.0 * std::numbers::pi * static_cast<double>(n * k % kLength) / kLength + phase;
      force[k] += std::cos(turn);
      motion[k] += std::abs(answer) * std::cos(turn + std::arg(answer));
    }
  }
  std::vector<DriveSample> samples;
  std::uint32_t random = 1;
  for (std::size_t k = 0; k < 10 * kLength; ++k) {
    random = random * 1664525u + 1013904223u;
    DriveSample s;
    s.velocity_m_s = 5e-3;
    s.target_m = s.velocity_m_s * kPeriod_s * static_cast<double>(k);
    s.position_m =
        s.target_m + motion[k % kLength] + noise_m * (static_cast<double>(random) / 2147483648.0 - 1.0);
    s.extra_N = s.offset_N = force[k % kLength];
    s.good = true;
    samples.push_back(s);
  }
  return samples;
}

TEST(DriveFit, FindsTheLoopItWasMadeWith) {
  const DriveLoop truth{89.0 * 1300.0, 390.0, 100.0, 3e-4, 1.2e-3};
  const DriveResponse response = MeasureDrive(Recorded(truth, 1e-9), kPeriod_s, 500);
  EXPECT_GE(response.stretches, 8u);
  const DriveFit fit = FitDrive(response, Axis(), kPeriod_s);
  EXPECT_LT(fit.error_rel, 0.05);
  EXPECT_NEAR(fit.loop.velocity_Ns_m, truth.velocity_Ns_m, 0.03 * truth.velocity_Ns_m);
  EXPECT_NEAR(fit.loop.position_1_s, truth.position_1_s, 0.05 * truth.position_1_s);
  EXPECT_NEAR(fit.loop.late_s, truth.late_s, 5e-5);
  EXPECT_NEAR(fit.loop.offset_late_s, truth.offset_late_s, 5e-5);
}

// What a force does shows both gains, and not which is which.
TEST(DriveFit, TellsTheLargerOfTwoGainsThatLookTheSameAsThePositions) {
  const DriveLoop truth{89.0 * 1300.0, 100.0, 390.0, 3e-4, 1.2e-3};
  const DriveFit fit = FitDrive(MeasureDrive(Recorded(truth, 1e-9), kPeriod_s, 500), Axis(), kPeriod_s);
  EXPECT_LT(fit.error_rel, 0.05);
  EXPECT_NEAR(fit.loop.position_1_s, truth.integral_1_s, 0.05 * truth.integral_1_s);
  EXPECT_NEAR(fit.loop.integral_1_s, truth.position_1_s, 0.05 * truth.integral_1_s);
}

TEST(DriveFit, RefusesARecordWithoutExcitation) {
  std::vector<DriveSample> samples = Recorded({89.0 * 1300.0, 390.0, 100.0, 3e-4, 1.2e-3}, 0.0);
  for (DriveSample& s : samples) s.extra_N = 0.0;
  const DriveResponse response = MeasureDrive(samples, kPeriod_s, 500);
  EXPECT_EQ(response.stretches, 0u);
  EXPECT_THROW(FitDrive(response, Axis(), kPeriod_s), std::runtime_error);
}

/// The motions of commissioning on the emulated machine's x axis.
std::vector<DriveSample> Measured(const std::vector<std::string>& overrides) {
  std::vector<std::string> set{"axes.x.drive.mode=csp", "axes.y.drive.mode=csp"};
  set.insert(set.end(), overrides.begin(), overrides.end());
  const EmulatedMachineFile file =
      LoadEmulatedMachine(std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml", set);
  const AxisConfig& axis = file.machine.axes.at("x");
  VirtualMachine machine(file, ControllerName::kFull);
  machine.BringUp();
  const double start_mm = 1e3 * machine.record().axes[0].position_m;
  CommissionPlan plan;
  plan.axis = "x";
  plan.limits = DefaultCommissionLimits(axis);
  plan.low_mm = start_mm - 10.0;
  plan.high_mm = start_mm + 10.0;
  DriveRecorder recorder(0, ToSi(axis.model.mechanics).radius_m_rad);
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow*) { recorder.Add(entry.output.record); });
  machine.Enable();
  for (const CommissionMotion& m : DriveMotions(plan, axis, start_mm, 1000.0))
    machine.Run(ParseProgram(m.yaml, m.what, ProgramFormat::kYaml));
  return recorder.samples();
}

TwoInertiaAxis Stated() {
  const EmulatedMachineFile file =
      LoadEmulatedMachine(std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml", {});
  const ModelConfig& model = file.machine.axes.at("x").model;
  const Mechanics m = ToSi(model.mechanics);
  return ToTwoInertiaAxis(m, ToSi(model.friction, m.radius_m_rad).sigma2_Ns_m, 2e-4, 1);
}

// The model is off by 7 % in the inertia and 11 % in the stiffness; the truth is in config/xy_emulated.yaml.
TEST(DriveFit, MeasuresTheEmulatedDrive) {
  const std::vector<DriveSample> samples = Measured({});
  const DriveFit fit = FitDrive(MeasureDrive(samples, kPeriod_s, 1000), Stated(), kPeriod_s);
  EXPECT_LT(fit.error_rel, 0.1);
  EXPECT_NEAR(fit.loop.velocity_Ns_m, 600.0 * 89.0, 0.1 * 600.0 * 89.0);
  EXPECT_NEAR(fit.loop.position_1_s, 400.0, 40.0);
  EXPECT_NEAR(fit.loop.integral_1_s, 150.0, 40.0);
  const DriveLoopFigures f = FiguresOf(fit.axis, fit.loop, 80.0);
  EXPECT_GT(f.peak, 1.2);
  EXPECT_LT(f.peak, 2.0);
  EXPECT_LT(std::abs(MissingAcceleration(samples, fit.axis, fit.loop, kPeriod_s).missing), 0.3);
}

TEST(DriveReport, AdvisesWhatTheFiguresSay) {
  DriveReport r;
  r.axis = "x";
  r.fit = {{89.0 * 1300.0, 390.0, 100.0, 3e-4, 1.2e-3}, Axis(), 0.03, 400.0, 300};
  r.figures = FiguresOf(Axis(), r.fit.loop, 80.0);
  r.acceleration = {0.1, 0.02};
  EXPECT_EQ(AdvisedShare(r), 0.0) << "friction differs on ramps";
  r.acceleration = {0.96, 0.05};
  EXPECT_EQ(AdvisedShare(r), 1.0);
  EXPECT_NE(Advice(r).find("csp_acceleration_share: 1;"), std::string::npos);
  r.torque_mode_peak_m = 10.0 * r.figures.step_peak_m;
  EXPECT_NE(Advice(r).find("drive.mode: csp holds the table 10.0 times"), std::string::npos) << Advice(r);
  r.torque_mode_peak_m = 0.5 * r.figures.step_peak_m;
  EXPECT_NE(Advice(r).find("drive.mode: cst"), std::string::npos);
  EXPECT_EQ(WhyUnusable(r.fit), "");
  r.fit.error_rel = 0.4;
  EXPECT_NE(WhyUnusable(r.fit), "");
  r.fit.error_rel = 0.03;
  r.fit.highest_Hz = 60.0;
  EXPECT_NE(WhyUnusable(r.fit), "");
}

TEST(DriveReport, SaysWhatACountMakesTheDrivePushBy) {
  DriveReport r;
  r.axis = "x";
  r.fit = {{89.0 * 1300.0, 390.0, 100.0, 3e-4, 1.2e-3}, Axis(), 0.03, 400.0, 300};
  r.figures = FiguresOf(Axis(), r.fit.loop, 80.0);
  EXPECT_EQ(Describe(r).find("flicker"), std::string::npos) << "it was not measured";
  r.count_m = 76.3e-9;
  r.kick_N = 302.0;
  r.friction_N = 300.0;
  EXPECT_NE(Describe(r).find("(76.3 nm) that flicker make it push by 302 N rms, 1.01 of"), std::string::npos)
      << Describe(r);
  EXPECT_NE(Advice(r).find("advice: 4 times the counts per turn"), std::string::npos) << Advice(r);
  EXPECT_NE(Advice(r).find("leaves 0.33 of what"), std::string::npos) << Advice(r);
  EXPECT_NE(Advice(r).find("3.0 times friction"), std::string::npos) << Advice(r);
  r.kick_N = 39.0;
  EXPECT_EQ(Advice(r).find("counts per turn"), std::string::npos) << Advice(r);
}

// With a quarter of the counts the drive answers four times as much.
TEST(DriveFit, SeesWhatACountMakesTheDrivePushBy) {
  const auto kick_N = [](const char* counts) {
    std::vector<std::string> set;
    for (const std::string axis : {"x", "y"}) {
      set.push_back("axes." + axis + ".drive.encoder_counts_per_rev=" + counts);
      set.push_back("emulator.axes." + axis + ".cascade.rest_window_counts=0");
    }
    return ReportNoise_N(Measured(set));
  };
  const double fine_N = kick_N("262144");
  EXPECT_NEAR(kick_N("65536") / fine_N, 4.0, 0.8);
}

TEST(DriveFit, SeesADriveThatDoesNotFeedAccelerationForward) {
  std::vector<std::string> without, by_half;
  for (const std::string axis : {"x", "y"}) {
    without.push_back("emulator.axes." + axis + ".cascade.acceleration_feedforward=0");
    by_half.push_back("emulator.axes." + axis + ".cascade.acceleration_feedforward=0.5");
  }
  const std::vector<DriveSample> samples = Measured(without);
  const DriveFit fit = FitDrive(MeasureDrive(samples, kPeriod_s, 1000), Stated(), kPeriod_s);
  EXPECT_NEAR(MissingAcceleration(samples, fit.axis, fit.loop, kPeriod_s).missing, 1.0, 0.25);
  EXPECT_NEAR(MissingAcceleration(Measured(by_half), fit.axis, fit.loop, kPeriod_s).missing, 0.5, 0.25);
}

}  // namespace
}  // namespace contour
