#include "tools/plant_emulator/place_friction.h"

namespace contour::plant {
namespace {

void ScaleLevels(FrictionParameters& p, double share) {
  for (double* level : {&p.plus.Fs_N, &p.plus.Fc_N, &p.minus.Fs_N, &p.minus.Fc_N}) *level *= share;
}

std::variant<LugreFriction, MaxwellSlipFriction> MakeMain(const AxisParameters& p, double share) {
  const auto& second = p.effects.presliding_hysteresis;
  MaxwellSlipParameters friction = p.friction;
  FrictionParameters& base = friction.base;
  const double main_share = share * (1.0 - (second ? second->share_rel : 0.0));
  ScaleLevels(base, main_share);
  base.sigma0_N_m *= main_share;
  base.sigma1_Ns_m *= share;
  base.sigma2_Ns_m *= share;
  friction.attraction_N_s *= share;
  if (p.law == EmulatedFrictionLaw::kMaxwellSlip) return MaxwellSlipFriction(friction);
  return LugreFriction(base);
}

}  // namespace

PlaceFriction::PlaceFriction(const AxisParameters& parameters, double share)
    : main_(MakeMain(parameters, share)) {
  if (const auto& e = parameters.effects.presliding_hysteresis) {
    FrictionParameters soft = parameters.friction.base;
    ScaleLevels(soft, share * e->share_rel);
    soft.sigma0_N_m *= share * e->share_rel * e->stiffness_ratio;
    soft.sigma1_Ns_m = 0.0;
    soft.sigma2_Ns_m = 0.0;
    second_.emplace(soft);
  }
  SetElastic_N(share * parameters.start_bristle_N);
}

void PlaceFriction::SetElastic_N(double force_N) noexcept {
  std::visit([&](auto& friction) { friction.SetElastic_N(force_N); }, main_);
}

FrictionLine PlaceFriction::Line(double expected_m_s, double step_s, const FrictionScale& scale) noexcept {
  FrictionLine line =
      std::visit([&](auto& friction) { return friction.Line(expected_m_s, step_s, scale); }, main_);
  if (second_) {
    const FrictionLine soft = second_->Line(expected_m_s, step_s, scale);
    line.constant_N += soft.constant_N;
    line.slope_Ns_m += soft.slope_Ns_m;
  }
  return line;
}

void PlaceFriction::Commit(double velocity_m_s) noexcept {
  std::visit([&](auto& friction) { friction.Commit(velocity_m_s); }, main_);
  if (second_) second_->Commit(velocity_m_s);
}

double PlaceFriction::Force_N(double velocity_m_s, const FrictionScale& scale) const noexcept {
  const double main =
      std::visit([&](const auto& friction) { return friction.Force_N(velocity_m_s, scale); }, main_);
  return second_ ? main + second_->Force_N(velocity_m_s, scale) : main;
}

double PlaceFriction::Elastic_N() const noexcept {
  const double main = std::visit([](const auto& friction) { return friction.Elastic_N(); }, main_);
  return second_ ? main + second_->Elastic_N() : main;
}

}  // namespace contour::plant
