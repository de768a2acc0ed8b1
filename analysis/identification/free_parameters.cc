#include "analysis/identification/free_parameters.h"

#include <algorithm>

namespace contour::identify {
namespace {

/// A bristle's damping shows while it is bent within micrometres, as a share of a newton: where a drive
/// leads, its reports are rounded to that, and what else they do not show is taken for damping, up to six
/// times of it.
const std::vector<std::string> kHiddenByReports = {"sigma1_Ns_m", "sigma1_decay_mm_s"};

/// What a drive's answer may have besides its ramp, of the offset's step.
constexpr double kAnswer = 0.03;

using Parameters = std::vector<FreeParameter>;

FreeParameter Factor(const char* key, double* (*at)(TableAxis&), double prior, double step) {
  return {key, at, true, prior, step};
}
FreeParameter Number(const char* key, double* (*at)(TableAxis&), double prior, double step) {
  return {key, at, false, prior, step};
}

Parameters ScrewParameters() {
  return {
      Factor(
          "table_mass_kg", [](TableAxis& a) { return &a.load_inertia; }, 0.5, 1e-3),
      Factor(
          "screw_damping_Ns_m", [](TableAxis& a) { return &a.damping; }, 1.0, 5e-3),
      Number(
          "lag_s", [](TableAxis& a) { return &a.lag_s; }, 2e-4, 1e-6),
      Number(
          "delay_s", [](TableAxis& a) { return &a.delay_s; }, 5e-5, 1e-6),
  };
}

Parameters FrictionParameters(const TableAxis& axis) {
  const double level_N = 0.5 * (axis.friction.Fc_plus + axis.friction.Fc_minus);
  return {
      Factor(
          "Fs_plus_N", [](TableAxis& a) { return &a.friction.Fs_plus; }, 1.0, 2e-3),
      Factor(
          "Fs_minus_N", [](TableAxis& a) { return &a.friction.Fs_minus; }, 1.0, 2e-3),
      Factor(
          "Fc_plus_N", [](TableAxis& a) { return &a.friction.Fc_plus; }, 1.0, 1e-3),
      Factor(
          "Fc_minus_N", [](TableAxis& a) { return &a.friction.Fc_minus; }, 1.0, 1e-3),
      Factor(
          "vs_mm_s", [](TableAxis& a) { return &a.friction.vs; }, 1.0, 5e-3),
      Factor(
          "sigma0_N_m", [](TableAxis& a) { return &a.friction.s0; }, 1.0, 3e-3),
      Factor(
          "sigma1_Ns_m", [](TableAxis& a) { return &a.friction.s1; }, 1.0, 1e-2),
      Factor(
          "sigma1_decay_mm_s", [](TableAxis& a) { return &a.friction.vd; }, 0.7, 1e-2),
      Factor(
          "sigma2_Ns_m", [](TableAxis& a) { return &a.friction.s2; }, 1.0, 2e-3),
      Number(
          "offset_N", [](TableAxis& a) { return &a.offset; }, 0.25 * level_N, 5e-4 * level_N),
  };
}

Parameters VariationParameters() {
  return {
      Number(
          "place_1", [](TableAxis& a) { return &a.variation.place[0]; }, 0.2, 1e-3),
      Number(
          "place_2", [](TableAxis& a) { return &a.variation.place[1]; }, 0.2, 1e-3),
      Number(
          "place_3", [](TableAxis& a) { return &a.variation.place[2]; }, 0.2, 1e-3),
      Number(
          "turn_plus_cos1", [](TableAxis& a) { return &a.variation.turn_plus[0]; }, 0.2, 1e-3),
      Number(
          "turn_plus_sin1", [](TableAxis& a) { return &a.variation.turn_plus[1]; }, 0.2, 1e-3),
      Number(
          "turn_plus_cos2", [](TableAxis& a) { return &a.variation.turn_plus[2]; }, 0.1, 1e-3),
      Number(
          "turn_plus_sin2", [](TableAxis& a) { return &a.variation.turn_plus[3]; }, 0.1, 1e-3),
      Number(
          "turn_minus_cos1", [](TableAxis& a) { return &a.variation.turn_minus[0]; }, 0.2, 1e-3),
      Number(
          "turn_minus_sin1", [](TableAxis& a) { return &a.variation.turn_minus[1]; }, 0.2, 1e-3),
      Number(
          "turn_minus_cos2", [](TableAxis& a) { return &a.variation.turn_minus[2]; }, 0.1, 1e-3),
      Number(
          "turn_minus_sin2", [](TableAxis& a) { return &a.variation.turn_minus[3]; }, 0.1, 1e-3),
  };
}

template <std::size_t I>
void AddWave(const TableAxis& axis, double level_N, Parameters& p) {
  if (axis.cogging[I].order <= 0.0) return;
  const std::string number = std::to_string(I + 1);
  p.push_back({"cogging_cos" + number, [](TableAxis& a) { return &a.cogging[I].cosine_N; }, false,
               0.5 * level_N, 1e-3 * level_N});
  p.push_back({"cogging_sin" + number, [](TableAxis& a) { return &a.cogging[I].sine_N; }, false,
               0.5 * level_N, 1e-3 * level_N});
}

/// Of a drive that closes its own loop: velocity gains are some hundreds to thousands a second.
Parameters LoopParameters() {
  return {
      Number(
          "answer_gain", [](TableAxis& a) { return &a.answer.gain; }, 1.0, 1e-2),
      Number(
          "answer_delay_s", [](TableAxis& a) { return &a.answer.delay_s; }, 1e-4, 2e-6),
      Number(
          "answer_next", [](TableAxis& a) { return &a.answer.step[0]; }, kAnswer, 1e-3),
      Number(
          "answer_step", [](TableAxis& a) { return &a.answer.step[1]; }, kAnswer, 1e-3),
      Number(
          "answer_after_1", [](TableAxis& a) { return &a.answer.step[2]; }, kAnswer, 1e-3),
      Number(
          "answer_after_2", [](TableAxis& a) { return &a.answer.step[3]; }, kAnswer, 1e-3),
  };
}

/// What the model of the machine file has no keys for.
Parameters Besides(const TableAxis& axis) {
  const double level_N = 0.5 * (axis.friction.Fc_plus + axis.friction.Fc_minus);
  Parameters p;
  if (axis.two_inertia && axis.friction_on_load)
    p.push_back(Number(
        "motor_friction_share", [](TableAxis& a) { return &a.motor_friction_share; }, 0.3, 5e-3));
  if (axis.side.share > 0.0) {
    p.push_back(Number(
        "side_share", [](TableAxis& a) { return &a.side.share; }, 0.2, 1e-3));
    p.push_back(Factor(
        "side_frequency_Hz", [](TableAxis& a) { return &a.side.frequency_Hz; }, 0.3, 1e-3));
    p.push_back(Factor(
        "side_damping", [](TableAxis& a) { return &a.side.damping_ratio; }, 1.0, 1e-2));
  }
  AddWave<0>(axis, level_N, p);
  AddWave<1>(axis, level_N, p);
  AddWave<2>(axis, level_N, p);
  return p;
}

}  // namespace

std::vector<FreeParameter> FreeParameters(const TableAxis& axis, bool led_by_drive,
                                          const FitOptions& options) {
  Parameters p = {Factor(
      "motor_inertia_kgm2", [](TableAxis& a) { return &a.motor_inertia; }, 1.0, 5e-4)};
  const auto add = [&](const Parameters& more) { p.insert(p.end(), more.begin(), more.end()); };
  if (options.screw) add(ScrewParameters());
  if (options.stiffness)
    add({Factor(
        "screw_stiffness_N_um", [](TableAxis& a) { return &a.stiffness; }, options.stiffness_prior, 5e-4)});
  add(FrictionParameters(axis));
  add(VariationParameters());
  add(Besides(axis));
  if (led_by_drive) add(LoopParameters());
  const auto in = [](const std::vector<std::string>& keys, const std::string& key) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  std::erase_if(p, [&](const FreeParameter& f) {
    if (led_by_drive && in(kHiddenByReports, f.key)) return true;
    return in(options.hold, f.key) || (!options.only.empty() && !in(options.only, f.key));
  });
  return p;
}

}  // namespace contour::identify
