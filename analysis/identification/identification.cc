#include "analysis/identification/identification.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "analysis/identification/bristle_start.h"
#include "analysis/identification/cogging_fit.h"
#include "analysis/identification/quiet_reports.h"
#include "analysis/text/format_text.h"

namespace contour::identify {
namespace {

constexpr int kHalfWidth = 4;  ///< samples of the average of Kinematics, to either side
constexpr std::size_t kStride = 4;
constexpr double kLargestLoop_m = 60e-6;
constexpr double kOverlay_s = 20.0;
constexpr double kDriveOff_s = 1.0;
constexpr double kLeastWindUpSigma = 0.003;
/// A rigid axis: the stiffness written over the least that it must have, and how unsure that is.
constexpr double kRigidBeyondLeast = 2.0;
constexpr double kRigidSigma = 0.5;

/// With what goes with the motor's angle as a force of its own.
std::vector<Instant> InstantsOf(const Measured& r, const TableAxis& axis, std::size_t stride) {
  std::vector<double> cogging_N;
  if (axis.cogging.front().order > 0.0)
    for (const double x : r.position_m) cogging_N.push_back(std::isfinite(x) ? Cogging_N(axis, x) : 0.0);
  return Kinematics(r, axis.delay_s, axis.lag_s, kHalfWidth, stride, cogging_N);
}

std::vector<Instant> AllInstants(const std::vector<Measured>& records, const TableAxis& axis,
                                 std::size_t stride) {
  std::vector<Instant> all;
  double offset_s = 0.0;
  for (const Measured& r : records) {
    for (Instant i : InstantsOf(r, axis, stride)) {
      i.time_s += offset_s;
      all.push_back(i);
    }
    offset_s += static_cast<double>(r.size()) * r.period_s + 1.0;
  }
  return all;
}

EncoderFindings LookAtEncoder(const std::vector<Measured>& records) {
  EncoderFindings e;
  // At rest the fourth difference holds noise and nothing else: its variance is 70 times that of a reading.
  std::vector<double> squares;
  for (const Measured& r : records) {
    for (std::size_t k = 2; k + 2 < r.size(); ++k) {
      if (!(r.present[k - 2] && r.present[k - 1] && r.present[k] && r.present[k + 1] && r.present[k + 2]))
        continue;
      const double* x = &r.position_m[k - 2];
      const double step = std::fabs(x[1] - x[0]);
      if (step > 1e-12 && (e.step_m == 0.0 || step < e.step_m)) e.step_m = step;
      const double fourth = x[0] - 4.0 * x[1] + 6.0 * x[2] - 4.0 * x[3] + x[4];
      squares.push_back(fourth * fourth / 70.0);
    }
  }
  if (squares.empty()) return e;
  // The quiet tenth of blocks, not the mean: motion and chirps are in the others.
  std::vector<double> blocks;
  for (std::size_t b = 0; b + 200 <= squares.size(); b += 200) {
    double sum = 0.0;
    for (std::size_t i = b; i < b + 200; ++i) sum += squares[i] / 200.0;
    blocks.push_back(sum);
  }
  if (blocks.empty()) return e;
  std::sort(blocks.begin(), blocks.end());
  e.noise_m = std::sqrt(blocks[blocks.size() / 5]);
  return e;
}

/// Grid points without a sample between others. What is longer than kDriveOff_s is no loss: the drive was
/// off.
double MissingShare(const std::vector<Measured>& records) {
  std::size_t there = 0, missing = 0;
  for (const Measured& r : records) {
    std::size_t gap = 0;
    bool begun = false;
    for (const std::uint8_t present : r.present) {
      if (present == 0) {
        ++gap;
        continue;
      }
      if (begun && static_cast<double>(gap) * r.period_s < kDriveOff_s) missing += gap;
      begun = true;
      gap = 0;
      ++there;
    }
  }
  return there > 0 ? static_cast<double>(missing) / static_cast<double>(there + missing) : 1.0;
}

void SetMass(TableAxis& axis, double mass_kg) {
  const double factor = mass_kg / axis.mass_kg();
  axis.motor_inertia *= factor;
  axis.load_inertia *= factor;
}

/// Amplitude of a rigid axis under a force that shakes it as this stretch was shaken.
double RigidlyShaken_m(const Measured& r, double mass_kg, double frequency_Hz) {
  double sum_N = 0.0, square_N2 = 0.0, rows = 0.0;
  for (std::size_t k = r.run_up; k < r.size(); ++k) {
    if (r.present[k] == 0 || !std::isfinite(r.force_N[k])) continue;
    sum_N += r.force_N[k];
    square_N2 += r.force_N[k] * r.force_N[k];
    rows += 1.0;
  }
  if (rows == 0.0) return 0.0;
  const double variance_N2 = square_N2 / rows - std::pow(sum_N / rows, 2);
  const double amplitude_N = std::numbers::sqrt2 * std::sqrt(std::max(0.0, variance_N2));
  return amplitude_N / (mass_kg * std::pow(2.0 * std::numbers::pi * frequency_Hz, 2));
}

/// The screw, from shaking while sliding and from a linear scale.
void TakeScrew(Identification& id, const std::vector<Measured>& records, int threads) {
  TableAxis& axis = id.stepwise;
  id.shaken = FitShakenScrew(axis, records, threads);
  const ShakenScrew& s = id.shaken;
  if (s.verdict == ShakenScrew::Verdict::kFound) {
    axis.motor_inertia = s.axis.motor_inertia;
    axis.load_inertia = s.axis.load_inertia;
    axis.stiffness = s.axis.stiffness;
    axis.damping = s.axis.damping;
    axis.side = s.axis.side;
    axis.delay_s = s.axis.delay_s;
    axis.lag_s = s.axis.lag_s;
    axis.answer = s.axis.answer;
    // The bristle, too: sliding and shaken, it is a spring and a relaxation of some 100 Hz.
    axis.friction.s0 = s.axis.friction.s0;
    // Strokes go up and down, so each has a mean of its own.
    for (const Measured& stretch : ShakenStretches(records, axis))
      id.shaken.moves_m =
          std::max(id.shaken.moves_m, RigidlyShaken_m(stretch, axis.mass_kg(), id.shaken.antiresonance_Hz));
  }
  id.wind_up = FitWindUp(records, axis);
  if (s.verdict == ShakenScrew::Verdict::kRigid && !id.wind_up.found) {
    axis.motor_inertia = axis.mass_kg();
    axis.load_inertia = 0.0;
    axis.two_inertia = axis.friction_on_load = false;
    axis.delay_s = s.axis.delay_s;
    axis.lag_s = s.axis.lag_s;
    axis.answer = s.axis.answer;
  }
  if (id.wind_up.found) axis.stiffness = id.wind_up.stiffness_N_m;
  if (s.verdict == ShakenScrew::Verdict::kNotSeen) {
    id.notes.push_back("motor and table inertia are split as stated: " + s.why_not);
    if (!id.wind_up.found)
      id.notes.push_back("the screw's stiffness stays as stated: no linear scale, and " + s.why_not);
  }
}

/// The steps one after the other; each sees what those before have found.
void TakeSteps(Identification& id, const std::vector<Measured>& records, int threads) {
  TableAxis& axis = id.stepwise;
  const std::vector<Instant> coarse = AllInstants(records, axis, kStride);
  id.sliding = FitSliding(coarse, axis.friction.exponent, axis.radius_m_rad);
  axis.cogging = FindCogging(coarse, axis, id.sliding, (2 * kHalfWidth + 1) * records.front().period_s);
  if (axis.cogging.front().order > 0.0)
    id.sliding = FitSliding(AllInstants(records, axis, kStride), axis.friction.exponent, axis.radius_m_rad);
  if (!id.sliding.found) throw std::runtime_error("cannot identify friction: " + id.sliding.why_not);
  diagnosis::StatedFriction& f = axis.friction;
  SetMass(axis, id.sliding.mass_kg);
  if (id.sliding.offset_N != 0.0) axis.offset = id.sliding.offset_N;
  f.Fc_plus = id.sliding.Fc_plus_N;
  f.Fc_minus = id.sliding.Fc_minus_N;
  f.Fs_plus = id.sliding.Fs_plus_N;
  f.Fs_minus = id.sliding.Fs_minus_N;
  f.vs = id.sliding.vs_m_s;
  f.s2 = std::max(id.sliding.sigma2_Ns_m, 1e-3 * f.Fc_plus);

  if (axis.two_inertia) TakeScrew(id, records, threads);
  const std::vector<Instant> fine = AllInstants(records, axis, 1);
  const bool shaken = id.shaken.verdict == ShakenScrew::Verdict::kFound;
  for (int pass = 0; pass < 4; ++pass) {
    id.presliding = FitPresliding(fine, axis);
    if (!id.presliding.found || shaken) break;
    f.s0 = id.presliding.sigma0_N_m;
  }
  if (!id.presliding.found && !shaken)
    id.notes.push_back("few slow reversals: the bristle's stiffness begins from the stated value");
  std::vector<double> others_N_m{id.stated.friction.s0};
  if (id.presliding.found) others_N_m.push_back(id.presliding.sigma0_N_m);
  f.s0 = BristleToBeginWith_N_m(axis, records, others_N_m, threads);
  id.break_aways = BreakAways(fine, axis);
}

const std::vector<std::string> kScrewKeys = {
    "table_mass_kg", "screw_stiffness_N_um", "screw_damping_Ns_m", "delay_s",
    "lag_s",         "side_share",           "side_frequency_Hz",  "side_damping"};

/// The whole record says more of the screw than the shaken strokes only if they agree; and its curvature does
/// not show how the fit may jump where the axis comes to rest a cycle sooner or later. So nothing of the
/// screw is stated better than the shaken strokes alone state it, nor than the two agree.
void WidenByShaken(JointFit& fit, const ShakenScrew& shaken) {
  for (FittedParameter& p : fit.parameters) {
    if (p.key != "motor_inertia_kgm2" &&
        std::find(kScrewKeys.begin(), kScrewKeys.end(), p.key) == kScrewKeys.end())
      continue;
    for (const FittedParameter& s : shaken.parameters) {
      if (s.key != p.key) continue;
      const double apart = p.relative ? std::log(p.value / s.value) : p.value - s.value;
      p.sigma = std::max({p.sigma, s.sigma, std::fabs(apart)});
    }
  }
}

/// A rigid axis as a model with a screw, which all models have: the masses split as stated, and a screw that
/// does not show.
void StateRigid(Identification& id) {
  TableAxis& axis = id.fit.axis;
  const TableAxis& stated = id.stated;
  const double mass = axis.mass_kg();
  axis.load_inertia = mass * stated.load_inertia / stated.mass_kg();
  axis.motor_inertia = mass - axis.load_inertia;
  const double least_N_m =
      std::pow(2.0 * std::numbers::pi * kRigidFrom_Hz, 2) * axis.load_inertia * axis.motor_inertia / mass;
  axis.stiffness = std::max(stated.stiffness, kRigidBeyondLeast * least_N_m);
  axis.two_inertia = true;
  axis.friction_on_load = stated.friction_on_load;
  id.fit.parameters.push_back({"screw_stiffness_N_um", axis.stiffness, kRigidSigma, true, 0.0, 0.0});
  id.notes.push_back(
      FormatText("the axis is rigid: shaken up to %.0f Hz, it shows no screw with a resonance below %.0f Hz. "
                 "The masses are "
                 "split as stated; the screw's stiffness is at least %.0f N/um and written as %.0f",
                 id.shaken.highest_Hz, kRigidFrom_Hz, least_N_m * 1e-6, axis.stiffness * 1e-6));
}

/// All parameters at once; the screw is held first, and joins in when friction has found its place.
void FitAll(Identification& id, const std::vector<Measured>& records, int threads,
            const std::function<void(const char*, double)>& report) {
  const bool shaken = id.shaken.verdict == ShakenScrew::Verdict::kFound;
  FitOptions fit;
  fit.threads = threads;
  fit.screw = shaken;
  fit.stiffness = shaken || id.wind_up.found;
  fit.stiffness_prior = id.wind_up.found ? std::max(kLeastWindUpSigma, id.wind_up.sigma_rel) : 1.0;
  fit.progress = [&](double share) { report("all parameters at once", 0.1 + (shaken ? 0.3 : 0.85) * share); };
  if (shaken) {
    fit.hold = kScrewKeys;
    fit.rounds = 1;
    fit.spread = false;
  }
  id.fit = FitJointly(id.stepwise, records, fit);
  id.screw_identified = fit.stiffness;
  if (!shaken) return;
  fit.hold.clear();
  fit.spread = true;
  fit.rounds = 2;
  fit.refine = true;
  fit.progress = [&](double share) { report("all parameters at once", 0.4 + 0.55 * share); };
  JointFit all = FitJointly(id.fit.axis, records, fit);
  all.error_rms_before_m = id.fit.error_rms_before_m;
  id.fit = std::move(all);
  WidenByShaken(id.fit, id.shaken);
}

/// Measured and simulated friction of the same instants.
void LookAgain(Identification& id, const std::vector<Measured>& records) {
  const TableAxis& axis = id.fit.axis;
  id.stribeck = StribeckPoints(AllInstants(records, axis, kStride), axis);
  const FollowGain gain = FollowGainFor(axis, records.front());
  double offset_s = 0.0;
  for (const Measured& r : records) {
    const Simulated simulated = Simulate(axis, r, gain);
    const std::vector<Instant> instants = InstantsOf(r, axis, 1);
    for (const Instant& i : instants) {
      double mean = 0.0;
      for (std::size_t j = i.row - kHalfWidth; j <= i.row + kHalfWidth; ++j)
        mean += simulated.friction_N[j] / (2 * kHalfWidth + 1);
      if (i.row % 2 == 0)
        id.overlay.push_back({offset_s + i.time_s, i.position_m, i.velocity_m_s,
                              i.force_N + axis.offset - axis.mass_kg() * i.acceleration_m_s2, mean});
    }
    const std::vector<LoopPoint> loops = PreslidingLoops(instants, axis, kLargestLoop_m);
    for (LoopPoint p : loops) {
      const auto row = static_cast<std::size_t>(std::lround(p.time_s / r.period_s));
      id.loops_simulated.push_back({offset_s + p.time_s, simulated.table_m[row], simulated.friction_N[row]});
      p.time_s += offset_s;
      id.loops.push_back(p);
    }
    offset_s += static_cast<double>(r.size()) * r.period_s + 1.0;
  }
}

}  // namespace

Measured ToMeasured(const diagnosis::AxisLog& log, const TableAxis& axis, double position_step) {
  Measured m;
  const double r = axis.radius_m_rad;
  m.period_s = log.period_s;
  m.position_step_m = position_step * r;
  m.present = log.present;
  m.table_m = log.table_position_m;
  m.force_N.reserve(log.size());
  m.position_m.reserve(log.size());
  for (std::size_t k = 0; k < log.size(); ++k) {
    m.force_N.push_back(log.command[k] / r);
    m.position_m.push_back(log.position[k] * r);
  }
  for (const double u : log.offset) m.offset_N.push_back(u / r);
  for (const double u : log.reported) m.reported_N.push_back(u / r);
  return m;
}

Identification Identify(const diagnosis::StatedAxis& stated, const std::vector<diagnosis::AxisLog>& logs,
                        const IdentifyOptions& options) {
  const auto report = [&](const char* doing, double share) {
    if (options.progress) options.progress(doing, share);
  };
  if (logs.empty()) throw std::runtime_error("there is no record to identify from");
  Identification id;
  id.stated = FromStated(stated);
  id.stepwise = id.stated;
  std::vector<Measured> records;
  double low = 1e300;
  double high = -1e300;
  for (const diagnosis::AxisLog& log : logs) {
    records.push_back(ToMeasured(log, id.stated, stated.position_step));
    for (const double x : records.back().position_m) {
      if (!std::isfinite(x)) continue;
      low = std::min(low, x);
      high = std::max(high, x);
    }
    id.seconds += static_cast<double>(log.size()) * log.period_s;
  }
  for (Measured& r : records) r.report_step_N = ReportStep_N(r);
  for (Measured& r : records) QuietReports(id.stated.delay_s, r);
  id.missing_share = MissingShare(records);
  id.encoder = LookAtEncoder(records);
  id.period_s = records.front().period_s;
  for (Measured& r : records)
    if (r.position_step_m <= 0.0) r.position_step_m = std::max(id.encoder.step_m, 1e-10);
  id.stepwise.variation.low_m = low;
  id.stepwise.variation.high_m = high;

  report("friction over speed, screw, presliding", 0.0);
  TakeSteps(id, records, options.threads);
  if (options.steps_only) {
    id.fit.axis = id.stepwise;
    return id;
  }

  FitAll(id, records, options.threads, report);
  if (records.front().led_by_drive())
    id.notes.push_back(
        "the bristle's damping and its decay stay as stated: the drive's reports of its torque are too "
        "coarse "
        "to show them");
  report("report", 0.97);
  id.unexplained = FindUnexplainedForce(id.fit.axis, records, options.threads);
  LookAgain(id, records);
  if (!id.fit.axis.two_inertia && id.stated.two_inertia) StateRigid(id);
  report("done", 1.0);
  return id;
}

}  // namespace contour::identify
