#include "design/loop_report.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "config/number_text.h"

namespace contour {
namespace {

// A written tuning is rounded, and a limit that is missed by so little bounds nothing.
constexpr double kRounding = 0.05;
// Of what is stated, beyond which a number is not expected to be.
constexpr double kDeviations = 2.0;

std::string Fixed(double value, int decimals) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

std::string Line(const char* state, const LoopMargins& m) {
  const std::string begin = std::string("  ") + state + ": ";
  if (!m.stable) return begin + "unstable, growing by " + Fixed(m.growth_per_cycle, 4) + " a cycle\n";
  std::string gain = std::isfinite(m.gain_up) ? Fixed(m.gain_up, 1) : "without limit";
  if (m.gain_down > 0.0) gain += " (down 1 / " + Fixed(1.0 / m.gain_down, 1) + ")";
  return begin + "gain margin " + gain + ", phase margin " + Fixed(m.phase_deg, 0) +
         " degrees, modulus margin " + Fixed(1.0 / m.peak, 2) + " (peak " + Fixed(m.peak, 2) + " at " +
         Fixed(m.peak_Hz, 0) + " Hz), bandwidth " + Fixed(m.bandwidth_Hz, 1) + " Hz\n";
}

constexpr std::array<const char*, kMemberKinds> kKinds{"as stated", "far off", "late", "held", "creeping"};

/// Members that creep have none.
std::string Limit(std::size_t kind, const WorstMember& w) {
  if (static_cast<MemberKind>(kind) == MemberKind::kCreeping) return "";
  const bool rounded = w.peak > w.limit && w.peak <= w.limit * (1.0 + kRounding);
  return ", limit " + Fixed(w.limit, 2) +
         (rounded ? ", kept: a tuning that is rounded may exceed it by " + Fixed(100.0 * kRounding, 0) + " %"
                  : "");
}

std::string Describe(const StickSlip& s) {
  const auto mm_s = [](double v_m_s) { return RoundedText(1e3 * v_m_s); };
  std::string text =
      "  friction falls with speed faster than a loop in torque mode follows here; held and creeping, the "
      "axis has less margin: ";
  if (s.slowest_m_s < s.fastest_m_s)
    text += "from " + mm_s(s.slowest_m_s) + " to " + mm_s(s.fastest_m_s) + " mm/s its table sticks and slips";
  else
    text += s.Sticks() ? "its table sticks and slips" : "its table swings";
  return text + " by up to " + Fixed(1e6 * s.swing_m, 1) + " um, most at " + mm_s(s.at_m_s) +
         " mm/s; with drive.mode: csp the drive's own loop follows\n";
}

std::string NotTakenUp(const ForceStep& step) {
  return "a force is not taken up, after 200 ms the table is still off by " + Fixed(1e6 * step.left_m, 1) +
         " of " + Fixed(1e6 * step.peak_m, 1) + " um";
}

std::string WhyNoRest(const StickSlip& s) {
  if (s.ComesToRest()) return "";
  if (!s.Settles())
    return "from three seconds after a stop the table still moves by " + Fixed(1e6 * s.stop_m, 1) +
           " um, limit " + Fixed(1e6 * s.most_stop_m, 1);
  return "at rest the table hunts by " + Fixed(1e6 * s.rest_m, 1) + " um, limit " +
         Fixed(1e6 * s.most_rest_m, 1);
}

RestingAxis RestingOf(const LoopAxis& a, const LoopTuning& tuning) {
  return {.mass_kg = a.axis.motor_mass_kg + a.axis.table_mass_kg,
          .step_N = kTorqueStep * a.rated_force_N,
          .friction_N = std::min(a.friction.Fc_plus_N, a.friction.Fc_minus_N),
          .stiffness_N_m = a.axis.stiffness_N_m,
          .sigma0_N_m = a.friction.sigma0_N_m,
          .sigma1_Ns_m = a.friction.sigma1_Ns_m,
          .regulator_Hz = tuning.regulator_Hz};
}

/// Nothing of an axis that friction holds.
std::string Describe(const RestingAxis& a) {
  const std::string swings =
      "at rest the loop holds the axis and may swing it by " + Fixed(1e6 * StepMoves_m(a), 2) + " um";
  switch (WhatHolds(a)) {
    case Holder::kFriction:
      return "";
    case Holder::kLoopFewSteps:
      return "  friction of " + Fixed(a.friction_N, 1) + " N holds fewer than " + Fixed(kHeldSteps, 0) +
             " steps of torque (a thousandth of rated, " + Fixed(a.step_N, 2) + " N): " + swings +
             "; a smaller rated torque has finer steps\n";
    case Holder::kLoopLongRinging:
      return "  bristles that hold less than the loop ring for long: " + swings + "\n";
  }
  return "";
}

/// Nothing of an axis whose bristles are softer than its screw, or that has a scale.
std::string Describe(const RestingScrew& s) {
  if (!std::isfinite(s.stable_below_N_m)) return "";
  const double stiffer = s.stable_below_N_m / s.stated_N_m - 1.0;
  const std::string text =
      "  at rest the lead by friction over stiffness is stable with a screw of less than " +
      RoundedText(1e-6 * s.stable_below_N_m) + " N/um, " + Fixed(100.0 * stiffer, 0) +
      " % stiffer than stated";
  if (stiffer > kDeviations * s.stated_std) return text + "\n";
  return text + ", and stated is " + Fixed(100.0 * s.stated_std, 0) +
         " %: if it is that stiff, the table hunts after a stop; the loop then keeps its torque constant, "
         "and the table stays off its target. Identify the stiffness, or let a scale measure the table\n";
}

/// Whether friction's slope alone is more than the limits of the axis as stated allow.
bool SlopeForbids(const LoopAxis& axis, const LoopVerdict& creeping) {
  const WorstMember& slope = creeping.worst[static_cast<std::size_t>(MemberKind::kCreeping)];
  return !slope.stable || slope.peak > axis.limits.peak_as_stated * (1.0 + kRounding);
}

}  // namespace

RestingScrew RestingScrewOf(const LoopAxis& a) {
  RestingScrew screw{.stated_N_m = a.axis.stiffness_N_m, .stated_std = a.stiffness_std};
  const double on_table_N_m = (1.0 - a.friction.motor_share) * a.friction.sigma0_N_m;
  if (!a.scale_step_m && on_table_N_m > a.axis.stiffness_N_m)
    screw.stable_below_N_m = 1.0 / (1.0 / a.axis.stiffness_N_m - 1.0 / on_table_N_m);
  return screw;
}

LoopReport ReportOn(const LoopAxis& axis, const LoopTuning& tuning, double period_s) {
  const TwoInertiaLoop loop = DesignLoop(axis.axis, tuning, period_s, axis.scale_step_m.has_value());
  LoopReport report{LoopJudge(axis, period_s).Judge(loop),
                    MarginsOn(SlidingMember(axis), loop, period_s),
                    MarginsOn(RestingMember(axis), loop, period_s),
                    {},
                    {},
                    RestingOf(axis, tuning),
                    RestingScrewOf(axis)};
  if (Acceptable(report.verdict, kRounding)) {
    if (!TakesUp(report.verdict.step, kRounding)) report.after_stops = RestAfterStops(axis, loop, period_s);
    return report;
  }
  const LoopVerdict creeping = LoopJudge(axis, period_s, CreepingSet(axis)).Judge(loop);
  if (!SlopeForbids(axis, creeping) || !Acceptable(creeping, kRounding)) return report;
  report.verdict = creeping;
  report.stick_slip = StickSlipOf(axis, loop, period_s);
  return report;
}

std::string Describe(const LoopReport& r) {
  std::string text = Line("sliding", r.sliding) + Line("at rest", r.rest);
  for (std::size_t i = 0; i < kMemberKinds; ++i) {
    const WorstMember& w = r.verdict.worst[i];
    if (w.name.empty()) continue;  // the set has no member of this kind
    text += std::string("  worst of the axis ") + kKinds[i] + ": " +
            (w.stable ? "peak " + Fixed(w.peak, 2) + Limit(i, w) : "unstable") + " (" + w.name + ")\n";
  }
  text += "  binding: " + Binding(r.verdict).name + "\n";
  text += "  expected error of the table under the force step: " + Fixed(1e6 * r.verdict.step.peak_m, 1) +
          " um at most, " + Fixed(1e6 * r.verdict.step.mean_m, 1) + " um on average over 200 ms, " +
          (TakesUp(r.verdict.step, kRounding)
               ? "a tenth of it left after " + Fixed(1e3 * r.verdict.step.gone_s, 0) + " ms"
               : "still " + Fixed(1e6 * r.verdict.step.left_m, 1) + " um after them") +
          "\n";
  if (r.stick_slip) text += Describe(*r.stick_slip);
  text += Describe(r.resting) + Describe(r.screw);
  return text + "  torque noise by the encoder: " + Fixed(100.0 * r.verdict.torque_noise, 2) +
         " % of rated torque\n";
}

double Compliance_m_N(const LoopAxis& axis, const LoopReport& report) {
  return report.verdict.step.peak_m / (axis.limits.force_step * axis.rated_force_N);
}

std::string WhatIsWrong(const LoopVerdict& v) {
  if (Acceptable(v, kRounding)) return "";
  const WorstMember& w = Limiting(v);
  if (!w.stable) return "unstable: " + w.name;
  if (w.peak > w.limit * (1.0 + kRounding))
    return "peak " + Fixed(w.peak, 2) + ", limit " + Fixed(w.limit, 2) + ": " + w.name;
  return "torque noise of " + Fixed(100.0 * v.torque_noise, 2) + " % of rated torque, limit " +
         Fixed(100.0 * v.noise_limit, 2) + " %";
}

std::string WhatIsWrong(const LoopReport& r) {
  const std::string wrong = WhatIsWrong(r.verdict);
  if (!wrong.empty()) return wrong;
  if (r.after_stops) {
    const std::string rest = WhyNoRest(*r.after_stops);
    return rest.empty() ? "" : NotTakenUp(r.verdict.step) + ", and " + rest;
  }
  if (!r.stick_slip) return "";
  const std::string why =
      TakesUp(r.verdict.step, kRounding) ? WhyNoRest(*r.stick_slip) : NotTakenUp(r.verdict.step);
  return why.empty() ? "" : why + ": " + Binding(r.verdict).name;
}

}  // namespace contour
