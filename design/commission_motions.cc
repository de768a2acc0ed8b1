#include "design/commission_motions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "analysis/text/format_text.h"
#include "config/loop_axis.h"
#include "core/two_inertia_loop.h"

namespace contour {
namespace {

/// The highest line of the multisine at rest, set by hand. Where cycles are slow, less: what their rate
/// bears.
constexpr double kShakenAtRest_Hz = 120.0;
/// Forces in those of rated torque: of the chirp, and of each line of the multisine.
constexpr double kChirpOfRated = 0.075;
constexpr double kLineOfRated = 0.0025;
constexpr int kLines = 12;
/// Where a drive leads: its reports have noise of its own loop, above which the chirp must stand.
constexpr double kMoreWhereDriveLeads = 2.0;
/// Where the chirp begins: in the stated mode of motor against table, which a catalogue knows to a factor of
/// 1.5, and at the highest.
constexpr double kBelowMode = 0.3;
constexpr double kHighestBegin_Hz = 100.0;
/// The chirp moves the axis to and fro by this share of the slowest stroke's speed at most, should the masses
/// be as light as a catalogue allows: the bristle must not turn back.
constexpr double kShareOfSlide = 0.6;
constexpr double kChirpPeriod_s = 0.5;
/// At the mode the motor swings, all the more where its table is the heavier of the two. It must not turn
/// back either, or the stroke falls into pieces that are too short to see the screw in. The slowest stroke is
/// up to this share of the way per second for it, and the chirp smaller beyond.
constexpr double kQuickestSlowStroke = 0.5;
/// Damping of a screw is in no catalogue.
constexpr double kLeastOfDamping = 0.5;
/// A sweep's oscillation overshoots what it leaves by that much.
constexpr double kSweepOvershoot = 1.17;

/// Shares of the stated level that steps of torque have.
constexpr std::array<double, 5> kTorqueSteps{0.3, 0.6, 0.9, 1.3, 1.8};
/// The spring of these steps lets the axis go so far; further where the axis's loop is no spring as stiff as
/// that, up to this share of its following error.
constexpr double kStepTravel_mm = 0.3;
constexpr double kStepsOfFollowingError = 0.6;
/// Numbers are rounded on their way.
constexpr double kSpringMargin = 1.01;

/// Torques in steps up to beyond break-away, both ways.
std::string TorqueSteps(double level_Nm, double most_Nm) {
  std::string list;
  for (const double share : kTorqueSteps)
    for (const double sign : {1.0, -1.0})
      list += (list.empty() ? "" : ", ") + FormatText("%.5f", sign * std::min(share * level_Nm, most_Nm));
  return list;
}

double RatedForce_N(const AxisConfig& axis) {
  return axis.drive.rated_torque_Nm / ToSi(axis.model.mechanics).radius_m_rad;
}

bool LedByDrive(const AxisConfig& axis) { return axis.drive.mode == DriveMode::kCsp; }

/// What the motions are made of, and where they have room.
class Motions {
 public:
  Motions(const CommissionPlan& plan, const AxisConfig& axis, double position_mm, double cycle_us)
      : axis_(axis),
        name_(plan.axis),
        limits_(plan.limits),
        cycle_us_(cycle_us),
        mechanics_(ToSi(axis.model.mechanics)),
        friction_(ToSi(axis.model.friction, mechanics_.radius_m_rad)),
        top_mm_s_(kCommissionShareOfTop * plan.limits.max_speed_mm_s),
        // Every program ends where it began, so the axis goes up from its place and down from it.
        up_mm_(plan.high_mm - kCommissionMargin_mm - position_mm),
        down_mm_(plan.low_mm + kCommissionMargin_mm - position_mm) {}

  void Slide() {
    // The shorter strokes go where there is room.
    const double turn = std::min(axis_.model.mechanics.lead_mm, limits_.travel_mm);
    const double sign = up_mm_ >= -down_mm_ ? 1.0 : -1.0;
    const double one_turn = sign * std::min(turn, std::max(up_mm_, -down_mm_));
    std::vector<double> fast;
    for (const double v : {10.0, 20.0, 50.0, 100.0})
      if (v < 0.8 * top_mm_s_) fast.push_back(v);
    fast.push_back(top_mm_s_);
    Add("slow strokes over a turn", Creep(one_turn, {2, 5}));
    BothWays("strokes over the whole way", fast, "");
    Add("slower than the Stribeck velocity", Creep(one_turn, {1}));
    Add("creeping", Creep(0.5 * one_turn, {0.5}));
    Add("creeping", Creep(0.2 * one_turn, {0.2}));
    Add("creeping", Creep(0.06 * one_turn, {0.1}));
  }

