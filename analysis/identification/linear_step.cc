#include "analysis/identification/linear_step.h"

#include <algorithm>
#include <unsupported/Eigen/MatrixFunctions>

#include "analysis/axis_model/linear_axis.h"

namespace contour::identify {
namespace {

constexpr double kNoStep_s = 1e-9;

}  // namespace

LinearStep Over(const TableAxis& p, double viscous_Ns_m, double step_s) {
  const double on_motor = p.two_inertia && p.friction_on_load ? p.motor_friction_share : 0.0;
  diagnosis::LinearAxis linear = diagnosis::MakeLinearAxis(p, (1.0 - on_motor) * viscous_Ns_m);
  linear.dynamics(1, 1) -= on_motor * viscous_Ns_m / p.motor_inertia;
  const double lag = std::max(p.lag_s, kShortestLag_s);
  Eigen::Matrix<double, 8, 8> all = Eigen::Matrix<double, 8, 8>::Zero();
  all.topLeftCorner<4, 4>() = linear.dynamics;
  all.block<4, 1>(0, 4) = p.two_inertia ? linear.load : linear.motor;
  all.block<4, 1>(0, 5) = linear.motor;
  all(5, 5) = -1.0 / lag;
  all(5, 6) = 1.0 / lag;
  all.block<4, 1>(0, 7) = linear.motor;
  const Eigen::Matrix<double, 8, 8> e = (all * step_s).exp();
  return {e.topLeftCorner<4, 4>(), e.block<4, 1>(0, 4), e.block<4, 1>(0, 5),
          e.block<4, 1>(0, 6),     e.block<4, 1>(0, 7), e(5, 5)};
}

bool PeriodSteps::SameCuts(const PeriodSteps& other) const {
  return whole_delay == other.whole_delay &&
         std::equal(pieces.begin(), pieces.end(), other.pieces.begin(), other.pieces.end(),
                    [](const Piece& a, const Piece& b) {
                      return a.older == b.older && a.ends_substep == b.ends_substep;
                    });
}

PeriodSteps StepsOf(const TableAxis& axis, double period_s, int substeps) {
  PeriodSteps steps;
  const double delay_s = std::max(0.0, axis.delay_s);
  steps.whole_delay = static_cast<std::size_t>(delay_s / period_s + 1e-9);
  const double edge_s = delay_s - static_cast<double>(steps.whole_delay) * period_s;
  const double h = period_s / substeps;
  const LinearStep whole = Over(axis, axis.friction.s2, h);
  const auto add = [&](double step_s, bool older, bool ends) {
    if (step_s < kNoStep_s) return;
    steps.pieces.push_back({step_s, step_s == h ? whole : Over(axis, axis.friction.s2, step_s), older, ends});
  };
  for (int i = 0; i < substeps; ++i) {
    const double older_s = std::clamp(edge_s - i * h, 0.0, h);
    add(older_s, true, h - older_s < kNoStep_s);
    add(h - older_s, false, true);
  }
  return steps;
}

}  // namespace contour::identify
