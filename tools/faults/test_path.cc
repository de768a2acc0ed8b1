#include "tools/faults/test_path.h"

#include <algorithm>
#include <cmath>

#include "core/mechanics.h"

namespace contour::faults {
namespace {

/// Of the limits, so that a stop on the path has room.
constexpr double kShareOfLimits = 0.7;
constexpr double kShareOfTravel = 0.8;
constexpr double kSlower = 0.95;
constexpr double kShortestRamp_periods = 20.0;
/// Of 3 u^2 - 2 u^3: the steepest slope and the largest second derivative.
constexpr double kSlope = 1.5;
constexpr double kCurvature = 6.0;

}  // namespace

TestPath::TestPath(const Shape& shape, const MachineConfig& machine, const PerAxis<double>& start_m,
                   const PerAxis<bool>& moves, std::uint32_t program_id)
    : shape_(shape),
      start_m_(start_m),
      moves_(moves),
      program_id_(program_id),
      period_s_(machine.machine.cycle_us * 1e-6),
      travel_m_(1e9) {
  std::size_t i = 0;
  for (const auto& [name, axis] : machine.axes) {
    if (moves_[i])
      travel_m_ = std::min({travel_m_, kShareOfTravel * (1e-3 * axis.limits.position_mm[1] - start_m[i]),
                            kShareOfTravel * (start_m[i] - 1e-3 * axis.limits.position_mm[0])});
    ++i;
  }
  ramp_s_ = Ramp_s(machine);
  // An axis whose travel is too short for its feed moves at a lower one.
  while (shape_.feed_m_s * (ramp_s_ + shape_.constant_s) > travel_m_) {
    shape_.feed_m_s *= kSlower;
    ramp_s_ = Ramp_s(machine);
  }
  Begin(Part::kUp, 0.0, shape_.feed_m_s, ramp_s_);
}

double TestPath::Ramp_s(const MachineConfig& machine) const {
  double ramp_s = kShortestRamp_periods * period_s_;
  std::size_t i = 0;
  for (const auto& [name, axis] : machine.axes) {
    if (!moves_[i++]) continue;
    const double v = shape_.feed_m_s / kShareOfLimits;
    ramp_s = std::max({ramp_s, kSlope * v / (1e-3 * axis.limits.acceleration_mm_s2),
                       std::sqrt(kCurvature * v / (1e-3 * axis.limits.jerk_mm_s3))});
  }
  return period_s_ * std::ceil(ramp_s / period_s_);
}

void TestPath::Begin(Part part, double from_m_s, double to_m_s, double seconds) {
  part_ = part;
  part_index_ = 0;
  part_s_ = seconds;
  from_m_s_ = from_m_s;
  to_m_s_ = to_m_s;
}

// The velocity of a part is from + (to - from) (3 u^2 - 2 u^3), u = t / part_s; its integral is exact.
bool TestPath::Next(PathPoint& point) {
  if (part_ == Part::kEnded) return false;
  const double t = static_cast<double>(part_index_) * period_s_;
  const double u = part_s_ > 0.0 ? std::min(1.0, t / part_s_) : 1.0;
  const double change = to_m_s_ - from_m_s_;
  const double velocity = from_m_s_ + change * u * u * (3.0 - 2.0 * u);
  const double acceleration = u < 1.0 && part_s_ > 0.0 ? change * 6.0 * u * (1.0 - u) / part_s_ : 0.0;
  const double travelled =
      from_m_s_ * t + change * part_s_ * u * u * u * (1.0 - 0.5 * u) + change * std::max(0.0, t - part_s_);
  const double position = part_begin_m_ + travelled;
  point = {};
  point.program_id = program_id_;
  point.axes.resize(start_m_.size());
  for (std::size_t i = 0; i < start_m_.size(); ++i) {
    point.axes[i].position_m = start_m_[i];
    if (!moves_[i]) continue;
    point.axes[i].position_m += shape_.direction * position;
    point.axes[i].velocity_m_s = shape_.direction * velocity;
    point.axes[i].acceleration_m_s2 = shape_.direction * acceleration;
  }
  ++index_;
  ++part_index_;
  if (t + 0.5 * period_s_ < part_s_) return true;
  // The part is over at this point, or may be.
  const double now_s = static_cast<double>(index_) * period_s_;
  const double room_m = travel_m_ - std::abs(position) - shape_.feed_m_s * (0.5 * ramp_s_ + 2.0 * period_s_);
  const auto next = [&](Part part, double to_m_s, double seconds) {
    part_begin_m_ = position;
    Begin(part, velocity, to_m_s, seconds);
    part_index_ = 1;
  };
  switch (part_) {
    case Part::kUp:
      next(Part::kConstant, velocity, shape_.constant_s);
      break;
    case Part::kConstant:
      if (shape_.reverses)
        next(Part::kTurn, -shape_.feed_m_s, TurnRamp_s());
      else if (room_m <= 0.0 || now_s >= shape_.end_s)
        next(Part::kDown, 0.0, ramp_s_);
      break;
    case Part::kTurn:
      next(Part::kAway, velocity, 0.0);
      break;
    case Part::kAway: {
      const bool outwards = position * velocity > 0.0;
      if ((outwards && room_m <= 0.0) || now_s >= shape_.end_s) next(Part::kDown, 0.0, ramp_s_);
      break;
    }
    case Part::kDown:
      point.last = true;
      part_ = Part::kEnded;
      break;
    case Part::kEnded:
      break;
  }
  return true;
}

}  // namespace contour::faults
