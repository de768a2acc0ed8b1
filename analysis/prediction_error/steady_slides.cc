#include "analysis/prediction_error/steady_slides.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/prediction_error/simd/lane_run.h"

namespace contour::diagnosis {
namespace {

// Of the loosest rows; how strict they have to be is asked of the log.
/// [lengths of the bristle] Since the axis turned round: what is left of its spring is e^-3.
constexpr double kTravel = 3.0;
/// [lengths of the bristle] Per row: slower than that the bristle is no quicker than the rows are.
constexpr double kPerRow = 0.125;
/// [share of the speed] By which it may change next to a row.
constexpr double kChanges = 1.0;
/// [rows] On either side, over which the speed is taken, against rounding.
constexpr std::ptrdiff_t kSmoothed = 2;
/// [factor] Stricter than that hardly any row is one.
constexpr double kStrictest = 16.0;
/// [share] Of what the sub-steps are off by, that holding friction may add.
constexpr double kMayAdd = 0.1;

/// Per row; 0: not known.
std::vector<double> SpeedsOf(const SlidesOf& of) {
  const std::vector<double>& q = of.log.position;
  std::vector<double> speed(q.size(), 0.0);
  std::vector<std::uint8_t> begins_here(q.size(), 0);
  for (const std::size_t b : of.begins) begins_here[b] = 1;
  const auto reach = static_cast<std::size_t>(kSmoothed);
  for (std::size_t k = reach; k + 1 + reach < q.size(); ++k) {
    bool known = true;
    for (std::size_t i = k - reach; i <= k + 1 + reach; ++i)
      known = known && of.valid[i] != 0 && (i == k - reach || begins_here[i] == 0);
    if (known) speed[k] = (q[k + 1 + reach] - q[k - reach]) / (2.0 * kSmoothed + 1.0);
  }
  return speed;
}

/// Parts from all over the log, for runs that say how exact others are.
std::vector<Segment> SomeParts(const AxisLog& log) {
  const std::size_t n = log.size(), rows = std::min(n / kNoise.segments, kNoise.segment_rows);
  std::vector<Segment> out;
  for (std::size_t i = 0; i < kNoise.segments && rows > 1; ++i) {
    const std::size_t from = (n - rows) * i / (kNoise.segments - 1);
    const double w = (log.position[from + 1] - log.position[from]) / log.period_s;
    out.push_back({from, rows, i * rows, log.position[from], w});
  }
  return out;
}

/// Between two runs of these parts, once they have forgotten where they began.
double Distance(const std::vector<double>& a, const std::vector<double>& b, std::span<const Segment> parts) {
  double sum = 0.0;
  for (const Segment& part : parts)
    for (std::size_t k = part.at + kNoise.settling_rows; k < part.at + part.rows; ++k)
      sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum);
}

}  // namespace

std::vector<std::uint8_t> SteadySlides(const SlidesOf& of, double strict) {
  const std::size_t n = of.log.size();
  std::vector<std::uint8_t> slides(n, 0);
  const AxisModel& nominal = of.nominal;
  const StatedFriction& f = nominal.friction;
  const double level = std::max({f.Fs_plus, f.Fs_minus, f.Fc_plus, f.Fc_minus});
  if (!(f.s0 > 0.0) || !(level > 0.0)) return slides;
  const double bristle = level / f.s0 * of.softest;
  double least = kPerRow * strict * bristle;  // per row
  double reach = kTravel * strict * bristle;  // since the axis turned round
  std::ptrdiff_t near = kSmoothed;
  if (nominal.two_inertia) {
    // What sticks behind the coupling winds it up by its level, and swings by as much when it is let go.
    const double mode =
        std::sqrt(nominal.stiffness * (1.0 / nominal.motor_inertia + 1.0 / nominal.load_inertia));
    const double windup = level / nominal.stiffness;
    least = std::max(least, windup * std::min(1.0, mode * of.log.period_s));
    reach += 2.0 * windup + nominal.gap;
    near += static_cast<std::ptrdiff_t>(std::ceil(std::min(1.0 / (mode * of.log.period_s), 1e3)));
  }
  const std::vector<double> speed = SpeedsOf(of);
  double travel = 0.0;
  std::vector<std::uint8_t> far(n, 0);
  for (std::size_t k = 1; k < n; ++k) {
    travel = speed[k] * speed[k - 1] > 0.0 ? travel + std::fabs(speed[k]) : 0.0;
    far[k] = travel >= reach ? 1 : 0;
  }
  const auto around = static_cast<std::size_t>(near);
  for (std::size_t k = around; k + around < n; ++k) {
    const double v = speed[k];
    if (far[k] == 0 || std::fabs(v) < least) continue;
    slides[k] = std::all_of(speed.begin() + static_cast<std::ptrdiff_t>(k) - near,
                            speed.begin() + static_cast<std::ptrdiff_t>(k) + near + 1,
                            [&](double there) {
                              return there * v > 0.0 && std::fabs(there) >= least &&
                                     std::fabs(there - v) <= kChanges / strict * std::fabs(v);
                            })
                    ? 1
                    : 0;
  }
  return slides;
}

std::vector<std::uint8_t> HeldSlides(const FilterSetup& setup, const SlidesOf& of) {
  const std::vector<Segment> some = SomeParts(of.log);
  FilterSetup setup_of_parts = setup;
  // A log with gaps is run whole, piece by piece.
  if (setup.pieces.empty()) setup_of_parts.segments = some;
  const std::span<const Segment> parts = PartsOf(setup_of_parts);
  const auto run = [&](const FilterSetup& s) {
    return std::move(RunFilter(s, std::span(&of.nominal, 1), 1)[0].innovation);
  };
  setup_of_parts.slides.clear();
  const std::vector<double> as_it_is = run(setup_of_parts);
  // Twice as many sub-steps are off by a quarter; of the most that there are, half as many by four times.
  const int substeps = SubstepsOf(setup, of.nominal);
  const bool most = substeps == kMostSubsteps;
  FilterSetup other = setup_of_parts;
  for (int* s : {&other.substeps_rigid, &other.substeps_two}) *s = most ? *s / 2 : *s * 2;
  const double off = Distance(run(other), as_it_is, parts) * (most ? 1.0 / 3.0 : 4.0 / 3.0);
  for (double strict = 1.0; strict <= kStrictest; strict *= 2.0) {
    setup_of_parts.slides = SteadySlides(of, strict);
    if (Distance(run(setup_of_parts), as_it_is, parts) <= kMayAdd * off)
      return std::move(setup_of_parts.slides);
  }
  return {};
}

}  // namespace contour::diagnosis
