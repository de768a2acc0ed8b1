#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tests/closed_loop/test_machine.h"

// An encoder of 10 000 counts, 0.5 um each, where the examples have 5 nm.
namespace contour::test {
namespace {

// What a search finds for it: the example's loop answers each count by 4 % of rated torque.
constexpr const char* kLoop =
    "{regulator_Hz: 22.1, windup_weight: 0.0324, velocity_weight: 0.276, disturbance_Hz: 130, "
    "motor_force_Hz: "
    "358, table_force_Hz: 222, notch_ratio: 0.756, notch_pole_damping: 0.1, notch_zero_damping: 0.0755}";

// An axis braked into the last counts of its way stood there under a torque that went back to nothing, by
// more than friction: that was told as a frozen encoder, on ten of ten seeds.
TEST(CoarseEncoder, AnAxisThatHasJustBrakedIsNotFrozen) {
  const Program square =
      ParseProgram("{shape: square, side_mm: 10, feed_mm_min: 3000, turns: 15, corners: velocity_jump}",
                   "square of the test", ProgramFormat::kYaml);
  for (const std::uint64_t seed : {1u, 2u}) {
    std::vector<std::string> set{"emulator.seed=" + std::to_string(seed)};
    for (const std::string axis : {"x", "y"}) {
      set.push_back("axes." + axis + ".drive.encoder_counts_per_rev=10000");
      set.push_back("axes." + axis + ".drive.mode=cst");
      set.push_back("axes." + axis + ".limits.safe_travel_mm=3");
      set.push_back("axes." + axis + ".loop=" + kLoop);
    }
    VirtualMachine machine(ExampleMachine(set), ControllerName::kFull);
    machine.BringUp();
    machine.Enable();
    EXPECT_NO_THROW(machine.Run(square)) << seed;
  }
}

}  // namespace
}  // namespace contour::test
