#include "tools/validation/hidden/hide_effect.h"

#include <algorithm>
#include <cmath>

#include "tools/validation/hidden/machine_text.h"

namespace contour::hidden {
namespace {

/// Share of a drift that is done at a time of the machine (the emulator's definition).
double DriftDone(const Hidden& h, const LogSpan& span, double time_s) {
  return h.second > 0.0 ? 1.0 - std::exp(-time_s / h.second) : std::min(1.0, time_s / span.planned_end_s);
}

}  // namespace

const std::vector<std::string>& OutsideKinds() {
  static const std::vector<std::string> kinds = {"stick_spot", "cable_hysteresis", "telegraph_torque",
                                                 "lubrication", "speed_band_torque"};
  return kinds;
}

void HideEffect(const Hidden& h, const Setting& s, double begin_s, double duration_s, EffectsConfig& e) {
  const TrueAxis& t = s.truth;
  const double max_rad_s = kSpeedLimit_mm_s * 1e-3 / t.radius_m_rad();
  if (h.kind == "asymmetric_coulomb") e.asymmetric_coulomb = AsymmetricCoulombEffect{h.size};
  if (h.kind == "constant_torque") e.constant_torque = ConstantTorqueEffect{h.size};
  if (h.kind == "stribeck") e.stribeck = StribeckEffect{1.0 + h.size, h.second};
  if (h.kind == "position_friction")
    e.position_friction = PositionFrictionEffect{h.size, h.order, h.phase_rad};
  if (h.kind == "cable_spring") e.cable_spring = CableSpringEffect{h.size, 0.0};
  if (h.kind == "friction_ripple") e.friction_ripple = RippleEffect{{h.size, h.order, h.phase_rad}, {}};
  if (h.kind == "ball_ripple") e.ball_ripple = RippleEffect{{h.size, h.order, h.phase_rad}, {}};
  if (h.kind == "cogging") e.cogging = CoggingEffect{{h.size, h.order, h.phase_rad}, {}};
  if (h.kind == "viscous_nonlinear")
    e.viscous_nonlinear = ViscousNonlinearEffect{{h.size, max_rad_s, h.order}, {}};
  if (h.kind == "temperature_viscosity") e.temperature_viscosity = TemperatureViscosityEffect{h.size};
  if (h.kind == "friction_drift")
    e.friction_drift = FrictionDriftEffect{h.size, begin_s + duration_s, h.second};
  if (h.kind == "torque_constant") e.torque_constant = TorqueConstantEffect{1.0 + h.size};
  if (h.kind == "torque_saturation") e.torque_saturation = TorqueSaturationEffect{h.size};
  if (h.kind == "payload_step") e.payload_step = PayloadStepEffect{h.size, begin_s + h.second * duration_s};
  if (h.kind == "compliance") e.compliance = ComplianceEffect{1.0 / h.size, h.second};
  if (h.kind == "backlash") e.backlash = BacklashEffect{h.size};
  if (h.kind == "presliding_hysteresis")
    e.presliding_hysteresis = PreslidingHysteresisEffect{h.size, h.second};
  if (h.kind == "input_delay") e.input_delay = InputDelayEffect{h.size};
  if (h.kind == "current_lag") e.current_lag = CurrentLagEffect{h.size};
  if (h.kind == "encoder_eccentricity")
    e.encoder_eccentricity = EncoderEccentricityEffect{h.size, h.phase_rad};
  if (h.kind == "encoder_subdivision")
    e.encoder_subdivision = EncoderSubdivisionEffect{h.size, h.order, h.phase_rad};
  if (h.kind == "pitch_error") e.pitch_error = PitchErrorEffect{h.size, h.order, h.phase_rad};
  if (h.kind == "cross_coupling") e.cross_coupling = CrossCouplingEffect{"y", h.size};
  if (h.kind == "load_friction") e.load_friction = LoadFrictionEffect{h.size};
  if (h.kind == "periodic_force") e.periodic_force = PeriodicForceEffect{h.size, h.order, h.phase_rad};
  if (h.kind == "sample_jitter") e.sample_jitter = SampleJitterEffect{h.size};
  OutsideEffectsConfig o = e.outside.value_or(OutsideEffectsConfig{});
  if (h.kind == "stick_spot")
    o.stick_spot = StickSpotEffect{h.size, h.order * t.half_stroke_mm, 3.0, h.second > 0.0 ? 1 : -1};
  if (h.kind == "cable_hysteresis") o.cable_hysteresis = CableHysteresisEffect{h.size, 15.0};
  if (h.kind == "telegraph_torque") o.telegraph_torque = TelegraphTorqueEffect{h.size, 0.4};
  if (h.kind == "lubrication") o.lubrication = LubricationEffect{h.size, 700.0};
  if (h.kind == "speed_band_torque")
    o.speed_band_torque = SpeedBandTorqueEffect{h.size, h.second * max_rad_s, (h.second + 0.3) * max_rad_s};
  const auto& outside = OutsideKinds();
  if (std::find(outside.begin(), outside.end(), h.kind) != outside.end()) e.outside = o;
}

std::map<std::string, double> TruthOf(const Hidden& h, const LogSpan& span) {
  if (h.kind == "asymmetric_coulomb") return {{"difference_rel", h.size}};
  if (h.kind == "constant_torque") return {{"torque_Nm", h.size}};
  if (h.kind == "stribeck") return {{"Fs_over_Fc", 1.0 + h.size}, {"vs_rad_s", h.second}};
  if (h.kind == "position_friction") return {{"amplitude_rel", std::abs(h.size)}};
  if (h.kind == "cable_spring") {
    // The largest torque within the travel that the log covers: the stroke of the machine file.
    return {{"torque_at_stroke_end_Nm", h.size}};
  }
  if (h.kind == "friction_ripple" || h.kind == "ball_ripple")
    return {{"amplitude_rel", std::abs(h.size)}, {"order_per_rev", h.order}};
  if (h.kind == "cogging") return {{"amplitude_Nm", std::abs(h.size)}, {"order_per_rev", h.order}};
  if (h.kind == "viscous_nonlinear")
    return {{"torque_at_max_speed_Nm",
             h.size * std::pow(span.largest_speed_rad_s / span.speed_limit_rad_s, h.order)}};
  if (h.kind == "temperature_viscosity") return {{"rate_1_K", h.size}};
  if (h.kind == "friction_drift") {
    const double first = 1.0 + h.size * DriftDone(h, span, span.begin_s);
    const double last = 1.0 + h.size * DriftDone(h, span, span.end_s);
    return {{"change_rel", last / first - 1.0}};
  }
  if (h.kind == "torque_constant") return {{"ratio", 1.0 + h.size}};
  if (h.kind == "torque_saturation") return {{"loss_at_rated_rel", h.size}};
  if (h.kind == "payload_step") return {{"inertia_change_rel", h.size}};
  if (h.kind == "compliance") return {{"antiresonance_Hz", 1.0 / h.size}};
  if (h.kind == "backlash") return {{"gap_um", h.size}};
  if (h.kind == "presliding_hysteresis") return {{"share_rel", h.size}};
  if (h.kind == "input_delay") return {{"delay_us", h.size}};
  if (h.kind == "current_lag") return {{"time_constant_us", h.size}};
  if (h.kind == "encoder_eccentricity") return {{"amplitude_rad", std::abs(h.size)}};
  if (h.kind == "encoder_subdivision")
    return {{"amplitude_rad", std::abs(h.size)}, {"order_per_rev", h.order}};
  if (h.kind == "pitch_error") return {{"amplitude_um", std::abs(h.size)}};
  if (h.kind == "cross_coupling") return {{"torque_per_acceleration_Nms2_m", h.size}};
  if (h.kind == "load_friction") return {{"friction_per_torque_rel", h.size}};
  if (h.kind == "periodic_force") return {{"amplitude_Nm", std::abs(h.size)}, {"frequency_Hz", h.order}};
  if (h.kind == "sample_jitter") return {{"rms_us", h.size}};
  return {};
}

double LargestSize(const Hidden& h) {
  if (h.kind == "asymmetric_coulomb" || h.kind == "friction_drift") return 0.8;
  if (h.kind == "position_friction" || h.kind == "friction_ripple" || h.kind == "ball_ripple") return 0.8;
  if (h.kind == "stribeck") return 2.0;
  if (h.kind == "stick_spot") return 15.0;
  if (h.kind == "lubrication") return 2.0;
  if (h.kind == "torque_saturation") return 0.3;
  if (h.kind == "payload_step") return 0.3;
  if (h.kind == "presliding_hysteresis") return 0.8;
  if (h.kind == "load_friction") return 0.5;
  if (h.kind == "compliance") return 1.0 / 60.0;
  if (h.kind == "backlash") return 200.0;
  if (h.kind == "input_delay" || h.kind == "current_lag") return 2000.0;
  if (h.kind == "temperature_viscosity") return 0.09;
  if (h.kind == "sample_jitter") return 400.0;
  if (h.kind == "encoder_eccentricity") return 0.05;
  return 1e9;
}

}  // namespace contour::hidden
