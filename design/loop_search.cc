#include "design/loop_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "analysis/parallel/parallel_for.h"
#include "design/evolution_search.h"

namespace contour {
namespace {

// What breaks a limit costs this much per share beyond it: first about what the error gains there, so that
// the search can cross, then more, so that it stays within.
constexpr double kGentleSlope = 3.0;
constexpr double kLimitSlope = 8.0;
// However far beyond: what is unstable costs more than what only has no margin.
constexpr double kWorstExcess = 5.0;
// A force that stays costs more than any limit: what only holds against it is a valley of its own, which
// small steps do not leave.
constexpr double kLeftSlope = 30.0;
// Where no loop bears friction's slope it is no limit, but of two loops that err by nearly the same the one
// that bears it better sticks and slips by less.
constexpr double kCreepingSlope = 0.1;
constexpr double kHopeless = 1e6;
constexpr double kFirstStep = 0.1;
constexpr double kSmallStep = 0.05;
constexpr int kLargePopulation = 20;

/// One number of the tuning and where it is searched, as a logarithm. Frequencies are in those of sampling:
/// what bounds a loop is its delay. What encoder and scale are apart by follows within about a period: of
/// what it leaves, friction at the motor or another stiffness, the observer makes a force on the table, which
/// is learnt as its friction.
struct Parameter {
  double LoopTuning::*value;
  double low, high;
  bool frequency;
};
constexpr std::array<Parameter, 11> kParameters{{
    {&LoopTuning::regulator_Hz, 1.5e-3, 0.12, true},
    {&LoopTuning::windup_weight, 0.02, 20.0, false},
    {&LoopTuning::velocity_weight, 0.02, 3.0, false},
    {&LoopTuning::disturbance_Hz, 0.01, 0.5, true},
    {&LoopTuning::motor_force_Hz, 0.02, 5.0, true},
    {&LoopTuning::table_force_Hz, 2e-3, 2.0, true},
    {&LoopTuning::notch_ratio, 0.5, 1.6, false},
    {&LoopTuning::notch_pole_damping, 0.1, 2.0, false},
    {&LoopTuning::notch_zero_damping, 0.02, 2.0, false},
    {&LoopTuning::scale_noise_ratio, 0.05, 50.0, false},
    {&LoopTuning::bias_Hz, 0.2, 4.0, true},
}};
constexpr std::size_t kWithoutScale = 9;

/// Found on other axes at 1 kHz (docs/laboratory/loop_designs.md).
constexpr std::array<LoopTuning, 9> kOthers{{
    {23.8, 0.26, 0.26, 262.0, 905.0, 17.0, 0.79, 0.16, 0.08, 1.0, 5.0},
    {18.8, 0.21, 0.06, 290.0, 1159.0, 1371.0, 0.76, 0.10, 0.04, 1.0, 5.0},
    {13.9, 0.19, 0.46, 257.0, 804.0, 1600.0, 0.77, 0.10, 0.05, 1.0, 5.0},
    {17.5, 0.04, 0.05, 268.0, 523.0, 60.0, 0.69, 1.29, 0.49, 1.0, 5.0},
    {22.2, 0.86, 0.19, 234.0, 514.0, 414.0, 1.21, 1.49, 0.84, 1.0, 5.0},
    {12.4, 0.98, 0.09, 275.0, 761.0, 142.0, 0.64, 0.67, 0.24, 1.0, 5.0},
    {32.9, 0.04, 0.31, 208.0, 220.0, 407.0, 1.04, 0.22, 0.45, 0.05, 50.0},
    {37.7, 0.37, 0.06, 234.0, 991.0, 1101.0, 1.46, 0.24, 0.29, 0.14, 38.4},
    {34.0, 0.18, 0.13, 120.0, 270.0, 9.0, 0.96, 0.43, 0.88, 0.87, 50.0},
}};

/// Between the unit box and tunings.
class Box {
 public:
  Box(double period_s, bool scale) : period_s_(period_s), size_(scale ? kParameters.size() : kWithoutScale) {}
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] LoopTuning At(const std::vector<double>& point) const {
    LoopTuning t;
    for (std::size_t i = 0; i < size_; ++i) {
      const Parameter& p = kParameters[i];
      t.*p.value = p.low * std::pow(p.high / p.low, point[i]) * (p.frequency ? 1.0 / period_s_ : 1.0);
    }
    return t;
  }
  [[nodiscard]] std::vector<double> PointOf(const LoopTuning& t) const {
    std::vector<double> point(size_);
    for (std::size_t i = 0; i < size_; ++i) {
      const Parameter& p = kParameters[i];
      const double value = t.*p.value * (p.frequency ? period_s_ : 1.0);
      point[i] = std::clamp(std::log(value / p.low) / std::log(p.high / p.low), 0.0, 1.0);
    }
    return point;
  }

