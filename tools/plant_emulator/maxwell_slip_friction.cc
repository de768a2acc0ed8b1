#include "tools/plant_emulator/maxwell_slip_friction.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace contour::plant {
namespace {

using Travels = std::array<double, MaxwellSlipFriction::kMaxElements>;

Travels LogarithmicTravels(const MaxwellSlipParameters& p) {
  Travels travel{};
  const double ratio = portable::Log(p.breakaway_max_m / p.breakaway_min_m);
  for (std::size_t i = 0; i < p.elements; ++i)
    travel[i] = p.breakaway_min_m *
                portable::Exp(ratio * static_cast<double>(i) / static_cast<double>(p.elements - 1));
  return travel;
}

/// Stiffness of all elements per newton of level, when shares go with travel^power.
double StiffnessPerLevel_1_m(const Travels& travel, std::size_t n, double power) {
  double weight = 0.0;
  double stiffness = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double w = portable::Pow(travel[i] / travel[n - 1], power);
    weight += w;
    stiffness += w / travel[i];
  }
  return stiffness / weight;
}

/// Stiffness falls monotonically with the power: bisection.
double PowerFor(const Travels& travel, std::size_t n, double wanted_1_m) {
  double low = -8.0;
  double high = 8.0;
  if (wanted_1_m > StiffnessPerLevel_1_m(travel, n, low) ||
      wanted_1_m < StiffnessPerLevel_1_m(travel, n, high))
    throw std::invalid_argument(
        "friction: sigma0_N_m = (mean Fs) times " + std::to_string(wanted_1_m) +
        " 1/m cannot be made from elements that break away between breakaway_min_um and breakaway_max_um");
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (StiffnessPerLevel_1_m(travel, n, middle) > wanted_1_m ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

int Sign(double x) noexcept { return (x > 0.0) - (x < 0.0); }

}  // namespace

MaxwellSlipFriction::MaxwellSlipFriction(const MaxwellSlipParameters& parameters) : p_(parameters) {
  if (p_.elements < 2 || p_.elements > kMaxElements || !(p_.breakaway_min_m < p_.breakaway_max_m))
    throw std::invalid_argument(
        "friction: elements and break-away travels of the Maxwell-slip law make no sense");
  const double level = std::max(0.5 * (p_.base.plus.Fs_N + p_.base.minus.Fs_N), kSmallestLevel_N);
  const Travels travel = LogarithmicTravels(p_);
  // Without friction there is nothing to spread: any power serves.
  const bool frictionless = level <= kSmallestLevel_N;
  const double power = frictionless ? 1.0 : PowerFor(travel, p_.elements, p_.base.sigma0_N_m / level);
  double weight = 0.0;
  for (std::size_t i = 0; i < p_.elements; ++i) {
    elements_[i].share = portable::Pow(travel[i] / travel[p_.elements - 1], power);
    weight += elements_[i].share;
  }
  for (std::size_t i = 0; i < p_.elements; ++i) {
    elements_[i].share /= weight;
    elements_[i].stiffness_N_m = elements_[i].share * level / travel[i];
  }
}

FrictionLine MaxwellSlipFriction::Line(double expected_m_s, double step_s,
                                       const FrictionScale& scale) noexcept {
  step_s_ = step_s;
  level_N_ = SteadyLevel_N(p_.base, scale, expected_m_s);
  decay_ = portable::DecayOver(p_.attraction_N_s * step_s / level_N_);
  const int direction = Sign(expected_m_s);
  FrictionLine line{0.0, PreslidingDamping_Ns_m(p_.base, expected_m_s) + p_.base.sigma2_Ns_m * scale.viscous};
  for (std::size_t i = 0; i < p_.elements; ++i) {
    Element& e = elements_[i];
    if (e.slip != 0 && direction != 0 && e.slip != direction) e.slip = 0;  // turned round: stick
    if (e.slip != 0) {
      const double target = e.slip * e.share * level_N_;
      line.constant_N += target + (e.force_N - target) * decay_.mean;
      continue;
    }
    // Sticks; would this step's expected travel break it away? Then its mean force ends at its limit.
    const double moved = e.force_N + e.stiffness_N_m * expected_m_s * step_s;
    const double limit = e.share * level_N_;
    if (direction != 0 && direction * moved > limit) {
      line.constant_N += 0.5 * (e.force_N + direction * std::max(limit, direction * e.force_N));
    } else {
      line.constant_N += e.force_N;
      line.slope_Ns_m += 0.5 * e.stiffness_N_m * step_s;
    }
  }
  return line;
}

void MaxwellSlipFriction::Commit(double velocity_m_s) noexcept {
  const int direction = Sign(velocity_m_s);
  for (std::size_t i = 0; i < p_.elements; ++i) {
    Element& e = elements_[i];
    if (e.slip != 0 && direction != 0 && direction != e.slip) e.slip = 0;
    if (e.slip != 0) {
      const double target = e.slip * e.share * level_N_;
      e.force_N = target + (e.force_N - target) * decay_.remaining;
      continue;
    }
    const double moved = e.force_N + e.stiffness_N_m * velocity_m_s * step_s_;
    const double limit = e.share * level_N_;
    if (direction != 0 && direction * moved >= limit) {
      // Breaks away at its limit; when the limit has sunk below the force, it goes there by attraction.
      e.force_N = direction * std::max(limit, direction * e.force_N);
      e.slip = direction;
    } else {
      e.force_N = moved;
    }
  }
}

double MaxwellSlipFriction::Elastic_N() const noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < p_.elements; ++i) sum += elements_[i].force_N;
  return sum;
}

double MaxwellSlipFriction::Force_N(double velocity_m_s, const FrictionScale& scale) const noexcept {
  return Elastic_N() +
         (PreslidingDamping_Ns_m(p_.base, velocity_m_s) + p_.base.sigma2_Ns_m * scale.viscous) * velocity_m_s;
}

void MaxwellSlipFriction::SetElastic_N(double force_N) noexcept {
  for (std::size_t i = 0; i < p_.elements; ++i) {
    elements_[i].force_N = elements_[i].share * force_N;
    elements_[i].slip = 0;
  }
}

}  // namespace contour::plant
