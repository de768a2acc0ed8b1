#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "daemon/program/placed_program.h"
#include "tests/daemon/program/motion_seen.h"
#include "tests/daemon/program/on_a_table.h"

// Programs in the words of other posts (samples/), on machines that differ: helices into a pocket with
// machine coordinates and tools, arcs with absolute centres, radii, turns and in every plane, modes of
// corners one after the other, feeds by time, noise, lower case, line numbers, percent signs.
namespace contour {
namespace {

struct Machine {
  std::string name;
  PerAxis<PlanLimits> limits;
};

/// Each axis slower than the one before.
Machine MakeMachine(const std::string& name, double velocity_m_s, double acceleration_m_s2, double jerk_m_s3,
                    double slower, double tolerance_m) {
  Machine machine{name, {}};
  double share = 1.0;
  for (const char* axis : {"x", "y", "z"}) {
    PlanLimits l;
    l.axis = axis;
    l.position_min_m = -0.2;
    l.position_max_m = 0.2;
    l.velocity_m_s = share * velocity_m_s;
    l.acceleration_m_s2 = share * acceleration_m_s2;
    l.jerk_m_s3 = share * jerk_m_s3;
    l.path_tolerance_m = tolerance_m;
    machine.limits.push_back(l);
    share *= slower;
  }
  return machine;
}

std::vector<std::filesystem::path> Samples() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(CONTOUR_SAMPLES)) files.push_back(entry);
  std::sort(files.begin(), files.end());
  return files;
}

std::shared_ptr<const MotionPlan> PlanOf(const std::string& text, const Machine& machine) {
  const PerAxis<double> start_m = [] {
    PerAxis<double> at(3);
    at[0] = at[1] = at[2] = 0.0;
    return at;
  }();
  const Placement place = Placement::Here(start_m);
  ReadOptions options;
  options.referenced = true;
  return PlanPlaced(ReadPlaced({text, "sample.ngc", ProgramFormat::kGcode}, place, machine.limits, options),
                    place, machine.limits);
}

class CamSamples : public ::testing::TestWithParam<int> {};

TEST_P(CamSamples, KeepEveryLimitAndThePath) {
  const Machine machines[] = {MakeMachine("table", 0.25, 5.0, 200.0, 1.0, 1e-5),
                              MakeMachine("heavy", 0.12, 1.5, 20.0, 0.6, 2e-5),
                              MakeMachine("light", 0.8, 20.0, 4000.0, 0.5, 5e-6)};
  const Machine& machine = machines[GetParam()];
  for (const auto& file : Samples()) {
    SCOPED_TRACE(machine.name + ": " + file.filename().string());
    const std::string text = ReadProgramText(file);
    const auto plan = PlanOf(text, machine);
    const testing::MotionSeen seen = testing::SeeMotion(*plan, machine.limits);
    EXPECT_LT(seen.velocity, 1.02);
    EXPECT_LT(seen.acceleration, 1.02);
    EXPECT_LT(seen.jerk, 1.02);
    // The largest tolerance that it asks for itself.
    double tolerance_m = machine.limits[0].path_tolerance_m;
    for (auto at = text.find("G64 P"); at != std::string::npos; at = text.find("G64 P", at + 1))
      tolerance_m = std::max(tolerance_m, 1e-3 * std::stod(text.substr(at + 5)));
    EXPECT_LT(seen.off_path_m, tolerance_m);
    EXPECT_GT(seen.fastest_m_s, 1e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Machines, CamSamples, ::testing::Range(0, 3));

TEST(CamSamplesRefused, CyclesOfTheSpindleByTheirNames) {
  for (const char* cycle : {"G74", "G84", "G86", "G88"}) {
    const std::string text = "G21 G90 F100\nG0 X0 Y0\n" + std::string(cycle) + " X1 Y1 Z-1 R1 P0.1\n";
    const std::string error =
        testing::ErrorOf([&] { PlanOf(text, MakeMachine("table", 0.25, 5.0, 200.0, 1.0, 1e-5)); });
    EXPECT_NE(error.find("sample.ngc:3:1: " + std::string(cycle)), std::string::npos) << error;
    EXPECT_NE(error.find("write its moves"), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace contour
