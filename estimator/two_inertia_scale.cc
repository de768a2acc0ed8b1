#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimator/two_inertia_estimator.h"

// What the estimator of two inertias makes of a linear scale.
namespace contour {
namespace {

// A scale shows the screw's compliance directly: what was stated need not bound what is found.
constexpr double kLeastStdWithScale = 0.15;

// Of the commissioned compliance: a screw four times as stiff is another one.
constexpr double kLeastCompliance = 0.25;
// Of the motor's mass, which is stated to a third of it at the worst.
constexpr double kMostOfMotor = 0.4;
// Of the table's mass: what is left of it where the axis is lighter by more than the motor can be.
constexpr double kLeastOfTable = 0.1;

}  // namespace

std::unique_ptr<TableScale> TwoInertiaEstimator::MakeScale(const Setup& s, double level_N, double most_N) {
  if (!s.has_scale) return nullptr;
  const EstimatorConfig& c = s.filter.config;
  TableScale::Setup scale;
  scale.period_s = s.filter.period_s;
  scale.motor_mass_kg = s.axis.motor_mass_kg;
  scale.table_mass_kg = s.axis.table_mass_kg;
  scale.stiffness_N_m = s.axis.stiffness_N_m;
  scale.stiffness_std = std::max(c.stiffness_std, kLeastStdWithScale);
  scale.learns = c.adapt && c.stiffness_std > 0.0;
  scale.friction_N = most_N;
  scale.level_N = level_N;
  scale.acceleration_m_s2 = s.acceleration_m_s2;
  scale.sample_jitter_s = s.sample_jitter_s;
  scale.turn_m = 2.0 * std::numbers::pi * s.filter.mechanics.radius_m_rad;
  scale.reading_m = std::sqrt(12.0) * s.filter.measurement_std_m;
  scale.count_m = s.scale_count_m;
  scale.sudden_m = scale.reading_m + 0.5 * kSuddenFrictions * most_N / s.axis.table_mass_kg *
                                         s.filter.period_s * s.filter.period_s;
  return std::make_unique<TableScale>(scale);
}

// At rest, by the scale where it is in the loop.
void TwoInertiaEstimator::Begin(double position_m) noexcept {
  by_scale_ = loop_takes_scale_ && scale_->believed();
  observer_.Reset(position_m, by_scale_ ? scale_->table_m() : position_m);
}

// What the motor is heavier than commissioned, as encoder and scale tell it.
double TwoInertiaEstimator::MotorExtra_kg() const noexcept {
  const ScaleFit& fit = scale_->fit();
  const double stated_m_N = 1.0 / axis_.stiffness_N_m;
  const double screw_m_N = std::max(stated_m_N + fit.extra_compliance_m_N(), kLeastCompliance * stated_m_N);
  const double most_kg = kMostOfMotor * axis_.motor_mass_kg;
  return std::clamp(fit.motor_extra_s2() / screw_m_N, -most_kg, most_kg);
}

double TwoInertiaEstimator::TableExtra_kg(double axis_kg, double motor_kg) const noexcept {
  return std::max(axis_kg - motor_kg, (kLeastOfTable - 1.0) * axis_.table_mass_kg);
}

void TwoInertiaEstimator::ReadScale(const AxisEstimatorInput& in) noexcept {
  if (!scale_) return;
  TableScale::Sample s;
  s.enabled = in.enabled;
  s.moves = !at_rest_ && !frozen_;
  s.fresh = in.fresh;
  s.scale_fresh = in.scale_fresh;
  s.position_m = in.position_m;
  s.scale_m = in.scale_m;
  s.lead_m = known_.Lead_m(in.position_m);
  if (in.enabled) s.force_N = acted_N_ + At(elapsed_).motor_N + At(elapsed_).inertia_N;
  scale_->Step(s);
}

// From here on by the motor alone, until the axis is enabled anew.
void TwoInertiaEstimator::LeaveScale(double position_m) noexcept {
  by_scale_ = false;
  const double screw_N = scale_->screw_N();
  observer_.GoOnByMotor(position_m, screw_N, screw_N - (along_.size() > 0 ? Wound_N(elapsed_ + 1) : 0.0));
}

TwoInertiaObserver::Seen TwoInertiaEstimator::Correct(const AxisEstimatorInput& in) noexcept {
  if (!by_scale_) return observer_.Correct(in.position_m);
  std::optional<double> table_m;
  if (in.scale_fresh && !scale_->Sudden(scale_->table_m() - observer_.motion()[2], observer_.motion()[3]))
    table_m = scale_->table_m();
  if (!scale_->believed()) {
    LeaveScale(in.position_m);
    return observer_.Correct(in.position_m);
  }
  return observer_.Correct(in.position_m, table_m);
}

}  // namespace contour