  void BreakAway() {
    // Of a sine of 1 Hz, the speed is 2 pi times as much.
    const double most_mm = top_mm_s_ / (2.0 * std::numbers::pi);
    std::string amplitudes;
    for (const double mm :
         {0.002, 0.005, 0.015, 0.05, 0.2, std::clamp(std::min(up_mm_, -down_mm_), 0.05, 1.0)})
      amplitudes += (amplitudes.empty() ? "" : ", ") + FormatText("%g", std::min(mm, most_mm));
    Add("reversals, from sticking to sliding",
        FormatText("shape: reversals\naxis: %s\namplitudes_mm: [%s]\nfrequency_hz: 1\ncycles: 2\n",
                   name_.c_str(), amplitudes.c_str()));
    const double level_Nm = mechanics_.radius_m_rad * 0.5 * (friction_.Fs_plus_N + friction_.Fs_minus_N);
    const double furthest_mm = kStepsOfFollowingError * axis_.limits.following_error_mm;
    // No spring acts where the drive holds the axis, and one of any stiffness where no loop does.
    const double stiffest_N_m = LedByDrive(axis_) ? std::numeric_limits<double>::infinity()
                                                  : StiffestSpring_N_m(axis_, 1e-6 * cycle_us_);
    const double held_Nm_mm = 1e-3 * mechanics_.radius_m_rad * stiffest_N_m;
    const double largest_Nm = std::min(kTorqueSteps.back() * level_Nm, limits_.max_torque_Nm);
    const double travel_mm =
        std::min(std::max(kStepTravel_mm, kSpringMargin * largest_Nm / held_Nm_mm), furthest_mm);
    const double most_Nm = std::min(limits_.max_torque_Nm, held_Nm_mm * travel_mm / kSpringMargin);
    Add("steps of torque at rest",
        FormatText(
            "shape: torque_steps\naxis: %s\ntravel_mm: %g\ntorques_Nm: [%s]\nhold_s: 0.1\nrest_s: 0.1\n",
            name_.c_str(), travel_mm, TorqueSteps(level_Nm, most_Nm).c_str()));
  }

  void Shake() {
    const double top_Hz = TopOfChirp_Hz();
    const double at_rest_Hz = std::min(kShakenAtRest_Hz, top_Hz);
    Add(FormatText("shaking at rest, 8 to %g Hz", at_rest_Hz),
        FormatText("shape: hold\nseconds: 4\ntorque: {axis: %s, kind: multisine, "
                   "amplitude_Nm: %.6f, frequency_min_hz: 8, "
                   "frequency_max_hz: %g, lines: %d}\n",
                   name_.c_str(), kLineOfRated * axis_.drive.rated_torque_Nm, at_rest_Hz, kLines));
    // Fast enough that a controller which swings, its mass being wrong, does not turn the axis back.
    const double travel = limits_.travel_mm;
    std::vector<double> slides;
    for (const double speed : ShakenSpeeds_mm_s(travel)) slides.push_back(std::min(speed, 0.8 * top_mm_s_));
    double& slowest = *std::min_element(slides.begin(), slides.end());
    double force_N = CommissionShaking_N(axis_);
    const double stirred_s_kg = SwingPerForce_s_kg(top_Hz - ChirpBegin_Hz(force_N, 1e-3 * slowest));
    const double most_mm_s = std::max(slowest, std::min(kQuickestSlowStroke * travel, 0.8 * top_mm_s_));
    slowest = std::clamp(1e3 * force_N * stirred_s_kg, slowest, most_mm_s);
    force_N = std::min(force_N, 1e-3 * slowest / stirred_s_kg);
    const double begin_Hz = ChirpBegin_Hz(force_N, 1e-3 * slowest);
    BothWays(FormatText("chirp while sliding, %.0f to %.0f Hz", begin_Hz, top_Hz), slides,
             FormatText("torque: {axis: %s, kind: chirp, amplitude_Nm: %.6f, frequency_min_hz: %.1f, "
                        "frequency_max_hz: %.0f, period_s: %g}\n",
                        name_.c_str(), force_N * mechanics_.radius_m_rad, begin_Hz, top_Hz, kChirpPeriod_s));
  }

  std::vector<CommissionMotion> Take() { return std::move(motions_); }

