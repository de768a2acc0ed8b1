#include "analysis/diagnosis/causes/kind_words.h"

#include <algorithm>
#include <array>

#include "config/key_hints.h"
#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

struct Words {
  std::string_view kind, words, advice;
};

constexpr std::array<Words, 26> kWords = {{
    {"asymmetric_coulomb", "dry friction differs between the directions",
     "Give the model a Coulomb level per direction; look for a preloaded cover or wiper that drags one way."},
    {"constant_torque", "a torque that is always there: weight, or an offset of the current sensor",
     "State it as a constant torque; check the counterbalance and the drive's current offset."},
    {"stribeck", "friction rises more, or at another speed, towards standstill than the model says",
     "Take over break-away level and Stribeck velocity; check the lubrication."},
    {"position_friction", "friction changes along the stroke",
     "Feed the friction map forward; look for a bent screw, misaligned guides or uneven preload where it is "
     "high."},
    {"cable_spring",
     "a force that depends on the position, the same in both directions: a cable, hose or cover",
     "Feed the force forward; check the routing of cables and hoses and the bellows."},
    {"friction_ripple", "friction changes a whole number of times per motor turn",
     "Feed the ripple forward; look at coupling alignment and the screw's run-out."},
    {"ball_ripple",
     "friction changes with the circulation of the balls, not a whole number of times per turn",
     "Feed the ripple forward; look at the nut's ball returns and its preload."},
    {"cogging",
     "a torque that repeats with the motor angle, the same in both directions: detent torque of the motor",
     "Feed the torque forward."},
    {"viscous_nonlinear", "viscous friction is not proportional to speed",
     "Take over the curve; at high speed expect less or more torque than the model says."},
    {"temperature_viscosity", "viscous friction changes with temperature",
     "Let the model use the temperature; warm the axis up before precise work."},
    {"friction_drift", "friction changes over the time of the log",
     "Warm up or run in longer before identifying; let the estimator follow the level."},
    {"torque_constant", "the motor gives another torque than stated for the same command",
     "Correct the rated torque or the torque constant; check the motor's data in the drive."},
    {"torque_saturation", "torque falls short at high current",
     "Lower the torque limit or the accelerations, or state the saturation."},
    {"payload_step", "the moving mass changed during the log",
     "Identify with one payload; tell the controller when the payload changes."},
    {"compliance", "the axis is softer than the model says: a resonance between motor and table",
     "Take over stiffness and damping; check coupling, nut and bearing for play and preload."},
    {"backlash", "free play between motor and table", "Preload or replace the nut or coupling."},
    {"presliding_hysteresis", "a second, softer friction element acts before the axis slides",
     "Expect larger tracking errors right after reversals; a model with several elements describes it."},
    {"input_delay", "commands begin to act later than stated",
     "State the delay; look for a filter or a cycle of delay in the drive."},
    {"current_lag", "the current loop is slower than stated", "State the lag; retune the current loop."},
    {"encoder_eccentricity", "the encoder's disc is off centre: one wave of angle error per turn",
     "Correct the angle with a table; have the encoder remounted."},
    {"encoder_subdivision", "the encoder interpolates unevenly inside each line",
     "Correct the angle with a table; clean or align the encoder."},
    {"pitch_error", "the screw's lead is not the same everywhere",
     "Use the table of pitch errors to correct positions."},
    {"cross_coupling", "the other axis pushes this one when it accelerates",
     "Feed the other axis's acceleration forward."},
    {"load_friction", "friction grows with the force that the screw carries",
     "Expect more friction under load and acceleration; check nut and bearing load."},
    {"periodic_force", "a vibration from outside at a fixed frequency",
     "Find the machine, pump or fan that runs at that frequency."},
    {"sample_jitter", "positions are not sampled exactly at their instants",
     "Latch the position at the SYNC; check the drive's synchronisation."},
}};

const Words* Find(std::string_view kind) {
  const auto at = std::find_if(kWords.begin(), kWords.end(), [&](const Words& w) { return w.kind == kind; });
  return at == kWords.end() ? nullptr : &*at;
}

}  // namespace

std::string KindWords(std::string_view kind) {
  const Words* w = Find(kind);
  return std::string(kind) + (w == nullptr ? "" : ": " + std::string(w->words));
}

std::string KindAdvice(std::string_view kind) {
  const Words* w = Find(kind);
  return w == nullptr ? "" : std::string(w->advice);
}

std::string ValueWords(std::string_view parameter, double value) {
  const std::string unit = SplitUnit(parameter).unit;
  if (parameter.ends_with("_rel")) return RoundedText(100.0 * value) + " %";
  return RoundedText(value) + (unit.empty() ? "" : " " + UnitText(unit));
}

std::string ParameterWords(std::string_view parameter) {
  std::string stem = parameter.ends_with("_rel") ? std::string(parameter.substr(0, parameter.size() - 4))
                                                 : SplitUnit(parameter).stem;
  std::replace(stem.begin(), stem.end(), '_', ' ');
  return stem;
}

}  // namespace contour::diagnosis
