// An axis that stands, or is enabled, stands: whatever was learnt before, and with a model that is off.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/closed_loop/test_machine.h"

namespace contour::test {
namespace {

constexpr double kQuiet_s = 3.0;  // of six, from here on
constexpr double kMost_m = 0.1e-6;

Program Text(const std::string& text) {
  return ParseProgram(text, "program of the test", ProgramFormat::kYaml);
}

/// What one run shows, the larger of both axes.
struct Shown {
  Reason stopped = Reason::kNone;
  double hold_m = 0.0;  ///< peak to peak of the table, at the end of a hold
  int gated = 0;        ///< readings that the filter did not believe
};

class Observed {
 public:
  explicit Observed(VirtualMachine& machine) {
    machine.SetObserver([this](const CycleEntry& entry, const TruthRow* truth) {
      const CycleRecord& r = entry.output.record;
      if (r.state != MachineState::kRunning || truth == nullptr) return;
      for (std::size_t i = 0; i < 2; ++i) {
        if (r.axes[i].estimate.limit == Reason::kInnovationGated) ++shown_.gated;
        if (r.axes[i].reference.velocity_m_s != 0.0) since_s_ = r.path_time_s;
        const double at_m = truth->axes[i].table_position_m;
        if (r.path_time_s < since_s_ + kQuiet_s) {
          low_m_[i] = high_m_[i] = at_m;
        } else {
          low_m_[i] = std::min(low_m_[i], at_m);
          high_m_[i] = std::max(high_m_[i], at_m);
        }
        shown_.hold_m = std::max(high_m_[0] - low_m_[0], high_m_[1] - low_m_[1]);
      }
    });
  }
  [[nodiscard]] const Shown& shown() const { return shown_; }

 private:
  Shown shown_;
  double since_s_ = 0.0;
  std::array<double, 2> low_m_{}, high_m_{};
};

// Before: seeds 2, 4 and 5 swung by 1.6, 1.3 and 1.1 um at 16 Hz, sigma0 learnt three times too stiff.
TEST(StableFirst, AnAxisStandsAfterCornersWithoutHelpFromTheSupervisor) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    EmulatedMachineFile file = ExampleMachine({"control.supervision.half_waves=0"});
    file.emulator.seed = seed;
    VirtualMachine machine(file, ControllerName::kFull);
    machine.BringUp();
    machine.Enable();
    const Observed seen(machine);
    machine.Run(
        Text("{sequence: [{shape: square, side_mm: 10, feed_mm_min: 3000, turns: 4, corners: continuous}, "
             "{shape: hold, seconds: 6}]}"));
    std::printf("seed %d: %.3f um\n", static_cast<int>(seed), 1e6 * seen.shown().hold_m);
    EXPECT_LE(seen.shown().hold_m, kMost_m) << "seed " << seed;
  }
}

/// How a model is off, and the bristle that it is off from.
struct Off {
  double sigma0_N_m;
  double sigma0;
  double stiffness;
  double mass;  ///< true over stated
  bool supervised;
};

std::string Set(const std::string& key, double value) {
  std::array<char, 120> text{};
  std::snprintf(text.data(), text.size(), "%s=%.9g", key.c_str(), value);
  return text.data();
}

Shown EnabledAndHeld(const Off& off, const char* mode) {
  std::vector<std::string> set;
  if (!off.supervised) set.emplace_back("control.supervision.half_waves=0");
  for (const std::string axis : {"x", "y"}) {
    const std::string model = "axes." + axis + ".model.", true_axis = "emulator.axes." + axis + ".";
    set.push_back("axes." + axis + ".drive.mode=" + mode);
    set.push_back(Set(true_axis + "friction.sigma0_N_m", off.sigma0_N_m));
    set.push_back(Set(model + "friction.sigma0_N_m", off.sigma0 * off.sigma0_N_m));
    set.push_back(Set(model + "screw_stiffness_N_um", off.stiffness * 40.0));
    set.push_back(Set(true_axis + "table_mass_kg", off.mass * 10.0));
    set.push_back(Set(true_axis + "motor_inertia_kgm2", off.mass * 5e-5));
  }
  VirtualMachine machine(ExampleMachine(set), ControllerName::kFull);
  machine.BringUp();
  machine.Enable();
  // A slow line leaves the bristles somewhere, and the drives are enabled anew.
  machine.Run(Text("{shape: line, dx_mm: 3.3, dy_mm: -2.1, feed_mm_min: 600}"));
  machine.mailbox().Post(RequestKind::kDisable);
  for (int k = 0; k < 2000 && machine.record().state != MachineState::kIdle; ++k) machine.Tick();
  machine.Enable();
  const Observed seen(machine);
  Shown shown;
  try {
    machine.Run(Text("{shape: hold, seconds: 6}"));
  } catch (const std::runtime_error&) {
    shown.stopped = machine.record().reason;
  }
  shown.hold_m = seen.shown().hold_m;
  return shown;
}

class ModelOff : public ::testing::TestWithParam<const char*> {};