 private:
  std::string Creep(double stroke_mm, std::vector<double> speeds) const {
    for (double& v : speeds) v = std::min(v, top_mm_s_);
    return CreepProgram(name_, stroke_mm, speeds, 0.1);
  }

  void Add(std::string what, std::string yaml) { motions_.push_back({std::move(what), std::move(yaml)}); }

  /// Quicker where the chirp is larger, or it would turn the axis back, and as often as takes as long.
  [[nodiscard]] std::vector<double> ShakenSpeeds_mm_s(double travel) const {
    if (!LedByDrive(axis_)) return {std::max(3.0, travel / 4.0), 0.75 * travel, travel};
    return {0.5 * travel, 0.5 * travel, 0.75 * travel, travel};
  }
  /// Just below half the rate of the cycle. A chirp begins an octave below it at the latest, however slow the
  /// cycle.
  [[nodiscard]] double TopOfChirp_Hz() const { return 0.48e6 / cycle_us_; }
  [[nodiscard]] double ChirpBegin_Hz(double force_N, double slowest_m_s) const {
    const Mechanics& m = mechanics_;
    const double mode_Hz = ModeFrequency_Hz(TwoInertiaAxisOf(axis_));
    const double least_Hz =
        force_N / (kLightestOfCatalogue * m.mass_kg * 2.0 * std::numbers::pi * kShareOfSlide * slowest_m_s);
    return std::min({kHighestBegin_Hz, 0.5 * TopOfChirp_Hz(), std::max(kBelowMode * mode_Hz, least_Hz)});
  }

  /// Speed of the motor's swing at the mode per force of a chirp that goes through `range_Hz`, with a motor
  /// as light and a screw as little damped as may be: M2 / (M1 M) over the rate at which it fades, which for
  /// a frequency that grows by g per second is one of 2 sqrt(g) without damping.
  [[nodiscard]] double SwingPerForce_s_kg(double range_Hz) const {
    TwoInertiaAxis a = TwoInertiaAxisOf(axis_);
    a.motor_mass_kg *= kLightestOfCatalogue;
    const double mass_kg = a.motor_mass_kg + a.table_mass_kg;
    const double damping_1_s =
        kLeastOfDamping * a.damping_Ns_m * mass_kg / (a.motor_mass_kg * a.table_mass_kg);
    const double swept_1_s = 2.0 / (kSweepOvershoot * std::sqrt(kChirpPeriod_s / range_Hz));
    return a.table_mass_kg / (a.motor_mass_kg * mass_kg * (damping_1_s + swept_1_s));
  }

  void BothWays(const std::string& what, const std::vector<double>& speeds, const std::string& torque) {
    if (up_mm_ > kLeastCommissionStroke_mm) Add(what + ", upwards", Creep(up_mm_, speeds) + torque);
    if (-down_mm_ > kLeastCommissionStroke_mm) Add(what + ", downwards", Creep(down_mm_, speeds) + torque);
  }

  const AxisConfig& axis_;
  const std::string& name_;
  const CommissionLimits& limits_;
  const double cycle_us_;
  const Mechanics mechanics_;
  const Friction friction_;
  const double top_mm_s_, up_mm_, down_mm_;
  std::vector<CommissionMotion> motions_;
};

}  // namespace

std::string CreepProgram(const std::string& axis, double stroke_mm, const std::vector<double>& speeds_mm_s,
                         double dwell_s) {
  std::string list;
  for (const double v : speeds_mm_s) list += (list.empty() ? "" : ", ") + FormatText("%g", v);
  return FormatText("shape: creep\naxis: %s\nstroke_mm: %.6f\nvelocities_mm_s: [%s]\ndwell_s: %g\n",
                    axis.c_str(), stroke_mm, list.c_str(), dwell_s);
}

double CommissionChirp_N(const AxisConfig& axis) { return kChirpOfRated * RatedForce_N(axis); }

double CommissionShaking_N(const AxisConfig& axis) {
  return (LedByDrive(axis) ? kMoreWhereDriveLeads : 1.0) * CommissionChirp_N(axis);
}

std::vector<CommissionMotion> CommissionMotions(const CommissionPlan& plan, const AxisConfig& axis,
                                                double position_mm, double cycle_us) {
  Motions motions(plan, axis, position_mm, cycle_us);
  motions.Slide();
  motions.BreakAway();
  motions.Shake();
  return motions.Take();
}

}  // namespace contour
