#include "daemon/rest_swing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "config/number_text.h"
#include "daemon/rt/cycle_parts.h"
#include "daemon/rt/self_watch.h"

namespace contour {
namespace {

// A target that swings by this share of what the axis does makes it swing.
constexpr double kExplained = 0.5;
// Of the longest that the detector takes to tell of a swing: an axis that rests so long without one has none.
constexpr double kPatience = 2.0;

}  // namespace

void RestSwing::Span::See(double value) noexcept {
  least_ = std::min(least_, value);
  most_ = std::max(most_, value);
}

RestSwing::RestSwing(const CycleConfig& config) {
  if (!InCascade(config)) return;
  for (std::size_t i = 0; i < config.axes.size(); ++i) {
    const CycleAxisConfig& a = config.axes[i];
    OscillationBounds bounds = OscillationBoundsFor(config, i);
    bounds.chatter_N = bounds.swing_moving_N;  // swings too fast for half waves to be told apart, too
    const double r_m = a.mechanics.radius_m_rad;
    axes_.push_back({.name = a.name,
                     .radius_m_rad = r_m,
                     .count_m = 2.0 * std::numbers::pi * r_m / a.encoder_counts_per_rev,
                     .bounds = bounds,
                     .detector = OscillationDetector(bounds)});
  }
}

void RestSwing::Consume(const CycleRecord& record) {
  for (std::size_t i = 0; i < axes_.size() && i < record.axes.size(); ++i)
    Look(axes_[i], record.axes[i], record.cycle);
}

void RestSwing::Restart(Axis& axis, const AxisRecord& record, std::uint64_t cycle) {
  axis.middle_m = axis.told ? axis.position_m.middle() : record.position_m;
  axis.above = record.position_m > axis.middle_m;
  axis.crossings = 0;
  axis.position_m.Restart(record.position_m);
  axis.target_m.Restart(axis.radius_m_rad * record.target_position_rad);
  axis.since = cycle;
}

void RestSwing::Look(Axis& axis, const AxisRecord& record, std::uint64_t cycle) {
  const ReferencePoint& r = record.reference;
  const bool stands = record.goal == DriveGoal::kEnabled && r.velocity_m_s == 0.0 &&
                      r.extra_torque_Nm == 0.0 && r.position_m == axis.reference_m;
  if (!stands || !axis.rests) {
    axis.rests = stands;
    axis.reference_m = r.position_m;
    axis.detector.Reset();
    axis.told = false;
    Restart(axis, record, cycle);
    return;
  }
  if (!record.feedback.fresh) return;
  axis.position_m.See(record.position_m);
  axis.target_m.See(axis.radius_m_rad * record.target_position_rad);
  const bool above = record.position_m > axis.middle_m;
  axis.crossings += above != axis.above ? 1 : 0;
  axis.above = above;
  const Oscillation found = axis.detector.Step(
      {record.following_error_m, record.feedback.torque_Nm / axis.radius_m_rad, 0.0, 0.0, 0.0});
  // What the detector takes to tell of the slowest swing; what ends in it was left by a motion or a shock.
  const double slowest_s = 0.5 * axis.bounds.half_waves / axis.bounds.low_Hz;
  const double time_s = static_cast<double>(cycle - axis.since) * axis.bounds.period_s;
  if (found == Oscillation::kNone) {
    if (time_s <= kPatience * slowest_s) return;
    const std::lock_guard lock(mutex_);
    axis.swing.reset();
    return;
  }
  if (!axis.told || time_s > slowest_s) axis.told_since = cycle;
  const double lasts_s = static_cast<double>(cycle - axis.told_since) * axis.bounds.period_s;
  if (lasts_s > slowest_s && axis.target_m.size() < kExplained * axis.position_m.size()) {
    const std::lock_guard lock(mutex_);
    const bool begins = !axis.swing;
    axis.swing = {axis.position_m.size(), 0.5 * axis.crossings / time_s};
    if (begins) new_.push_back(Sentence(axis));
  }
  axis.told = true;
  Restart(axis, record, cycle);
}

std::string RestSwing::Sentence(const Axis& axis) {
  return "axis " + axis.name + " swings while its set-point rests, by " +
         std::to_string(std::lround(axis.swing->position_m / axis.count_m)) + " counts of its encoder (" +
         RoundedText(1e6 * axis.swing->position_m) + " um) at some " +
         std::to_string(std::lround(axis.swing->frequency_Hz)) +
         " Hz: in csp that is the drive's own loop. Tune it in the drive: position and velocity gains are "
         "too high for this axis, or its integral action hunts across friction (contour commission --axis " +
         axis.name + " --drive measures it)";
}

std::vector<std::string> RestSwing::warnings() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> all;
  for (const Axis& axis : axes_)
    if (axis.swing) all.push_back(Sentence(axis));
  return all;
}

std::vector<std::string> RestSwing::TakeNew() {
  const std::lock_guard lock(mutex_);
  return std::exchange(new_, {});
}

}  // namespace contour
