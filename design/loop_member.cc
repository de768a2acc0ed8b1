#include "design/loop_member.h"

#include <algorithm>
#include <cmath>

#include "config/number_text.h"

namespace contour {
namespace {

// Where the friction level falls with speed, in Stribeck velocities: from deep in stiction to where the slope
// has faded.
constexpr double kSlopeSpeeds[] = {0.025, 0.05, 0.1, 0.25, 0.5, 1.0};

// What is held has no more damping than half of the screw's: how much the bristle adds is known least.
constexpr double kLittleDamping = 0.5;
constexpr double kMuchDamping = 2.0;
// Right after a reversal the bristle is twice as stiff, since it unloads and loads.
constexpr double kStiffestBristle = 2.0;

constexpr double kMostMotorShare = 0.9;

struct Factors {
  double stiffness = 1.0;
  double motor = 1.0;
  double table = 1.0;
  double damping = 1.0;
};

LoopMember Vary(const LoopAxis& a, MemberKind kind, std::string name, const Factors& f) {
  LoopMember m{std::move(name), kind, a.axis, {}, 0.0, a.side_modes};
  m.axis.stiffness_N_m *= f.stiffness;
  m.axis.motor_mass_kg *= f.motor;
  m.axis.table_mass_kg *= f.table;
  m.axis.damping_Ns_m *= f.damping;
  return m;
}

/// What is known to `std`, relative, off by one of it down or up. Down, beyond half of the value the straight
/// line would end at nothing and go on below; there 1 / (4 std) takes over from it, which is as large and as
/// steep at the half, and stays positive.
double Off(double sign, double std) {
  constexpr double kHalf = 0.5;
  return sign > 0.0 || std <= kHalf ? 1.0 + sign * std : kHalf * kHalf / std;
}

/// By the bristles of table and motor, `motor_share` of them the motor's.
LoopMember Held(LoopMember m, double stiffness_N_m, double motor_share) {
  m.bristle = {(1.0 - motor_share) * stiffness_N_m, 0.0, 1.0, 0.0};
  m.motor_hold_N_m = motor_share * stiffness_N_m;
  return m;
}

std::string Percent(double share) { return RoundedText(100.0 * share) + " %"; }

/// What is stated of the modes beside the screw's, off either way; with little damping.
std::vector<LoopMember> WithSideModes(const LoopAxis& a) {
  std::vector<LoopMember> set;
  if (a.side_modes.empty()) return set;
  for (const double sign : {-1.0, 1.0}) {
    LoopMember m = Vary(a, MemberKind::kAsStated,
                        std::string("side modes ") + (sign > 0.0 ? "higher" : "lower") +
                            " by what they are uncertain, half of their damping",
                        {});
    for (SideMode& mode : m.side_modes) {
      mode.frequency_Hz *= 1.0 + sign * mode.frequency_std_rel;
      mode.damping_ratio *= kLittleDamping;
    }
    set.push_back(std::move(m));
  }
  return set;
}

std::vector<LoopMember> AsStated(const LoopAxis& a) {
  constexpr MemberKind kKind = MemberKind::kAsStated;
  const double k = a.stiffness_std, m1 = a.motor_mass_std, m2 = a.table_mass_std;
  const double sigma0 = a.friction.sigma0_N_m, share = a.friction.motor_share;
  std::vector<LoopMember> set{SlidingMember(a)};
  for (const double sign : {1.0, -1.0}) {
    const std::string s = sign > 0.0 ? "+" : "-";
    const Factors off{.stiffness = Off(sign, k), .motor = Off(sign, m1), .table = Off(sign, m2)};
    const auto by = [](double factor) { return Percent(std::fabs(factor - 1.0)); };
    set.push_back(Vary(a, kKind, "stiffness " + s + by(off.stiffness), {.stiffness = off.stiffness}));
    set.push_back(Vary(a, kKind, "motor's mass " + s + by(off.motor), {.motor = off.motor}));
    set.push_back(Vary(a, kKind, "table's mass " + s + by(off.table), {.table = off.table}));
    set.push_back(Vary(a, kKind, "both masses " + s + by(off.motor) + " and " + by(off.table),
                       {.motor = off.motor, .table = off.table}));
  }
  set.push_back(Vary(a, kKind, "half of the screw's damping", {.damping = kLittleDamping}));
  set.push_back(Vary(a, kKind, "twice the screw's damping", {.damping = kMuchDamping}));
  const Factors little{.damping = kLittleDamping};
  set.push_back(
      Held(Vary(a, kKind, "table held by the bristle, half of the screw's damping", little), sigma0, share));
  set.push_back(Held(Vary(a, kKind, "table held by twice the bristle, half of the screw's damping", little),
                     kStiffestBristle * sigma0, share));
  // What is not known of the share is tried either way.
  for (const double other : {share - a.motor_share_std, share + a.motor_share_std}) {
    const double motors = std::clamp(other, 0.0, kMostMotorShare);
    if (a.motor_share_std == 0.0 || motors == share) continue;
    set.push_back(Held(
        Vary(a, kKind,
             "held by the bristle, " + Percent(motors) + " of it at the motor, half of the screw's damping",
             little),
        sigma0, motors));
  }
  for (LoopMember& m : WithSideModes(a)) set.push_back(std::move(m));
  for (const double v_m_s : SlopeSpeeds_m_s(a)) set.push_back(CreepingMember(a, v_m_s));
  return set;
}

std::vector<LoopMember> FarOff(const LoopAxis& a) {
  constexpr MemberKind kKind = MemberKind::kFarOff;
  const double low = 1.0 - a.limits.far_off, high = 1.0 + a.limits.far_off;
  const std::string minus = " -" + Percent(a.limits.far_off), plus = " +" + Percent(a.limits.far_off);
  const double sigma0 = a.friction.sigma0_N_m, share = a.friction.motor_share;
  return {Vary(a, kKind, "stiffness" + minus, {.stiffness = low}),
          Vary(a, kKind, "stiffness" + plus, {.stiffness = high}),
          Vary(a, kKind, "table's mass" + minus, {.table = low}),
          Vary(a, kKind, "table's mass" + plus, {.table = high}),
          Vary(a, kKind, "both masses" + minus, {.motor = low, .table = low}),
          Vary(a, kKind, "both masses" + plus, {.motor = high, .table = high}),
          Vary(a, kKind, "stiffness" + minus + ", table's mass" + plus,
               {.stiffness = low, .table = high, .damping = low}),
          Vary(a, kKind, "stiffness" + plus + ", table's mass" + minus,
               {.stiffness = high, .table = low, .damping = low}),
          Held(Vary(a, kKind, "stiffness" + minus + ", table held by the bristle", {.stiffness = low}),
               sigma0, share),
          Held(Vary(a, kKind, "both masses" + minus + ", table held by the bristle",
                    {.motor = low, .table = low}),
               sigma0, share)};
}

}  // namespace

double PeakLimit(const LoopLimits& limits, MemberKind kind) {
  switch (kind) {
    case MemberKind::kAsStated:
      return limits.peak_as_stated;
    case MemberKind::kFarOff:
      return limits.peak_far_off;
    case MemberKind::kLate:
    case MemberKind::kHeld:
    case MemberKind::kCreeping:
      break;
  }
  return limits.peak_late;
}

TableBristle BristleAt(const Friction& f, double velocity_m_s) {
  // z' = v - sigma0 |v| z / g about z = g / sigma0, with g of both directions' mean.
  const double v = std::fabs(velocity_m_s);
  const double coulomb_N = 0.5 * (f.Fc_plus_N + f.Fc_minus_N);
  const double rise_N = 0.5 * (f.Fs_plus_N + f.Fs_minus_N) - coulomb_N;
  const double ratio = v / f.vs_m_s;
  const double fading = std::exp(-std::pow(ratio, f.stribeck_exponent));
  const double g_N = coulomb_N + rise_N * fading;
  const double slope_Ns_m =
      -rise_N * fading * f.stribeck_exponent * std::pow(ratio, f.stribeck_exponent) / std::max(v, 1e-12);
  TableBristle b;
  b.stiffness_N_m = f.sigma0_N_m;
  b.damping_Ns_m = f.sigma1_Ns_m * std::exp(-std::pow(v / f.sigma1_decay_m_s, 2));
  b.rate = v * slope_Ns_m / g_N;
  b.decay_1_s = f.sigma0_N_m * v / g_N;
  return b;
}

LoopMember SlidingMember(const LoopAxis& a) {
  return Vary(a, MemberKind::kAsStated, "as stated, sliding", {});
}

LoopMember RestingMember(const LoopAxis& a) {
  LoopMember m = Held(Vary(a, MemberKind::kAsStated, "as stated, at rest", {}), a.friction.sigma0_N_m,
                      a.friction.motor_share);
  m.bristle.damping_Ns_m = (1.0 - a.friction.motor_share) * a.friction.sigma1_Ns_m;
  return m;
}

LoopMember CreepingMember(const LoopAxis& a, double velocity_m_s) {
  LoopMember m = Vary(a, MemberKind::kAsStated,
                      "on the Stribeck slope at " + RoundedText(1e3 * velocity_m_s) + " mm/s", {});
  m.bristle = BristleAt(a.friction, velocity_m_s);
  return m;
}

std::vector<LoopMember> UncertaintySet(const LoopAxis& a) {
  std::vector<LoopMember> set = AsStated(a);
  for (LoopMember& m : FarOff(a)) set.push_back(std::move(m));
  LoopMember late = SlidingMember(a);
  late.name = "one more cycle of delay";
  late.kind = MemberKind::kLate;
  ++late.axis.delay_cycles;
  set.push_back(std::move(late));
  return set;
}

std::vector<double> SlopeSpeeds_m_s(const LoopAxis& a) {
  std::vector<double> speeds;
  for (const double speed : kSlopeSpeeds) speeds.push_back(speed * a.friction.vs_m_s);
  return speeds;
}

std::vector<LoopMember> CreepingSet(const LoopAxis& a) {
  std::vector<LoopMember> set = UncertaintySet(a);
  for (LoopMember& m : set) {
    if (m.bristle.decay_1_s > 0.0)
      m.kind = MemberKind::kCreeping;
    else if (HasBristle(m))
      m.kind = MemberKind::kHeld;
  }
  return set;
}

}  // namespace contour
