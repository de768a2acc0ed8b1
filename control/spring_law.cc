#include "control/spring_law.h"

#include <cmath>

#include "control/control_law.h"

namespace contour {
namespace {

/// Damping ratio of an axis held by a spring, friction apart.
constexpr double kDamping = 0.7;

/// The force acts from here on.
constexpr std::size_t kAhead = 1;

}  // namespace

SpringLaw::SpringLaw(const PerAxis<ControlledAxis>& axes) noexcept {
  for (const ControlledAxis& a : axes) mass_kg_.push_back(a.mechanics.mass_kg);
}

bool SpringLaw::Holds(const ControlInput& input, std::size_t axis) noexcept {
  return PointAt(input.reference[axis], kAhead).spring_N_m > 0.0;
}

double SpringLaw::AgainstStated_N(const ControlInput& input, std::size_t axis) noexcept {
  return axis < input.stated.size() ? -input.stated[axis].motor_N - input.stated[axis].table_N : 0.0;
}

void SpringLaw::Step(std::size_t axis, const ControlInput& input, ControlOutput& output) const noexcept {
  const ReferencePoint& ahead = PointAt(input.reference[axis], kAhead);
  const AxisEstimate& now = input.estimate[axis];
  const double damping_Ns_m = 2.0 * kDamping * std::sqrt(ahead.spring_N_m * mass_kg_[axis]);
  const double against_N = AgainstStated_N(input, axis);
  output.force_N[axis] = against_N + ahead.spring_N_m * (ahead.position_m - now.predicted_position_m) +
                         damping_Ns_m * (ahead.velocity_m_s - now.predicted_velocity_m_s);
  output.feedforward_N[axis] = against_N;
  output.limit[axis] = Reason::kNone;
}

}  // namespace contour
