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

struct Behind {
  const char* machine;
  double lead_mm;
  int counts;
  [[nodiscard]] double count_m() const { return 1e-3 * lead_mm / counts; }
};

/// A machine in csp; one of the family with its near model.
EmulatedMachineFile Machine(const Behind& b) {
  std::vector<std::string> set{"emulator.seed=1"};
  const std::string file = b.machine;
  for (const std::string axis : {"x", "y"}) {
    set.push_back("axes." + axis + ".drive.encoder_counts_per_rev=" + std::to_string(b.counts));
    set.push_back("axes." + axis + ".drive.mode=csp");
    if (file.starts_with("family/"))
      set.push_back("axes." + axis + ".model=near/" + file.substr(7) + "_" + axis + ".yaml");
    else
      set.push_back("axes." + axis + ".limits.safe_travel_mm=3");
  }
  return LoadEmulatedMachine(std::string(CONTOUR_CONFIG_DIR) + "/" + file + ".yaml", set);
}

// What the drive reports there is the noise of its own readings. As friction that nobody foresees it went
// into the wind-up, and was learnt: circles were worse than with the drive alone, on m300 by more than a F /
// K. The table scatters by half a count around its mean, so that a count is what two runs may differ by.
TEST(CoarseEncoder, InCspFullIsNoWorseThanTheDriveAlone) {
  const Program small = Circle(0.1, 3, 0.785398), large = Circle(10.0, 3, 0.795775);
  for (const Behind& b : {Behind{"xy_emulated", 5.0, 10000}, Behind{"family/m300", 10.0, 16384},
                          Behind{"family/lead20", 20.0, 131072}}) {
    for (const Program* circle : {&small, &large}) {
      const double full_m = RunCircle(Machine(b), ControllerName::kFull, *circle).table_peak_m;
      const double alone_m = RunCircle(Machine(b), ControllerName::kCsp, *circle).table_peak_m;
      const double most_m = circle == &large ? 0.75 * alone_m : alone_m + b.count_m();
      EXPECT_LT(full_m, most_m) << b.machine << ", alone " << alone_m;
    }
  }
}

}  // namespace
}  // namespace contour::test