void ExpectStands(double sigma0_N_m, bool supervised, const char* mode) {
  for (const double sigma0 : {1.0 / 3.0, 0.6, 3.0})
    for (const double stiffness : {1.0 / 3.0, 1.0, 3.0})
      // Lighter than stated the loop itself is too stiff for a bristle like that:
      // docs/laboratory/stable_first.md.
      for (const double mass : {supervised ? 1.0 : 0.7, 1.3}) {
        const Shown shown = EnabledAndHeld({sigma0_N_m, sigma0, stiffness, mass, supervised}, mode);
        if (supervised && shown.stopped == Reason::kOscillation) continue;
        EXPECT_EQ(shown.stopped, Reason::kNone) << Name(shown.stopped);
        EXPECT_LE(shown.hold_m, kMost_m)
            << "sigma0 stated x " << sigma0 << ", K x " << stiffness << ", mass x " << mass;
      }
}

// The friction of the example machine: without help from the supervisor. Before: swings of up to 2.5 um where
// sigma0 was stated three times too stiff.
TEST_P(ModelOff, AnAxisThatIsEnabledStands) { ExpectStands(5e6, false, GetParam()); }

// A bristle nearly as stiff as the screw. In cst a loop that is tuned for a heavier axis swings against it
// where it is stated too soft; the supervisor softens the loop, and the axis stands.
TEST_P(ModelOff, AnAxisWithAStiffBristleStandsOrIsStopped) { ExpectStands(3e7, true, GetParam()); }

INSTANTIATE_TEST_SUITE_P(Each, ModelOff, ::testing::Values("cst", "csp"),
                         [](const auto& one) { return std::string(one.param); });

// Before: some readings of a corner were left out, because what mass, delay and an outside force may do in a
// period was not counted.
TEST(StableFirst, NoReadingOfASoundSquareIsLeftOut) {
  for (const double mass : {0.7, 1.0, 1.3}) {
    std::vector<std::string> set;
    for (const std::string axis : {"x", "y"}) {
      set.push_back(Set("emulator.axes." + axis + ".table_mass_kg", mass * 10.0));
      set.push_back(Set("emulator.axes." + axis + ".motor_inertia_kgm2", mass * 5e-5));
    }
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      EmulatedMachineFile file = ExampleMachine(set);
      file.emulator.seed = seed;
      VirtualMachine machine(file, ControllerName::kFull);
      machine.BringUp();
      machine.Enable();
      const Observed seen(machine);
      machine.Run(Text("{shape: square, side_mm: 10, feed_mm_min: 3000, turns: 2, corners: continuous}"));
      EXPECT_EQ(seen.shown().gated, 0) << "mass x " << mass << ", seed " << seed;
    }
  }
}

/// How the stated band of the friction relates to its error, over a run.
struct Band {
  double ratio = 0.0;  ///< root mean square of sigma over that of the error
  double inside = 0.0;
};

Band BandOf(const std::vector<std::string>& set) {
  VirtualMachine machine(ExampleMachine(set), ControllerName::kFull);
  machine.BringUp();
  machine.Enable();
  double error2 = 0.0, sigma2 = 0.0;
  std::int64_t inside = 0, rows = 0;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
    const CycleRecord& r = entry.output.record;
    if (r.state != MachineState::kRunning || truth == nullptr || r.path_time_s < 0.5) return;
    for (std::size_t i = 0; i < 2; ++i) {
      const AxisEstimate& e = r.axes[i].estimate;
      const double error_N = e.friction_N - truth->axes[i].friction_N;
      error2 += error_N * error_N;
      sigma2 += e.friction_std_N * e.friction_std_N;
      inside += std::abs(error_N) <= 2.0 * e.friction_std_N ? 1 : 0;
      ++rows;
    }
  });
  machine.Run(Circle(0.1, 5, 0.7853981634));
  return {std::sqrt(sigma2 / error2), static_cast<double>(inside) / static_cast<double>(rows)};
}

// Before: sigma was 3.9 times the error.
TEST(StableFirst, TheBandOfTheFrictionIsHonest) {
  const std::vector<std::string> heavy{"axes.x.model.table_mass_kg=20",
                                       "axes.y.model.table_mass_kg=20",
                                       "emulator.axes.x.table_mass_kg=20",
                                       "emulator.axes.y.table_mass_kg=20",
                                       "control.full.contour_bandwidth_Hz=20",
                                       "control.full.lag_bandwidth_Hz=20",
                                       "axes.x.drive.quick_stop_deceleration_rad_s2=18000",
                                       "axes.y.drive.quick_stop_deceleration_rad_s2=18000",
                                       "axes.x.limits.safe_travel_mm=4",
                                       "axes.y.limits.safe_travel_mm=4"};
  const auto expect = [](const Band& band, double most) {
    std::printf("sigma / error %.2f, inside %.1f %%\n", band.ratio, 100.0 * band.inside);
    EXPECT_LE(band.ratio, most);
    EXPECT_GE(band.inside, 0.9);
  };
  expect(BandOf({}), 2.5);
  expect(BandOf(heavy), 2.75);
}

}  // namespace
}  // namespace contour::test
