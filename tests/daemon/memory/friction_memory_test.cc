#include "daemon/memory/friction_memory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "tests/closed_loop/test_machine.h"

namespace contour::test {
namespace {

namespace fs = std::filesystem;

/// An emulated machine whose friction varies along the stroke, and what is kept of it.
class FrictionMemoryTest : public testing::Test {
 protected:
  FrictionMemoryTest()
      : directory_(fs::temp_directory_path() / ("friction_memory_" + std::to_string(getpid()))) {}
  ~FrictionMemoryTest() override { fs::remove_all(directory_); }

  static std::vector<std::string> Set(bool absolute = true) {
    std::vector<std::string> set{"memory.friction_map=true"};
    for (const std::string axis : {"x", "y"}) {
      set.push_back("emulator.axes." + axis + ".friction.position_amplitude_rel=0");
      set.push_back("emulator.axes." + axis +
                    ".effects.position_friction={amplitude_rel: 0.25, periods_per_stroke: 4}");
      set.push_back("axes." + axis + ".drive.absolute_encoder=" + (absolute ? "true" : "false"));
      if (!absolute) set.push_back("axes." + axis + ".limits.unreferenced_travel_mm=1000");
    }
    return set;
  }

  /// Some strokes over most of the way, watched as the pump would.
  void Travel(const std::vector<std::string>& set,
              const std::function<void(FrictionMemory&)>& at_the_end = {}) const {
    const EmulatedMachineFile file = ExampleMachine(set);
    FrictionMemory memory(file.machine, directory_);
    VirtualMachine machine(file, ControllerName::kFull);
    machine.BringUp();
    machine.Enable();
    machine.SetObserver(
        [&](const CycleEntry& entry, const TruthRow*) { memory.Consume(entry.output.record); });
    memory.Start();
    machine.Run(
        ParseProgram("{sequence: [{shape: line, dx_mm: 170, dy_mm: 170, feed_mm_min: 6000},"
                     " {sequence: [{shape: line, dx_mm: -340, dy_mm: -340, feed_mm_min: 6000},"
                     " {shape: line, dx_mm: 340, dy_mm: 340, feed_mm_min: 6000}], repeats: 3}]}",
                     "strokes of the test", ProgramFormat::kYaml));
    memory.Finish();
    if (at_the_end) at_the_end(memory);
  }

  fs::path directory_;
};

TEST_F(FrictionMemoryTest, TheNextStartKnowsTheStrokeAndDrawsBetter) {
  Travel(Set());
  std::vector<std::string> set = Set();
  const FrictionMemory memory(ExampleMachine(set).machine, directory_);
  EXPECT_EQ(memory.used().size(), 2u);
  EXPECT_TRUE(memory.refused().empty());
  // The other law finds such friction by itself, and has an error of its own that hides it.
  set.push_back("control.friction=srukf");
  const Program circle = Circle(10.0, 2, 0.7957747155);
  const RunResult before = RunCircle(ExampleMachine(set), ControllerName::kFull, circle);
  for (const std::string& learnt : memory.Overrides()) set.push_back(learnt);
  const EmulatedMachineFile file = ExampleMachine(set);
  const RunResult after = RunCircle(file, ControllerName::kFull, circle);
  EXPECT_LT(after.table_peak_m, 0.7 * before.table_peak_m);

  // The shape itself, where the axis went.
  const auto& map = *file.machine.axes.at("x").model.extensions.position_friction;
  double largest = 0.0;
  for (std::size_t i = 0; i < map.position_mm.size(); ++i) {
    if (std::abs(map.position_mm[i]) > 150.0) continue;
    const double truth = 0.25 * std::sin(2.0 * M_PI * 4.0 * map.position_mm[i] / 400.0);
    largest = std::max(largest, std::abs(map.friction_rel[i] - truth));
  }
  EXPECT_LT(largest, 0.08);
}

TEST_F(FrictionMemoryTest, WithoutAnAbsoluteEncoderNothingIsKept) {
  Travel(Set(false));
  EXPECT_FALSE(fs::exists(directory_));
}

TEST_F(FrictionMemoryTest, ADamagedFileIsRefusedAndReplaced) {
  fs::create_directories(directory_);
  const fs::path file = directory_ / "xy_table_x_friction.yaml";
  std::ofstream(file) << "format: 1\n";
  {
    const FrictionMemory memory(ExampleMachine(Set()).machine, directory_);
    EXPECT_TRUE(memory.used().empty());
    ASSERT_EQ(memory.refused().size(), 1u);
    EXPECT_NE(memory.refused().front().find("axis x"), std::string::npos);
    EXPECT_TRUE(memory.Overrides().empty());
  }
  Travel(Set());
  const FrictionMemory memory(ExampleMachine(Set()).machine, directory_);
  EXPECT_EQ(memory.used().size(), 2u);
}

TEST_F(FrictionMemoryTest, WhatCouldNotBeWrittenIsTriedAgain) {
  std::ofstream(directory_) << "a file where the directory should be";
  Travel(Set(), [this](FrictionMemory& memory) {
    EXPECT_FALSE(fs::is_directory(directory_));
    fs::remove(directory_);
    // No new pass since.
    memory.Start();
    memory.Finish();
  });
  const FrictionMemory memory(ExampleMachine(Set()).machine, directory_);
  EXPECT_EQ(memory.used().size(), 2u);
}

TEST_F(FrictionMemoryTest, AModelThatStatesItsOwnMapHasTheSay) {
  Travel(Set());
  std::vector<std::string> set = Set();
  set.push_back(
      "axes.x.model.extensions.position_friction={position_mm: [-200, 200], friction_rel: [0.1, -0.1]}");
  const FrictionMemory memory(ExampleMachine(set).machine, directory_);
  ASSERT_EQ(memory.Overrides().size(), 1u);
  EXPECT_TRUE(memory.Overrides().front().starts_with("axes.y."));
}

TEST_F(FrictionMemoryTest, OffIsOff) {
  std::vector<std::string> set = Set();
  set.push_back("memory.friction_map=false");
  Travel(set);
  EXPECT_FALSE(fs::exists(directory_));
}

}  // namespace
}  // namespace contour::test
