#include "estimator/two_inertia_estimator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimator/angle_force_tuning.h"
#include "estimator/linear_friction_fit.h"
#include "estimator/share_of_period.h"

namespace contour {
namespace {

using namespace friction_term;  // NOLINT(google-build-using-namespace): names of terms only

// Of the level, for each parameter on its own: how far real friction is from the commissioned law's shape.
constexpr double kShape = 0.15;
constexpr double kTurnPart = 0.08;
// Over half a stroke; a program sees but a part of it.
constexpr double kStrokePart = 0.5;
// Friction at its largest place of stroke and turn over the level, whose range is bounded.
constexpr double kOverPlaces = 1.25;
// A workpiece may have been mounted since the mass was stated.
constexpr double kMassStds = 2.0;
constexpr double kViscousPart = 0.3;
// A target that leads by an unforeseen force shakes the table, which answers at its own frequency on the
// screw many times as much and shows as such a force as far as the stiffness is off.
constexpr double kLeadOfTable = 0.1;
constexpr double kSurprise_s = 0.2;
constexpr double kShakes_1_s = 200.0;

/// What a standard deviation towards the other law makes of the commissioned one: bristles that give way one
/// after the other in place of one that gives way smoothly. Their shares make them as stiff together.
FrictionTerms TowardsMaxwellSlip(const FrictionTerms& lugre) {
  constexpr double kOtherLaw = 0.5;
  constexpr std::array<double, 4> kShares{0.05, 0.15, 0.4, 0.4};
  FrictionTerms other{};
  double bristles_N = 0.0;
  for (std::size_t i = kDahl; i < kStop; ++i) {
    bristles_N += lugre[i];
    other[i] = -kOtherLaw * lugre[i];
  }
  for (std::size_t i = 0; i < kShares.size(); ++i) other[kStop + i] = kOtherLaw * kShares[i] * bristles_N;
  return other;
}

/// The loop by which a force is found.
const TwoInertiaLoop& FirstLoop(const TwoInertiaEstimator::Setup& s) {
  return s.scale_loop ? *s.scale_loop : s.loop;
}

// The share of friction that is the motor's shows in the observer as if it were the table's, a little sooner.
std::array<double, kLoopTaps> ResponseToFriction(const TwoInertiaEstimator::Setup& s) {
  const double share = s.filter.friction.motor_share;
  const TwoInertiaLoop& loop = FirstLoop(s);
  std::array<double, kLoopTaps> response = loop.disturbance_response;
  if (share == 0.0) return response;
  LoopMotion motion = MotionFromMotorForce(s.axis, s.filter.period_s);
  for (double& m : motion) m = -m;
  const std::array<double, kLoopTaps> motors = ResponseOfObserver(loop, motion);
  for (std::size_t i = 0; i < kLoopTaps; ++i) response[i] += share * (motors[i] - response[i]);
  return response;
}

// Periods until a force shows by half.
std::size_t HalfSeen(const std::array<double, kLoopTaps>& response, std::size_t most) {
  double seen = 0.0;
  for (std::size_t i = 0; i < response.size(); ++i) {
    seen += response[i];
    if (seen >= 0.5) return std::clamp<std::size_t>(i, 1, most);
  }
  return most;
}

FrictionLearner MakeLearner(const TwoInertiaEstimator::Setup& s, const LinearFriction& basis) {
  const EstimatorConfig& c = s.filter.config;
  const Friction& friction = s.filter.friction;
  FrictionLearner::Setup learner;
  learner.parameters = FitToLuGre(basis, friction);
  Friction stiffer = friction;
  stiffer.sigma0_N_m *= std::exp(c.initial_log_sigma0_std);
  const FrictionTerms other = FitToLuGre(basis, stiffer);
  const double level_N = basis.scale().level_N;
  for (std::size_t i = 0; i < kUsed; ++i) {
    learner.std[i] = kShape * level_N;
    learner.per_std[i] = other[i] - learner.parameters[i];
  }
  learner.per_law = TowardsMaxwellSlip(learner.parameters);
  for (std::size_t i = kTurn; i < kStroke; ++i) learner.std[i] = kTurnPart * level_N;
  learner.std[kStroke] = kStrokePart * level_N;
  learner.std[kViscous] = kShape * level_N + kViscousPart * friction.sigma2_Ns_m *
                                                 LinearFriction::kViscousSpeeds * friction.vs_m_s;
  learner.std[kMass] = kMassStds * c.mass_std * s.filter.mechanics.mass_kg;
  learner.inertial_kg = TwoInertiaEstimator::kInertialPart * s.filter.mechanics.mass_kg;
  learner.level_std = c.initial_level_std;
  learner.response = ResponseToFriction(s);
  learner.level_N = level_N;
  learner.vs_m_s = friction.vs_m_s;
  learner.level_range = c.level_range;
  learner.weight_N = s.external_force_N;
  learner.period_s = s.filter.period_s;
  learner.together = static_cast<double>(HalfSeen(FirstLoop(s).disturbance_response, kLoopTaps));
  learner.learns = c.adapt;
  return FrictionLearner(learner);
}

CascadeLead::Tuning Lead(const TwoInertiaEstimator::Setup& s) {
  CascadeLead::Tuning t;
  const double table_Hz = std::sqrt(s.axis.stiffness_N_m / s.axis.table_mass_kg) / (2.0 * std::numbers::pi);
  t.lead_Hz = std::min(t.lead_Hz, kLeadOfTable * table_Hz);
  t.averages_noise = s.filter.Shaken();
  return t;
}

LinearFriction MakeBasis(const TwoInertiaEstimator::Setup& s) {
  constexpr double kTurnOfRadius = 2.0 * std::numbers::pi;
  return LinearFriction(ScaleOf(s.filter.friction, kTurnOfRadius * s.filter.mechanics.radius_m_rad,
                                s.position_min_m, s.position_max_m));
}

// A drive that closes the loop answers each count of its encoder, at a speed of so many counts per second
// (docs/laboratory/family.md); the table shakes, and its bristles let go.
LinearFriction AlongReference(const TwoInertiaEstimator::Setup& s) {
  LinearFriction basis = MakeBasis(s);
  if (s.filter.Shaken()) basis.Shake(kShakes_1_s * s.filter.encoder_step_m * s.filter.period_s);
  return basis;
}

}  // namespace

TwoInertiaEstimator::TwoInertiaEstimator(const Setup& s)
    : setup_(s.filter),
      axis_(s.axis),
      known_(s.known),
      along_(AlongReference(s)),
      side_(s.side_modes, s.axis.table_mass_kg, s.filter.period_s),
      observer_({s.axis,
                 s.loop,
                 s.filter.period_s,
                 s.filter.measurement_std_m,
                 {s.filter.config.innovation_gate_sigma, s.filter.config.innovation_gate_um * 1e-6},
                 s.filter.Sudden_m(),
                 s.scale_loop}),
      learner_(MakeLearner(s, MakeBasis(s))),
      map_(AngleForceTuning(s.filter)),
      balance_({.mass_kg = s.filter.mechanics.mass_kg,
                .period_s = s.filter.period_s,
                .mass_rate = s.scale_loop && s.filter.config.adapt ? s.filter.config.mass_rate : 0.0}),
      wind_up_(WindUpTuning(s.filter)),
      lag_(s.filter.period_s, s.filter.reported_torque ? 0.0 : s.filter.lag_s),
      lead_(Lead(s), s.filter.period_s),
      resting_(MakeBasis(s).scale().level_N, s.filter.config.lasting_force, s.filter.period_s),
      motor_share_(s.axis.motor_mass_kg / (s.axis.motor_mass_kg + s.axis.table_mass_kg)),
      before_screw_(s.filter.friction.motor_share),
      band_(s.filter.config.initial_level_std * 0.5 *
                (s.filter.friction.Fc_plus_N + s.filter.friction.Fc_minus_N),
            s.filter.period_s),
      surprise_share_(std::min(1.0, s.filter.period_s / kSurprise_s)),
      settle_(HalfSeen(FirstLoop(s).disturbance_response, (kFound - 1) / 2)) {
  const Friction& f = s.filter.friction;
  most_N_ = s.filter.config.level_range * std::max({f.Fs_plus_N, f.Fs_minus_N, f.Fc_plus_N, f.Fc_minus_N});
  reports_are_noise_ = s.filter.Shaken();
  loop_takes_scale_ = s.has_scale && s.scale_loop;
  scale_ = MakeScale(s, MakeBasis(s).scale().level_N, most_N_);
  Reset(0.0);
}

void TwoInertiaEstimator::Keep(StateKeeper& keep) noexcept {
  keep(along_, side_, nodes_, observer_, learner_, map_, balance_, wind_up_, band_, lag_, scale_, by_scale_,
       lead_, given_N_, resting_, acted_N_, found_N_, newest_, surprise_N2_, noise_N2_, variance_N2_,
       unexplained_N_, elapsed_, temperature_degC_, at_rest_, frozen_);
}

void TwoInertiaEstimator::Reset(double position_m) noexcept {
  if (scale_) scale_->Reset();
  Begin(position_m);
  along_.Reset();
  side_.Reset();
  nodes_ = {};
  learner_.Reset();
  map_.Reset();
  balance_.Reset();
  wind_up_.Reset();
  band_.Reset();
  lag_.Reset();
  lead_.Reset();
  resting_.Move();
  given_N_ = {};
  acted_N_ = 0.0;
  found_N_ = {};
  surprise_N2_ = noise_N2_ = variance_N2_ = unexplained_N_ = 0.0;
  elapsed_ = 0;
  at_rest_ = true;
}

// By the parameters of this moment: friction beside sigma2 v, which the observer's own model has on the
// table. What the axis is heavier than commissioned belongs to both in the ratio of their masses, or as the
// scale tells it: the observer that goes by it cannot, since what a motor of another mass does to the encoder
// passes for an error of the screw there, and what it does to the table for a force on that.
void TwoInertiaEstimator::Lay() noexcept {
  const double extra_kg = learner_.parameters()[kMass];
  const double sigma2_Ns_m = setup_.friction.sigma2_Ns_m;
  const double weight_N = learner_.Weight_N();
  const double motor_extra_kg = by_scale_ ? MotorExtra_kg() : 0.0;
  const double motors_share = by_scale_ ? 0.0 : motor_share_;
  // What the momentum of the whole axis still lacks; without a loop for a scale nothing.
  const double rest_kg = balance_.extra_kg();
  const double besides_kg =
      by_scale_ ? TableExtra_kg(extra_kg + rest_kg, motor_extra_kg) - extra_kg : rest_kg;
  const bool cogs = map_.in_use();
  for (std::size_t j = 0; j < along_.size(); ++j) {
    const FrictionTerms& terms = along_.terms(j);
    Node& node = nodes_[j];
    node.heavier_N = extra_kg * terms[kMass];
    const double all_N = Sum(learner_.parameters(), terms) - node.heavier_N;
    node.friction_N = weight_N + std::clamp(all_N - weight_N, -kOverPlaces * most_N_, kOverPlaces * most_N_);
    node.learnt_N = node.friction_N + node.heavier_N;
    node.driving_N = cogs ? map_.At_N(along_.position_m(j), along_.velocity_m_s(j)) : 0.0;
    if (!known_.neutral()) {
      node.friction_N += known_.Viscous_N(along_.velocity_m_s(j), temperature_degC_);
      node.driving_N += known_.MotorForce_N(along_.position_m(j));
      node.pulling_N = known_.TableForce_N(along_.position_m(j));
    }
    // Of sigma2 v, the motor's share has to be taken from the table, which alone has a weight.
    const double before_N =
        before_screw_ * (node.friction_N - weight_N + sigma2_Ns_m * along_.velocity_m_s(j));
    node.table_N = node.friction_N + (1.0 - motors_share) * node.heavier_N + besides_kg * terms[kMass] -
                   before_N + side_.At_N(j) - node.pulling_N;
    node.inertia_N = motors_share * node.heavier_N + motor_extra_kg * terms[kMass];
    node.motor_N = node.driving_N - node.inertia_N - before_N;
    if (by_scale_)
      node.beyond_m =
          known_.Lead_m(along_.position_m(j)) + scale_->Beyond_m(along_.position_m(j), Wound_N(j));
  }
}

const TwoInertiaEstimator::Node& TwoInertiaEstimator::At(std::size_t point) const noexcept {
  return nodes_[along_.size() == 0 ? 0 : std::min(point, along_.size() - 1)];
}

// Through the screw at a point, by what is expected.
double TwoInertiaEstimator::Wound_N(std::size_t point) const noexcept {
  return At(point).table_N + setup_.friction.sigma2_Ns_m * along_.velocity_m_s(point) +
         axis_.table_mass_kg * along_.terms(point)[kMass];
}

// Means over the period that begins at a point.
double TwoInertiaEstimator::Expected_N(std::size_t period) const noexcept {
  return 0.5 * (At(period).table_N + At(period + 1).table_N);
}
double TwoInertiaEstimator::Motor_N(std::size_t period) const noexcept {
  return 0.5 * (At(period).motor_N + At(period + 1).motor_N);
}

void TwoInertiaEstimator::Remember(const AxisEstimatorInput& in) noexcept {
  for (std::size_t i = given_N_.size(); --i > 0;) given_N_[i] = given_N_[i - 1];
  // What was reported is of the period that has passed.
  given_N_[0] = setup_.reported_torque ? in.force_N[1] : in.force_N[0];
  temperature_degC_ = in.temperature_degC;
  // Whether anything is learnt or not: the drive's lag does not wait.
  const TwoInertiaLoop& loop = observer_.loop();
  const double acts_N = given_N_[loop.whole_delay()];
  const double late_N = given_N_[loop.queued];
  acted_N_ = lag_.Step(acts_N + loop.late_share * (late_N - acts_N))[0];
}

/// Of the period that begins at `period`; `ahead`: the one after the newest sample, not the one before.
PeriodForces TwoInertiaEstimator::Forces(std::size_t period, bool ahead) const noexcept {
  const std::size_t oldest = observer_.loop().queued;
  const auto given_N = [&](std::size_t age) {
    const std::size_t passed = ahead ? 1 : 0;
    return given_N_[age > passed ? age - passed : 0];
  };
  return {{given_N(oldest), given_N(oldest > 0 ? oldest - 1 : 0)}, Motor_N(period), Expected_N(period)};
}

AxisEstimate TwoInertiaEstimator::Update(const AxisEstimatorInput& in) noexcept {
  Remember(in);
  ReadScale(in);
  AxisEstimate out;
  if (!in.enabled) {
    if (in.fresh) Begin(in.position_m);
    learner_.Forget();
    unexplained_N_ = 0.0;
    at_rest_ = true;
    balance_.Pause();
    wind_up_.Pause();
  } else {
    const std::size_t period = elapsed_;
    observer_.Predict(Forces(period, false), At(period + 1).beyond_m - At(period).beyond_m);
    TwoInertiaObserver::Seen seen;
    if (in.fresh) seen = Correct(in);
    out.innovation_m = seen.innovation_m;
    out.innovation_std_m = in.fresh ? seen.innovation_std_m : 0.0;
    if (seen.gated) out.limit = Reason::kInnovationGated;
    Learn(in, in.fresh && !seen.gated && !frozen_);
    if (learner_.bounded() && out.limit == Reason::kNone) out.limit = Reason::kParameterBound;
  }
  AxisEstimate believed = Believed(in);
  believed.innovation_m = out.innovation_m;
  believed.innovation_std_m = out.innovation_std_m;
  believed.limit = out.limit;
  ++elapsed_;
  return believed;
}

AxisEstimate TwoInertiaEstimator::Believed(const AxisEstimatorInput& in) const noexcept {
  AxisEstimate out;
  const LoopMotion& now = observer_.motion();
  const LoopMotion next =
      in.enabled ? observer_.Ahead(Forces(elapsed_ + 1, true)) : LoopMotion{now[0], 0.0, now[2], 0.0, 0.0};
  const double beyond_m = observer_.beyond_m();
  out.position_m = now[0] + beyond_m;
  out.velocity_m_s = now[1];
  out.predicted_position_m = next[0] + beyond_m;
  out.predicted_velocity_m_s = next[1];
  out.motion = now;
  out.by_scale = by_scale_;
  if (scale_ && in.enabled) out.scale = scale_->told();
  out.disturbance_N = unexplained_N_;
  out.disturbance_std_N = band_.Std_N(variance_N2_);
  out.sigma0_N_m = setup_.friction.sigma0_N_m;
  const ScrewStiffness stiffness = Stiffness();
  out.stiffness_N_m = stiffness.N_m;
  out.stiffness_std_N_m = stiffness.std_N_m;
  out.g_plus_N = learner_.Level_N(true);
  out.g_minus_N = learner_.Level_N(false);
  if (along_.size() > 0) {
    // A mass that is off is no friction.
    out.bristle_N = At(elapsed_ + 1).friction_N;
    out.friction_N = out.bristle_N + setup_.friction.sigma2_Ns_m * now[3] + out.disturbance_N;
  }
  out.friction_std_N = std::sqrt(variance_N2_);
  out.diverged = !observer_.Sound();
  return out;
}

ScrewStiffness TwoInertiaEstimator::Stiffness() const noexcept {
  if (!scale_) return StiffnessBy(wind_up_, before_screw_, setup_.config.stiffness_std);
  const ScaleFit& fit = scale_->fit();
  return ScrewStiffness::Of(1.0 / axis_.stiffness_N_m + fit.extra_compliance_m_N(), fit.compliance_std_m_N());
}

// Up to the friction level an unforeseen force is friction, and part of it the motor's; beyond, it comes from
// outside and goes through the screw.
double TwoInertiaEstimator::WindsUp_N(double unforeseen_N) const noexcept {
  const double level_N = along_.basis().scale().level_N;
  return unforeseen_N - before_screw_ * std::clamp(unforeseen_N, -level_N, level_N);
}

void TwoInertiaEstimator::PreviewFriction(const AxisHorizon& reference, std::size_t points,
                                          FrictionPreview& out) noexcept {
  const std::size_t size = std::min(points, reference.size());
  out.resize(size);
  if (size == 0) return;
  along_.Follow(reference, std::max<std::size_t>(size, 3), known_);
  side_.Follow(reference, along_.size());
  elapsed_ = 0;
  Lay();
  const double sigma2 = setup_.friction.sigma2_Ns_m;
  double lead_N = 0.0;
  if (setup_.reported_torque) {
    lead_.Step(unexplained_N_, learner_.Level_N(along_.velocity_m_s(0) >= 0.0), at_rest_, NoiseTakes_s());
    lead_N = WindsUp_N(lead_.lead_N());
  }
  const double extra_m_N = wind_up_.extra_compliance_m_N() / (1.0 - before_screw_);
  const auto beyond_m = [&](std::size_t j, double wound_N) {
    return scale_ ? scale_->Beyond_m(along_.position_m(j), wound_N) : extra_m_N * wound_N;
  };
  const bool neutral = known_.neutral();
  for (std::size_t j = 0; j < size; ++j) {
    const Node& here = At(j);
    const Node& next = At(j + 1);
    const double v = along_.velocity_m_s(j);
    const double node_N = here.table_N + sigma2 * v;
    // A drive that closes the loop feeds its mass forward, whatever it is.
    const double drives_N = setup_.reported_torque ? 0.5 * (here.heavier_N + next.heavier_N) : 0.0;
    const double middle_N = 0.5 * (here.table_N + next.table_N) +
                            0.5 * sigma2 * (v + along_.velocity_m_s(j + 1)) -
                            0.5 * (here.motor_N + next.motor_N) - drives_N;
    const double wound_N = node_N + lead_N + setup_.mechanics.table_mass_kg * reference[j].acceleration_m_s2;
    const double led_m = neutral ? 0.0 : known_.Lead_m(along_.position_m(j));
    out[j] = {node_N + lead_N, middle_N, led_m + beyond_m(j, wound_N)};
  }
}

}  // namespace contour
