#include "design/start_set.h"

#include <algorithm>
#include <string>
#include <utility>

#include "config/number_text.h"

namespace contour {
namespace {

// In Stribeck velocities: where the slope is steep, and where it has begun to fade.
constexpr double kSlopeSpeeds[] = {0.05, 0.25, 1.0};
// Damping of a screw in no catalogue: half and twice of what is stated.
constexpr double kLittleDamping = 0.5;
constexpr double kMuchDamping = 2.0;
/// Right after a reversal the bristle is twice as stiff as its stiffness, since it unloads and loads.
constexpr double kStiffestBristle = 2.0;

/// Shares of what is stated: stiffness, motor's mass, table's mass.
struct Corner {
  double stiffness, motor, table;
};

std::string Name(const Corner& c) {
  return "stiffness x" + RoundedText(c.stiffness) + ", motor x" + RoundedText(c.motor) + ", table x" +
         RoundedText(c.table);
}

LoopMember At(const LoopAxis& a, const Corner& c, double damping) {
  LoopMember m{Name(c), MemberKind::kLate, a.axis, {}, 0.0, a.side_modes};
  m.axis.stiffness_N_m *= c.stiffness;
  m.axis.motor_mass_kg *= c.motor;
  m.axis.table_mass_kg *= c.table;
  m.axis.damping_Ns_m *= damping;
  return m;
}

LoopMember Held(LoopMember m, double sigma0_N_m, double factor) {
  m.name += ", table held by " + RoundedText(factor) + " times the bristle";
  m.bristle = {factor * sigma0_N_m, 0.0, 1.0, 0.0};
  return m;
}

/// Levels that fall `factor` times as far with speed.
Friction Steeper(Friction f, double factor) {
  for (double* level : {&f.Fs_plus_N, &f.Fs_minus_N, &f.Fc_plus_N, &f.Fc_minus_N, &f.sigma0_N_m})
    *level *= factor;
  return f;
}

}  // namespace

std::vector<LoopMember> StartSet(const LoopAxis& a, const CatalogueDoubt& doubt) {
  const double light = 1.0 - doubt.masses_rel, heavy = 1.0 + doubt.masses_rel;
  const double stiff = doubt.stiffness_factor, soft = 1.0 / doubt.stiffness_factor;
  std::vector<LoopMember> set{SlidingMember(a), RestingMember(a)};
  const Corner corners[] = {{soft, 1, 1},         {stiff, 1, 1},         {1, light, light},
                            {1, heavy, heavy},    {soft, light, light},  {soft, light, heavy},
                            {soft, heavy, heavy}, {stiff, light, light}, {stiff, light, heavy},
                            {stiff, heavy, light}};
  for (const Corner& c : corners) set.push_back(At(a, c, kLittleDamping));
  set.push_back(At(a, {1, 1, 1}, kMuchDamping));
  set.back().name += ", twice the screw's damping";
  // A bristle as soft as may be, and as stiff, on what binds loops: light masses and a soft screw.
  for (const double bristle : {1.0 / doubt.friction_factor, 1.0, doubt.friction_factor * kStiffestBristle})
    for (const Corner& c : {Corner{1, 1, 1}, Corner{soft, light, light}, Corner{soft, light, heavy},
                            Corner{stiff, light, light}})
      set.push_back(Held(At(a, c, kLittleDamping), a.friction.sigma0_N_m, bristle));
  for (const double share : kSlopeSpeeds)
    for (const Corner& c : {Corner{1, 1, 1}, Corner{soft, light, heavy}}) {
      LoopMember m = At(a, c, 1.0);
      const double v_m_s = share * a.friction.vs_m_s;
      m.name += ", on twice the Stribeck slope at " + RoundedText(1e3 * v_m_s) + " mm/s";
      m.bristle = BristleAt(Steeper(a.friction, doubt.friction_factor), v_m_s);
      set.push_back(std::move(m));
    }
  for (const Corner& c : {Corner{1, 1, 1}, Corner{soft, light, heavy}}) {
    set.push_back(At(a, c, 1.0));
    set.back().name += ", one more cycle of delay";
    ++set.back().axis.delay_cycles;
  }
  return set;
}

}  // namespace contour
