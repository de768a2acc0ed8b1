#include <cmath>
#include <numbers>
#include <random>

#include "tests/analysis/identification/generated_axis.h"
#include "tools/plant_emulator/axis_plant.h"
#include "tools/plant_emulator/current_loop.h"

namespace contour::test {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr int kTicks = 8;  ///< of the drive's loop, per period
constexpr int kSteps = 4;  ///< of the plant, per tick
constexpr double kTick_s = kPeriod_s / kTicks;
constexpr double kCounts = 1048576.0;
constexpr double kPosition_1_s = 200.0, kVelocity_1_s = 500.0;
constexpr double kFilter = 0.8;  ///< of the velocity, per tick

/// Position P, velocity P on a filtered difference of readings.
class DriveLoop {
 public:
  explicit DriveLoop(double mass_kg) : mass_kg_(mass_kg) {}
  double Force_N(double seen_m, double wanted_m, double wanted_m_s) {
    velocity_m_s_ += kFilter * ((seen_m - before_m_) / kTick_s - velocity_m_s_);
    before_m_ = seen_m;
    return mass_kg_ * kVelocity_1_s * (wanted_m_s + kPosition_1_s * (wanted_m - seen_m) - velocity_m_s_);
  }

 private:
  double mass_kg_;
  double before_m_ = 0.0, velocity_m_s_ = 0.0;
};

}  // namespace

identify::Measured GeneratedAxis::LedByDrive(double seconds, const Path& position_m,
                                             const Path& offset_N) const {
  plant::AxisPlant plant(truth);
  plant::CurrentLoop current(truth.lag_s);
  std::mt19937 random(54321);
  std::normal_distribution<double> normal;
  const double count_m = 2.0 * std::numbers::pi * truth.radius_m_rad / kCounts;
  const double unit_N = 1e-3 * truth.rated_torque_Nm / truth.radius_m_rad;
  const auto rounded = [unit_N](double force_N) { return unit_N * std::round(force_N / unit_N); };
  DriveLoop loop(truth.table_mass_kg + truth.motor_inertia_kgm2 / (truth.radius_m_rad * truth.radius_m_rad));
  identify::Measured data;
  data.period_s = kPeriod_s;
  data.position_step_m = count_m;
  double offset = 0.0;
  const auto rows = static_cast<int>(seconds / kPeriod_s);
  for (int k = 0; k < rows; ++k) {
    // The offset of a row acts from the next row on.
    data.reported_N.push_back(rounded(current.torque_Nm() / truth.radius_m_rad));
    data.present.push_back(1);
    for (int tick = 0; tick < kTicks; ++tick) {
      const double t = k * kPeriod_s + tick * kTick_s;
      const double seen_m =
          count_m * std::floor(plant.motor_position_m() / count_m + 0.5 + noise_lsb * normal(random));
      if (tick == 0) data.position_m.push_back(seen_m);
      const double speed = (position_m(t + kTick_s) - position_m(t - kTick_s)) / (2.0 * kTick_s);
      current.SetCommand((offset + loop.Force_N(seen_m, position_m(t), speed)) * truth.radius_m_rad);
      for (int i = 0; i < kSteps; ++i) plant.Step(kTick_s / kSteps, current.StepMean_Nm(kTick_s / kSteps));
    }
    offset = rounded(offset_N(k * kPeriod_s));
    data.offset_N.push_back(offset);
  }
  // As a command, roughly: what the record's first steps take.
  const std::size_t n = data.offset_N.size();
  const auto own = [&](std::size_t k) {
    return data.reported_N[std::min(k, n - 1)] - (k >= 2 ? data.offset_N[std::min(k, n - 1) - 2] : 0.0);
  };
  for (std::size_t k = 0; k < n; ++k)
    data.force_N.push_back(data.offset_N[k] + 0.5 * (own(k + 1) + own(k + 2)) +
                           truth.lag_s / kPeriod_s * (own(k + 2) - own(k + 1)));
  return data;
}

}  // namespace contour::test
