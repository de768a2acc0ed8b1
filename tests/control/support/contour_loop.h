#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "control/contour_controller.h"
#include "control/contour_error.h"
#include "tests/control/support/screw_axis.h"

namespace contour::test {

inline constexpr double kPeriod_s = 1e-3;

inline ControlledAxis NominalAxis() {
  ControlledAxis axis;
  axis.mechanics = ToSi(MechanicsConfig{5.0, 5e-5, 10.0, 40.0, 1100.0});
  AxisLimits limits;
  limits.position_mm = {-200.0, 200.0};
  limits.velocity_mm_s = 250.0;
  limits.acceleration_mm_s2 = 5000.0;
  limits.jerk_mm_s3 = 2e5;
  limits.torque_Nm = 1.5;
  limits.following_error_mm = 0.5;
  limits.safe_travel_mm = 2.0;
  axis.limits = ToSi(limits, axis.mechanics.radius_m_rad);
  axis.lag_s = 2e-4;
  return axis;
}

inline PerAxis<ControlledAxis> NominalAxes(std::size_t count) {
  PerAxis<ControlledAxis> axes;
  for (std::size_t i = 0; i < count; ++i) axes.push_back(NominalAxis());
  return axes;
}

using Path = std::function<ReferencePoint(std::size_t axis, double time_s)>;

/// A circle that starts at rest at the origin and reaches its speed in half a second; a third axis swings
/// along.
inline Path Circle(double radius_m, double turns_s) {
  return [=](std::size_t axis, double time_s) {
    const double ramp = 0.5, full = 2.0 * std::numbers::pi * turns_s;
    const double t = std::max(0.0, time_s);
    // Angular speed rises as a smooth step of (t / ramp).
    double angle = 0.0, omega = full, alpha = 0.0;
    if (t < ramp) {
      const double x = t / ramp;
      omega = full * x * x * x * (10.0 + x * (6.0 * x - 15.0));
      alpha = full * 30.0 * x * x * (1.0 - x) * (1.0 - x) / ramp;
      angle = full * ramp * x * x * x * x * (2.5 + x * (x - 3.0));
    } else {
      angle = full * (0.5 * ramp + t - ramp);
    }
    const double phase = static_cast<double>(axis) * 0.5 * std::numbers::pi;
    const double s = std::sin(angle + phase), c = std::cos(angle + phase);
    return ReferencePoint{radius_m * (c - std::cos(phase)), -radius_m * s * omega,
                          -radius_m * (c * omega * omega + s * alpha)};
  };
}

/// Controller, plants and a perfect estimator in a loop: each Step is one cycle as core/horizon.h counts
/// them.
class ContourLoop {
 public:
  ContourLoop(ControllerName name, const ControllerConfig& config, const PerAxis<ControlledAxis>& axes,
              Path path)
      : controller_(name, config, axes, kPeriod_s), path_(std::move(path)), axes_(axes) {
    for (std::size_t i = 0; i < axes.size(); ++i) {
      ScrewAxis plant;
      plant.mechanics = axes[i].mechanics;
      plant.lag_s = axes[i].lag_s;
      plant.viscous_Ns_m = axes[i].viscous_Ns_m;
      plants.push_back(plant);
    }
    input.estimate.resize(axes.size());
    input.reference.resize(axes.size());
    input.friction.resize(axes.size());
    input.previous_force_N.resize(axes.size());
    for (std::size_t i = 0; i < axes.size(); ++i) input.previous_force_N[i] = 0.0;
  }

  /// Friction expected along the reference, node and middle of interval; none when empty.
  std::function<FrictionAhead(std::size_t axis, const ReferencePoint& node, const ReferencePoint& next)>
      friction;

  void Step() {
    for (std::size_t i = 0; i < plants.size(); ++i) {
      ScrewAxis ahead = plants[i];
      ahead.Step(input.previous_force_N[i], kPeriod_s);
      AxisEstimate& estimate = input.estimate[i];
      estimate.position_m = plants[i].motor_m;
      estimate.velocity_m_s = plants[i].motor_m_s;
      estimate.predicted_position_m = ahead.motor_m;
      estimate.predicted_velocity_m_s = ahead.motor_m_s;
      AxisHorizon& reference = input.reference[i];
      reference.clear();
      for (std::size_t j = 0; j < controller_.horizon_points(); ++j)
        reference.push_back(path_(i, time_s + static_cast<double>(j) * kPeriod_s));
    }
    controller_.Plan(input, true);
    for (std::size_t i = 0; i < plants.size(); ++i) {
      const AxisHorizon& reference = Reference(input)[i];
      input.friction[i].clear();
      for (std::size_t j = 0; friction && j < reference.size(); ++j) {
        const ReferencePoint& next = reference[std::min(j + 1, reference.size() - 1)];
        input.friction[i].push_back(friction(i, reference[j], next));
      }
    }
    controller_.Step(input, output);
    for (std::size_t i = 0; i < plants.size(); ++i) {
      plants[i].Step(input.previous_force_N[i], kPeriod_s);
      input.previous_force_N[i] = output.force_N[i];
    }
    time_s += kPeriod_s;
  }

  /// Distance of the motors, or of the tables, to the reference at the present instant.
  [[nodiscard]] double TrackingError(bool table = false) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < plants.size(); ++i) {
      const double e = path_(i, time_s).position_m - (table ? plants[i].table_m : plants[i].motor_m);
      sum += e * e;
    }
    return std::sqrt(sum);
  }

  /// Largest tracking error over a stretch of time.
  double Run(double seconds, bool table = false) {
    double worst = 0.0;
    for (int n = 0; n < static_cast<int>(seconds / kPeriod_s); ++n) {
      Step();
      worst = std::max(worst, TrackingError(table));
    }
    return worst;
  }

  std::vector<ScrewAxis> plants;
  ControlInput input;
  ControlOutput output;
  double time_s = 0.0;

 private:
  ContourController controller_;
  Path path_;
  PerAxis<ControlledAxis> axes_;
};

}  // namespace contour::test