 private:
  double period_s_;
  std::size_t size_;
};

/// Where the search may begin: what the axis has, what others have, and by chance.
std::vector<std::vector<double>> Starts(const Box& box, const LoopSearchOptions& options, double period_s) {
  std::vector<std::vector<double>> starts;
  if (options.start) starts.push_back(box.PointOf(*options.start));
  for (const LoopTuning& t : LoopsOfOtherAxes(period_s)) starts.push_back(box.PointOf(t));
  PortableRandom random(1);
  for (int i = 0; i < options.random_starts; ++i) {
    std::vector<double> point(box.size());
    for (double& x : point) x = random.Uniform();
    starts.push_back(std::move(point));
  }
  return starts;
}

double Excess(const WorstMember& w) {
  if (!w.stable) return kWorstExcess + 100.0 * (w.growth_per_cycle - 1.0);
  return std::clamp(w.peak / w.limit - 1.0, 0.0, kWorstExcess);
}

/// Beyond what may be left of the error under a force.
double Left(const ForceStep& step, double most) {
  const double left = step.left_m / step.peak_m;
  return left > most ? std::min(left - most, kWorstExcess) : 0.0;
}

}  // namespace

double LoopCost(const LoopVerdict& v, double limit_slope) {
  double excess = std::clamp(v.torque_noise / v.noise_limit - 1.0, 0.0, kWorstExcess), creeping = 0.0;
  for (std::size_t i = 0; i < kMemberKinds; ++i) {
    const bool creeps = static_cast<MemberKind>(i) == MemberKind::kCreeping;
    (creeps ? creeping : excess) += Excess(v.worst[i]);
  }
  const double error_um = 1e6 * StepError_m(v);
  // An unstable loop's error says nothing.
  const double cost = std::isfinite(error_um) ? std::min(std::log(error_um), 20.0) : 20.0;
  return std::min(cost + limit_slope * excess + kCreepingSlope * creeping, kHopeless);
}

std::vector<LoopTuning> LoopsOfOtherAxes(double period_s) {
  std::vector<LoopTuning> loops(kOthers.begin(), kOthers.end());
  for (LoopTuning& t : loops)
    for (const Parameter& p : kParameters)
      if (p.frequency) t.*p.value *= 1e-3 / period_s;
  return loops;
}

FoundLoop SearchLoop(const LoopAxis& axis, double period_s, const LoopSearchOptions& options) {
  const bool scale = axis.scale_step_m.has_value();
  LoopMotionOf(axis.axis, period_s);  // throws when the axis cannot be
  const LoopJudge judge(axis, period_s, options.members.empty() ? UncertaintySet(axis) : options.members);
  const Box box(period_s, scale);
  const auto cost = [&](const std::vector<double>& point, double slope) {
    try {
      const LoopVerdict verdict = judge.Judge(DesignLoop(axis.axis, box.At(point), period_s, scale));
      return std::min(LoopCost(verdict, slope) + kLeftSlope * Left(verdict.step, options.most_left),
                      kHopeless);
    } catch (const std::invalid_argument&) {
      return kHopeless;
    }
  };

  const std::vector<std::vector<double>> starts = Starts(box, options, period_s);
  std::vector<double> costs(starts.size());
  ParallelFor(starts.size(), options.threads,
              [&](std::size_t i) { costs[i] = cost(starts[i], kGentleSlope); });
  std::vector<std::size_t> order(starts.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });

  const auto runs = std::min(static_cast<std::size_t>(options.runs), starts.size());
  std::vector<SearchResult> results(runs);
  const auto by_cost = [](const SearchResult& a, const SearchResult& b) { return a.cost < b.cost; };
  ParallelFor(runs, options.threads, [&](std::size_t i) {
    results[i] = EvolutionSearch(
        [&](const std::vector<double>& point) { return cost(point, kGentleSlope); }, starts[order[i]],
        {kFirstStep, options.evaluations_per_run, 0, static_cast<std::uint64_t>(i + 1)});
  });
  int evaluations = static_cast<int>(starts.size());
  for (const SearchResult& r : results) evaluations += r.evaluations;
  std::sort(results.begin(), results.end(), by_cost);
  const auto judged = [&](const SearchResult& r) {
    return judge.Judge(DesignLoop(axis.axis, box.At(r.best), period_s, scale));
  };
  results.resize(std::min(runs, static_cast<std::size_t>(std::max(1, options.refinements))));
  if (options.hopeless_excess < kNeverHopeless && results.front().cost < kHopeless) {
    // Any of them may be the one that comes back within the limits.
    if (std::none_of(results.begin(), results.end(), [&](const SearchResult& r) {
          return r.cost < kHopeless && Acceptable(judged(r), options.hopeless_excess);
        }))
      return {box.At(results.front().best), judged(results.front()), results.front().cost, evaluations, {}};
  }
  ParallelFor(results.size(), options.threads, [&](std::size_t i) {
    results[i] = EvolutionSearch([&](const std::vector<double>& point) { return cost(point, kLimitSlope); },
                                 results[i].best,
                                 {kSmallStep, options.evaluations_per_refinement, kLargePopulation,
                                  static_cast<std::uint64_t>(i + 1)});
  });
  for (const SearchResult& r : results) evaluations += r.evaluations;
  const auto best = std::min_element(results.begin(), results.end(), by_cost);
  FoundLoop found;
  found.tuning = box.At(best->best);
  found.cost = best->cost;
  found.verdict = judged(*best);
  found.evaluations = evaluations;
  return found;
}

}  // namespace contour
