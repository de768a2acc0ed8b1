#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "design/loop_margins.h"
#include "tests/closed_loop/test_machine.h"
#include "tests/support/drive_faults.h"

namespace contour::test {

/// What is put on the torque between the cycle and the first axis's drive, and where.
struct LoopSweep {
  std::string program;      ///< what the machine does meanwhile
  double force_N = 1.0;     ///< rms at the table
  std::size_t periods = 3;  ///< that are measured, after one
};

/// The running loop, opened at the torque: L of negative feedback at many frequencies.
struct SweptLoop {
  std::vector<double> frequencies_Hz;
  std::vector<Complex> open;
};

/// Sines at bins of a period of so many cycles, evenly over the logarithm of frequency up to nearly half of
/// the sampling frequency, with phases that keep the peak low (Schroeder 1970).
class MultiSine {
 public:
  MultiSine(std::size_t cycles, std::size_t lines, double rms) : push_(cycles) {
    const double low = 4.0, high = 0.4985 * static_cast<double>(cycles);
    for (std::size_t i = 0; i < lines; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(lines - 1);
      const auto bin = static_cast<std::size_t>(std::lround(low * std::pow(high / low, share)));
      if (bins_.empty() || bin > bins_.back()) bins_.push_back(bin);
    }
    const double amplitude = rms * std::sqrt(2.0 / static_cast<double>(bins_.size()));
    for (std::size_t i = 0; i < bins_.size(); ++i) {
      const auto n = static_cast<double>(i);
      const double phase = -std::numbers::pi * n * n / static_cast<double>(bins_.size());
      for (std::size_t k = 0; k < cycles; ++k) push_[k] += amplitude * std::cos(Angle(bins_[i], k) + phase);
    }
  }
  [[nodiscard]] std::size_t cycles() const { return push_.size(); }
  [[nodiscard]] double At(std::size_t k) const { return push_[k % push_.size()]; }
  [[nodiscard]] const std::vector<std::size_t>& bins() const { return bins_; }
  [[nodiscard]] Complex Line(const std::vector<double>& of, std::size_t bin) const {
    Complex sum;
    for (std::size_t k = 0; k < of.size(); ++k) sum += std::polar(of[k], -Angle(bin, k));
    return sum;
  }

 private:
  [[nodiscard]] double Angle(std::size_t bin, std::size_t k) const {
    return 2.0 * std::numbers::pi * static_cast<double>(bin * k % push_.size()) /
           static_cast<double>(push_.size());
  }
  std::vector<double> push_;
  std::vector<std::size_t> bins_;
};

/// Pushes the first axis while the daemon's own cycle controls it. The sum of what it was sent and of the
/// push is S times the push.
inline SweptLoop Sweep(const EmulatedMachineFile& file, const LoopSweep& sweep) {
  constexpr std::size_t kPeriod = 4000, kLines = 240;
  const AxisConfig& axis = file.machine.axes.begin()->second;
  const double radius_m = 1e-3 * axis.model.mechanics.lead_mm / (2.0 * std::numbers::pi);
  const MultiSine sines(kPeriod, kLines, sweep.force_N * radius_m);
  VirtualMachine machine(file, ControllerName::kFull);
  machine.BringUp();
  machine.Enable();
  machine.Start(ParseProgram(sweep.program, "program of the sweep", ProgramFormat::kYaml));
  for (int k = 0; k < 1000; ++k) machine.Tick();
  std::vector<double> push_Nm, sum_Nm;
  for (std::size_t k = 0; k < (sweep.periods + 1) * kPeriod; ++k) {
    // The push meets the command that is on the bus already.
    const double sent_Nm = machine.record().axes[0].torque_Nm;
    DriveFaults::Push(machine.emulated(), 0, sines.At(k));
    machine.Tick();
    if (machine.record().state != MachineState::kRunning)
      throw std::runtime_error("the machine does not run any more");
    if (k < kPeriod) continue;
    push_Nm.push_back(sines.At(k));
    const double unit_Nm = 1e-3 * axis.drive.rated_torque_Nm;
    sum_Nm.push_back(sines.At(k) + unit_Nm * std::round(sent_Nm / unit_Nm));
  }
  double mean_Nm = 0.0;
  for (const double u : sum_Nm) mean_Nm += u / static_cast<double>(sum_Nm.size());
  for (double& u : sum_Nm) u -= mean_Nm;
  SweptLoop swept;
  for (const std::size_t bin : sines.bins()) {
    swept.frequencies_Hz.push_back(static_cast<double>(bin) /
                                   (kPeriod * 1e-6 * file.machine.machine.cycle_us));
    swept.open.push_back(sines.Line(push_Nm, bin) / sines.Line(sum_Nm, bin) - 1.0);
  }
  return swept;
}

}  // namespace contour::test
