#include "tools/plant_emulator/side_modes.h"

#include "tools/plant_emulator/portable_math.h"

namespace contour::plant {

SideModes::SideModes(const std::vector<SideMode>& modes, double table_m) {
  for (const SideMode& mode : modes) masses_.push_back({mode});
  Place(table_m, 0.0);
}

void SideModes::Place(double table_m, double table_m_s) noexcept {
  for (Mass& m : masses_) {
    m.position_m = table_m;
    m.velocity_m_s = table_m_s;
  }
}

// Mean force of a spring over the step: k0 + k1 (v_s - v_t), v the mean velocities. On the mass:
// m (v_s - v_s0) / half = -k0 - k1 (v_s - v_t), so v_s = free + taken v_t.
void SideModes::AddTo(double half_s, double table_m, double& slope_Ns_m, double& constant_N) noexcept {
  for (Mass& m : masses_) {
    const double k0 = m.mode.stiffness_N_m * (m.position_m - table_m);
    const double k1 = m.mode.stiffness_N_m * half_s + m.mode.damping_Ns_m;
    const double inertia = m.mode.mass_kg / half_s;
    m.free_m_s = (inertia * m.velocity_m_s - k0) / (inertia + k1);
    m.taken_rel = k1 / (inertia + k1);
    slope_Ns_m += k1 * (1.0 - m.taken_rel);
    constant_N += k0 + k1 * m.free_m_s;
  }
}

void SideModes::Commit(double step_s, double table_m_s) noexcept {
  for (Mass& m : masses_) {
    const double mean_m_s = m.free_m_s + m.taken_rel * table_m_s;
    m.position_m += step_s * mean_m_s;
    m.velocity_m_s = portable::WithoutDust(2.0 * mean_m_s - m.velocity_m_s);
  }
}

double SideModes::Energy_J(double table_m) const noexcept {
  double energy_J = 0.0;
  for (const Mass& m : masses_) {
    const double bent_m = m.position_m - table_m;
    energy_J +=
        0.5 * (m.mode.mass_kg * m.velocity_m_s * m.velocity_m_s + m.mode.stiffness_N_m * bent_m * bent_m);
  }
  return energy_J;
}

}  // namespace contour::plant
