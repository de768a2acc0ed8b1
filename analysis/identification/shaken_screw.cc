#include "analysis/identification/shaken_screw.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "analysis/identification/basins.h"
#include "analysis/identification/log_errors.h"
#include "analysis/identification/response_fit.h"

namespace contour::identify {
namespace {

constexpr double kWindow_s = 0.1;
constexpr double kFlank_s = 0.003;
/// What shakes, rms, in shares of the Coulomb level.
constexpr double kLeastShaking = 0.2;
constexpr double kLeast_s = 1.0;  ///< of shaken sliding, all segments together
/// The highest frequency that shook the axis over the lowest: less of a range shows no screw.
constexpr double kLeastRange = 2.0;
/// Starts: antiresonances a twentieth apart, shares of the table in the whole mass.
constexpr double kNextStart = 1.05;
constexpr double kShares[] = {0.05, 0.12, 0.25, 0.5};
/// So many of them are refined at most, these far apart; two that foresee alike are enough.
constexpr std::size_t kRefined = 4;
constexpr double kFarApart = 0.08;
constexpr double kFoundAgain = 0.01;
constexpr double kSamePlace = 1e-3;
constexpr int kLongestDescent = 5;
/// A screw is one when its resonance is below this, its stiffness known this well or its antiresonance seen,
/// and its two masses foresee the motion so much better than one does.
constexpr double kKnownStiffness = 0.2;
constexpr double kLeastGain_log = 5e-3;
/// Standard deviations that the halves of a record of such an axis are apart at the most, one in a hundred.
constexpr double kHalvesAgree = 2.6;

/// A part of the table that swings: tried from these shares of it, at frequencies so far apart; it is one
/// when it foresees so much better.
constexpr double kSideShares[] = {0.05, 0.12, 0.25};
constexpr double kNextSide = 1.08;
constexpr double kSideDamping = 0.02;
/// It swings on into a stretch from so long before it, in times in which a swing decays by e.
constexpr double kDecays = 3.0;
constexpr std::size_t kSidesRefined = 3;
constexpr double kLeastSideGain_log = 1e-2;
/// It stays when its share is known so well, in standard deviations, or when it foresees that much better.
constexpr double kSureOfSide = 3.0;
constexpr double kMostOfTable = 0.5;
constexpr double kSurelyBetter_log = 0.1;

double Hz(double stiffness, double mass) { return std::sqrt(stiffness / mass) / (2.0 * std::numbers::pi); }

/// The quick part of the force, mean square: second differences of `width` rows, whose gain is
/// 4 sin^2(pi f width T). Next rows show what is quick, rows further apart what is slower; a ramp shows in
/// neither. Where a drive leads, that of its offset: what its own loop makes of the encoder's noise is as
/// quick, and there in every stroke.
double Quick_N2(const Measured& d, std::size_t begin, std::size_t end, std::size_t width) {
  const std::vector<double>& sent_N = d.led_by_drive() ? d.offset_N : d.force_N;
  double sum = 0.0;
  for (std::size_t k = std::max(begin, 2 * width); k < end; ++k)
    sum += std::pow(sent_N[k] - 2.0 * sent_N[k - width] + sent_N[k - 2 * width], 2);
  return sum / static_cast<double>(end - begin);
}
constexpr std::size_t kFurther = 4;
/// The corner of a ramp is that much larger over four rows.
constexpr double kOfFurther = 1.0 / 9.0;

/// How long a part that swings as slowly as shows, damped as little as is tried, goes on when left alone.
std::size_t LongestRunUp(double period_s) {
  const double decay_s = 1.0 / (kSideDamping * 2.0 * std::numbers::pi * kLowestShown_share / period_s);
  return static_cast<std::size_t>(kDecays * decay_s / period_s);
}

/// With the rows before, in which a part of the table may have begun to swing.
Measured Slice(const Measured& d, std::size_t first, std::size_t end) {
  std::size_t begin = first;
  const std::size_t longest = LongestRunUp(d.period_s);
  while (begin > 0 && first - begin < longest && d.present[begin - 1] != 0) --begin;
  Measured s;
  s.run_up = first - begin;
  s.period_s = d.period_s;
  s.position_step_m = d.position_step_m;
  s.report_step_N = d.report_step_N;
  const auto from = static_cast<std::ptrdiff_t>(begin);
  const auto to = static_cast<std::ptrdiff_t>(end);
  s.force_N.assign(d.force_N.begin() + from, d.force_N.begin() + to);
  s.position_m.assign(d.position_m.begin() + from, d.position_m.begin() + to);
  s.present.assign(d.present.begin() + from, d.present.begin() + to);
  if (d.led_by_drive()) {
    s.offset_N.assign(d.offset_N.begin() + from, d.offset_N.begin() + to);
    s.reported_N.assign(d.reported_N.begin() + from, d.reported_N.begin() + to);
  }
  return s;
}

/// Of a whole segment: what shakes is the same in all of it.
std::vector<double> LogErrors(const std::vector<TableAxis>& axes, const std::vector<Measured>& segments,
                              int threads) {
  return LogErrors(axes, segments, std::numeric_limits<double>::infinity(), threads);
}
double LogError(const TableAxis& axis, const std::vector<Measured>& segments) {
  return LogErrors({axis}, segments, 1).front();
}

FitOptions Options(bool screw, bool spread, int threads) {
  FitOptions o;
  o.threads = threads;
  o.screw = screw;
  o.stiffness = screw;
  o.spread = spread;
  o.rounds = 3;
  o.block_s = 0.5;
  o.only = {"motor_inertia_kgm2",
            "table_mass_kg",
            "screw_damping_Ns_m",
            "screw_stiffness_N_um",
            "lag_s",
            "delay_s",
            "Fc_plus_N",
            "Fc_minus_N",
            "Fs_plus_N",
            "Fs_minus_N",
            "sigma0_N_m",
            "sigma1_Ns_m",
            "sigma1_decay_mm_s",
            "sigma2_Ns_m",
            "answer_gain",
            "answer_delay_s",
            "answer_next",
            "answer_step",
            "answer_after_1",
            "answer_after_2",
            "side_share",
            "side_frequency_Hz",
            "side_damping",
            "vs_mm_s",
            "place_1",
            "turn_plus_cos1",
            "turn_plus_sin1",
            "turn_minus_cos1",
            "turn_minus_sin1"};
  return o;
}

TableAxis Rigid(TableAxis axis) {
  axis.motor_inertia = axis.mass_kg();
  axis.load_inertia = 0.0;
  axis.two_inertia = axis.friction_on_load = false;
  return axis;
}

/// On from a fit until it foresees no better: the basin is long and bent.
std::pair<double, TableAxis> FollowBasin(TableAxis axis, const std::vector<Measured>& segments, int threads) {
  FitOptions on = Options(true, false, threads);
  double error = LogError(axis, segments);
  for (int i = 0; i < kLongestDescent; ++i) {
    const TableAxis next = FitJointly(axis, segments, on).axis;
    on.refine = true;
    on.rounds = 1;
    const double e = LogError(next, segments);
    const bool descends = i == 0 || error - e > kSamePlace;
    if (e < error || i == 0) {
      error = e;
      axis = next;
    }
    if (!descends) break;
  }
  return {error, axis};
}

/// Travel in a window; 0 where a row is missing or the axis turns back.
double Travel(const Measured& d, std::size_t at, std::size_t window) {
  const auto flank = static_cast<std::size_t>(kFlank_s / d.period_s);
  const double travel = d.position_m[at + window - 1] - d.position_m[at];
  for (std::size_t k = at; k < at + window; ++k) {
    if (d.present[k] == 0) return 0.0;
    if (k >= at + flank && (d.position_m[k] - d.position_m[k - flank]) * travel <= 0.0) return 0.0;
  }
  return travel;
}

struct Band {
  double low_Hz = 0.0, high_Hz = 0.0;
};

/// Where shaking showed something.
Band GoodBand(const std::vector<ResponsePoint>& response) {
  Band band;
  for (const ResponsePoint& p : response) {
    if (p.coherence <= kGoodCoherence) continue;
    if (band.low_Hz == 0.0) band.low_Hz = p.frequency_Hz;
    band.high_Hz = p.frequency_Hz;
  }
  return band;
}

/// The best of each antiresonance, the best first.
std::vector<TableAxis> Starts(const TableAxis& start, const std::vector<Measured>& segments, const Band& band,
                              int threads) {
  const double mass = start.mass_kg();
  std::vector<TableAxis> tried;
  for (double f = band.low_Hz; f < 1.5 * band.high_Hz; f *= kNextStart) {
    for (const double share : kShares) {
      TableAxis a = start;
      a.load_inertia = share * mass;
      a.motor_inertia = mass - a.load_inertia;
      a.stiffness = a.load_inertia * std::pow(2.0 * std::numbers::pi * f, 2);
      // Damping ratio of the resonance: 0.03.
      a.damping = 0.06 * std::sqrt(a.stiffness * a.load_inertia * a.motor_inertia / mass);
      tried.push_back(a);
    }
  }
  const std::vector<double> errors = LogErrors(tried, segments, threads);
  std::vector<std::pair<double, TableAxis>> starts;
  for (std::size_t i = 0; i < tried.size(); i += std::size(kShares)) {
    std::size_t best = i;
    for (std::size_t j = i; j < i + std::size(kShares); ++j)
      if (errors[j] < errors[best]) best = j;
    starts.emplace_back(errors[best], tried[best]);
  }
  std::sort(starts.begin(), starts.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<TableAxis> chosen;
  for (const auto& [e, axis] : starts) {
    const double f = Hz(axis.stiffness, axis.load_inertia);
    const bool near = std::any_of(chosen.begin(), chosen.end(), [&](const TableAxis& c) {
      return std::fabs(std::log(f / Hz(c.stiffness, c.load_inertia))) < kFarApart;
    });
    if (!near) chosen.push_back(axis);
    if (chosen.size() == kRefined) break;
  }
  return chosen;
}

/// What the axis was shaken by.
struct Shaken {
  const std::vector<Measured>& segments;
  const std::vector<ResponsePoint>& response;
  Band band;
};

/// The two masses with a part of the table on a spring of its own, where that foresees better.
void TakeSide(std::pair<double, TableAxis>& best, const Shaken& shaken, int threads) {
  const auto& [segments, response, band] = shaken;
  std::vector<TableAxis> tried;
  for (double f = band.low_Hz; f < band.high_Hz; f *= kNextSide) {
    for (const double share : kSideShares) {
      // Two masses alone have taken what swings off the table, and put it to the motor: the antiresonance
      // that they found, and the whole mass, are right.
      TableAxis a = best.second;
      a.load_inertia /= 1.0 - share;
      a.motor_inertia = best.second.mass_kg() - a.load_inertia;
      a.side = {share, f, kSideDamping};
      if (a.motor_inertia > 0.0) tried.push_back(a);
    }
  }
  const std::vector<double> errors = LogErrors(tried, segments, threads);
  // The best share of each frequency, in their order.
  std::vector<TableAxis> places;
  std::vector<double> of_places;
  for (std::size_t i = 0; i < tried.size(); ++i) {
    const bool same = !places.empty() && places.back().side.frequency_Hz == tried[i].side.frequency_Hz;
    if (same && errors[i] >= of_places.back()) continue;
    if (!same) places.emplace_back(), of_places.emplace_back();
    places.back() = tried[i];
    of_places.back() = errors[i];
  }
  std::vector<TableAxis> chosen;
  for (const std::size_t i : Basins(of_places))
    if (chosen.size() < kSidesRefined) chosen.push_back(places[i]);
  // The errors of the time series lead nowhere from some of them; the response shows where to begin.
  if (const auto seen = FitResponse(best.second, response, segments.front().period_s))
    chosen.push_back(*seen);
  const double alone = best.first;
  for (const TableAxis& start : chosen) {
    const auto found = FollowBasin(start, segments, threads);
    // What lies beyond the shaking is no finding.
    const double side_Hz = found.second.side.frequency_Hz;
    const bool seen = side_Hz > band.low_Hz && side_Hz < band.high_Hz;
    // Nor is what would be more than all the rest of the table: that is no part of it, but what else the
    // model lacks, as between the reports of a drive.
    const bool part = found.second.side.share < kMostOfTable;
    if (seen && part && alone - found.first > kLeastSideGain_log && found.first < best.first) best = found;
  }
}

/// Where slow and quick forces tell of two axes, the one that was fitted is neither: a part that swings, say.
/// The whole fit then is as unsure as they are apart, as physicists have it of measurements that disagree: so
/// many times, but never by more than the distance itself.
void WidenByHalves(std::vector<FittedParameter>& parameters) {
  for (FittedParameter& p : parameters)
    if (p.halves_apart > kHalvesAgree)
      p.sigma = std::min(p.sigma * p.halves_apart, std::hypot(p.sigma, p.halves_distance));
}

/// The last fit, from the best of two masses alone or with a part that swings. A share that could as well be
/// none is none: what the model lacks otherwise may look like one.
JointFit WithSideWhereSure(std::pair<double, TableAxis>& best, const Shaken& shaken, int threads) {
  const std::vector<Measured>& segments = shaken.segments;
  FitOptions last = Options(true, true, threads);
  last.refine = true;
  last.rounds = 1;
  const std::pair<double, TableAxis> alone = best;
  TakeSide(best, shaken, threads);
  JointFit fit = FitJointly(best.second, segments, last);
  if (!(fit.axis.side.share > 0.0)) return fit;
  std::vector<FittedParameter> widened = fit.parameters;
  WidenByHalves(widened);
  if (fit.axis.side.share > kSureOfSide * Sigma(widened, "side_share") ||
      alone.first - best.first > kSurelyBetter_log)
    return fit;
  best = alone;
  return FitJointly(best.second, segments, last);
}

}  // namespace

std::vector<Measured> ShakenStretches(const std::vector<Measured>& records, const TableAxis& axis) {
  const double least_N = kLeastShaking * 0.5 * (axis.friction.Fc_plus + axis.friction.Fc_minus);
  std::vector<Measured> segments;
  for (const Measured& d : records) {
    const auto window = static_cast<std::size_t>(kWindow_s / d.period_s);
    std::size_t begin = 0;
    std::size_t end = 0;
    double before = 0.0;  // travel of the window before: the bristle is saturated by then
    const auto close = [&] {
      if (end > begin + window) segments.push_back(Slice(d, begin, end));
      begin = end = 0;
    };
    for (std::size_t at = 2; at + window < d.size(); at += window) {
      const double quick =
          std::max(Quick_N2(d, at, at + window, 1), kOfFurther * Quick_N2(d, at, at + window, kFurther));
      const double travel = Travel(d, at, window);
      const bool slides = travel * before > 0.0;
      before = travel;
      if (!slides || std::sqrt(quick) < least_N) {
        close();
        continue;
      }
      if (end == 0) begin = at;
      end = at + window;
    }
    close();
  }
  return segments;
}

ShakenScrew FitShakenScrew(const TableAxis& start, const std::vector<Measured>& records, int threads) {
  ShakenScrew s;
  const std::vector<Measured> segments = ShakenStretches(records, start);
  for (const Measured& d : segments) s.seconds += static_cast<double>(d.compared()) * d.period_s;
  if (!segments.empty()) s.response = MotorResponse(segments);
  const Band band = GoodBand(s.response);
  s.highest_Hz = band.high_Hz;
  if (s.seconds < kLeast_s || s.highest_Hz < kLeastRange * band.low_Hz || s.highest_Hz <= 0.0) {
    s.why_not = "nothing shakes the axis quickly while it slides: the screw needs a chirp";
    return s;
  }
  const TableAxis rigid = FitJointly(Rigid(start), segments, Options(false, false, threads)).axis;
  const double rigid_error = LogError(rigid, segments);
  std::pair<double, TableAxis> best{std::numeric_limits<double>::max(), start};
  for (const TableAxis& from : Starts(start, segments, band, threads)) {
    const auto found = FollowBasin(from, segments, threads);
    const bool same = std::fabs(found.first - best.first) < kFoundAgain;
    if (found.first < best.first) best = found;
    if (same) break;
  }
  JointFit fit = WithSideWhereSure(best, {segments, s.response, band}, threads);
  s.axis = fit.axis;
  s.antiresonance_Hz = Hz(s.axis.stiffness, s.axis.load_inertia);
  s.resonance_Hz = s.antiresonance_Hz * std::sqrt(s.axis.mass_kg() / s.axis.motor_inertia);
  s.parameters = std::move(fit.parameters);
  // One that shows is one, however unsure its stiffness is: what is done with that is for others to say.
  const bool known = Sigma(s.parameters, "screw_stiffness_N_um") < kKnownStiffness ||
                     VisibleAntiresonance(s.response).has_value();
  const bool screw = rigid_error - best.first > kLeastGain_log && s.resonance_Hz < kRigidFrom_Hz && known;
  s.verdict = screw ? ShakenScrew::Verdict::kFound : ShakenScrew::Verdict::kRigid;
  if (!screw) s.axis = rigid;
  WidenByHalves(s.parameters);
  return s;
}

}  // namespace contour::identify
