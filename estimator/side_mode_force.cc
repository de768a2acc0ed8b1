#include "estimator/side_mode_force.h"

#include <algorithm>
#include <numbers>
#include <stdexcept>

namespace contour {
namespace {

// Of Runge and Kutta's steps per period: a mode at the highest frequency that a cycle can serve turns by less
// than a hundredth of a turn in each.
constexpr int kSteps = 64;

}  // namespace

SideModeForce::SideModeForce(const std::vector<SideMode>& modes, double table_mass_kg, double period_s) {
  if (modes.size() > kMostSideModes) throw std::invalid_argument("side_modes: too many");
  for (const SideMode& mode : modes) modes_.push_back(MakeMode(mode, table_mass_kg, period_s));
}

// Linear, so what becomes of each unit is all there is to know: acceleration goes in a straight line from
// point to point.
SideModeForce::Mode SideModeForce::MakeMode(const SideMode& mode, double table_mass_kg,
                                            double period_s) noexcept {
  const double w = 2.0 * std::numbers::pi * mode.frequency_Hz;
  Mode m;
  m.mass_kg = mode.mass_share_rel * table_mass_kg;
  m.damping_1_s = 2.0 * (mode.damping_ratio + mode.frequency_std_rel) * w;
  m.stiffness_1_s2 = w * w;
  const double h = period_s / kSteps;
  for (std::size_t unit = 0; unit < 4; ++unit) {
    State s{unit == 0 ? 1.0 : 0.0, unit == 1 ? 1.0 : 0.0};
    const auto rate = [&](const State& at, double share) {
      const double a = unit == 2 ? 1.0 - share : unit == 3 ? share : 0.0;
      return State{at.rate_m_s, -a - m.damping_1_s * at.rate_m_s - m.stiffness_1_s2 * at.way_m};
    };
    const auto ahead = [&](const State& at, double step, const State& by) {
      return State{at.way_m + step * by.way_m, at.rate_m_s + step * by.rate_m_s};
    };
    for (int i = 0; i < kSteps; ++i) {
      const double from = static_cast<double>(i) / kSteps, half = 0.5 / kSteps;
      const State k1 = rate(s, from), k2 = rate(ahead(s, 0.5 * h, k1), from + half);
      const State k3 = rate(ahead(s, 0.5 * h, k2), from + half),
                  k4 = rate(ahead(s, h, k3), from + 2.0 * half);
      s = ahead(ahead(ahead(ahead(s, h / 6.0, k1), h / 3.0, k2), h / 3.0, k3), h / 6.0, k4);
    }
    m.next[0][unit] = s.way_m;
    m.next[1][unit] = s.rate_m_s;
  }
  return m;
}

void SideModeForce::Reset() noexcept {
  states_ = {};
  force_N_ = {};
  laid_ = 0;
}

void SideModeForce::Follow(const AxisHorizon& reference, std::size_t points) noexcept {
  if (none()) return;
  laid_ = std::min({points, reference.size(), force_N_.size()});
  for (std::size_t j = 0; j < laid_; ++j) force_N_[j] = 0.0;
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    const Mode& m = modes_[i];
    State s = states_[i];
    for (std::size_t j = 0; j < laid_; ++j) {
      const double now = reference[j].acceleration_m_s2;
      const double then = reference[std::min(j + 1, reference.size() - 1)].acceleration_m_s2;
      force_N_[j] -= m.mass_kg * (now + m.damping_1_s * s.rate_m_s + m.stiffness_1_s2 * s.way_m);
      const State next{
          m.next[0][0] * s.way_m + m.next[0][1] * s.rate_m_s + m.next[0][2] * now + m.next[0][3] * then,
          m.next[1][0] * s.way_m + m.next[1][1] * s.rate_m_s + m.next[1][2] * now + m.next[1][3] * then};
      if (j == 0) states_[i] = next;
      s = next;
    }
  }
}

}  // namespace contour
