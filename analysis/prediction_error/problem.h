#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "analysis/axis_model/axis_model.h"
#include "analysis/axis_model/stated_axis.h"
#include "analysis/prediction_error/base_terms.h"
#include "analysis/prediction_error/excerpt.h"
#include "analysis/prediction_error/forward_filter.h"
#include "analysis/prediction_error/linear_model.h"
#include "analysis/prediction_error/noise_filter.h"
#include "analysis/prediction_error/signal_cache.h"
#include "analysis/prediction_error/signals.h"
#include "analysis/prediction_error/slow_wander.h"
#include "analysis/prediction_error/whitener.h"
#include "analysis/recording/axis_log.h"
#include "analysis/recording/data_quality.h"

namespace contour::diagnosis {

/// A cause in the model: amplitudes, zero when absent, and how they enter.
struct Effect {
  std::string kind;
  std::string label;              ///< grid point, for people
  double grid = 1.0;              ///< places that were looked at to find this one
  std::vector<double> steps;      ///< of each amplitude, for differences of runs
  std::vector<double> start;      ///< where a refit begins; empty: at the linear estimate
  std::vector<double> low, high;  ///< bounds; empty: none
  std::size_t tested = 0;         ///< so many amplitudes are tested at zero, the rest is shape; 0: all
  bool signals = false;           ///< the tested amplitudes enter as signals and nothing else, in proportion
  /// The same with the first amplitudes only, tested in addition to it at no cost.
  std::shared_ptr<const Effect> shorter;
  /// Acts as this base term does from a row on, which saves the runs of the test; empty: runs.
  std::string as_term;
  std::size_t from_row = 0;
  double order = 0.0;          ///< of a wave: per turn, or Hz; of other shapes: an exponent, a knee, a time
  bool wave = false;           ///< several orders of one kind may be there
  double middle = 0.0;         ///< of a wave with free order: rad about which the order turns
  bool common_factor = false;  ///< its one amplitude a: 1 + a times the torque
  std::vector<int> force;      ///< power of a torque (a force) in each amplitude's unit; empty: none in any
  std::function<void(const std::vector<double>&, AxisModel&)> apply;
};
using SharedEffect = std::shared_ptr<const Effect>;

struct Point {
  std::vector<double> base;  ///< x of every base term
  std::vector<SharedEffect> effects;
  std::vector<std::vector<double>> amplitudes;
  bool operator==(const Point&) const = default;
};

/// All that is learnt of the noise at a point.
struct LearntNoise {
  NoiseFilter filter;
  Whitener scale;
  SlowWander wander;
  std::vector<double> root_weight, excerpt_weight;
};

/// The log, the stated model and the noise: from parameters to a white residual.
class Problem {
 public:
  Problem(const AxisLog& axis_log, const StatedAxis& stated_axis, int most_threads);

  [[nodiscard]] AxisModel Build(const Point& point) const;
  /// Innovations, then scale residuals (0 where they do not count), of every point.
  [[nodiscard]] std::vector<std::vector<double>> Raw(std::span<const Point> points,
                                                     Extent extent = Extent::kWhole) const;
  [[nodiscard]] std::vector<std::vector<double>> Raw(std::span<const AxisModel> models, Extent extent) const;
  /// An excerpt's rows count for those that are left out.
  [[nodiscard]] std::vector<std::vector<double>> White(std::span<const std::vector<double>> raw,
                                                       Extent extent = Extent::kWhole) const;
  /// The same into what is there already.
  void WhitenInto(std::span<const std::span<const double>> raw, std::span<const std::span<double>> white,
                  Extent extent = Extent::kWhole) const;
  [[nodiscard]] std::vector<std::vector<double>> Residuals(std::span<const Point> points,
                                                           Extent extent = Extent::kWhole) const;
  /// By how much |r|^2 would be larger without what the stated model has beyond its numbers.
  [[nodiscard]] double ExplainedByExtras(const Point& point) const;
  [[nodiscard]] FilterRun Trace(const Point& point) const;
  /// White differences of the residual per unit of each effect's amplitude at zero in addition to the point
  /// where the noise was learnt, effects that are signals and nothing else.
  [[nodiscard]] std::vector<std::vector<double>> LinearResponses(const Point& point,
                                                                 std::span<const SharedEffect> effects) const;
  /// Ratio of the noises of torque and reading, the colour that is left, then the level from place to place.
  void LearnNoise(const Point& point);
  /// Whether the noise has a slow torque in it where the numbers are plausible: of a model that is far off,
  /// what it lacks passes for one.
  bool slow_torque = false;
  /// What was learnt last, to have it again without learning.
  [[nodiscard]] LearntNoise Learnt() const {
    return {noise, scale_noise, scale_wander, root_weight, excerpt_weight_};
  }
  void Take(LearntNoise learnt);
  /// What the noise learnt adds to |r|^2 in -2 log likelihood, up to a constant: points whose noise was
  /// learnt at each of them compare by the sum of both.
  [[nodiscard]] double LogNoise() const;
  /// Corrects the model as quickly as the noise lets it, which it learns again. A slow observer leaves the
  /// model's motor off the axis's by what the noise moves it; with a play of that size the model is in
  /// contact at other times than the axis, and a narrower play fits it best.
  void FollowReading(const Point& point);
  /// Traces the point and renews what regressors are made of.
  void LearnSignals(const Point& point);
  void LearnOutliers(const Point& point);

  [[nodiscard]] std::size_t rows() const { return log.size(); }
  [[nodiscard]] bool has_scale() const { return !log.table_position_m.empty(); }
  [[nodiscard]] std::size_t data_size(Extent extent = Extent::kWhole) const {
    return (extent == Extent::kWhole ? rows() : excerpt.row.size()) * (has_scale() ? 2 : 1);
  }

  const AxisLog& log;
  const StatedAxis& stated;
  int threads = 1;
  AxisModel nominal;
  std::vector<BaseTerm> terms;
  std::shared_ptr<Signals> signals;
  std::shared_ptr<SignalCache> signal_cache = std::make_shared<SignalCache>();
  FilterSetup setup;
  std::vector<std::uint8_t> counted;  ///< rows whose residual counts
  /// Per datum: 1 where the noise is as its spectrum says, less where it is locally larger (slip out of
  /// stiction makes noise of torque into larger noise of position; a noise level may change).
  std::vector<double> root_weight;
  DataQuality quality;
  Excerpt excerpt;
  NoiseFilter noise;
  Whitener scale_noise;
  SlowWander scale_wander;  ///< what the whitener leaves

 private:
  bool ScaleCounts(std::size_t k) const { return counted[k] != 0 && std::isfinite(log.table_position_m[k]); }
  /// Appends what the scale reads beyond the encoder less the wind-up that the model has, and beyond the
  /// error, less its mean. `raw` holds the innovations: an error of the forces moves the model's own
  /// position, which is no matter of the scale.
  void AddScale(const std::vector<double>& table, bool two, const double* error, const double* measured,
                std::vector<double>& raw, Extent extent = Extent::kWhole) const;
  /// The weights of the excerpt from those of the log.
  void WeighExcerpt();
  void Observe(double bandwidth_Hz);
  /// Where the runs begin, at first and after every gap.
  void Begin();
  void ChooseSubsteps();
  void CountRows();
  /// The scale's noise: its colour, and how it wanders; weights go down where the scale rests.
  void LearnScaleNoise(std::vector<double>& raw);
  void LowerWhereScaleRests(double* w) const;
  /// Lowers the weights w where the mean square of r over 2 half + 1 rows exceeds the limit.
  void Lower(const double* r, std::size_t half, double largest_by_chance, double* w) const;

  std::vector<double> excerpt_weight_;
};

}  // namespace contour::diagnosis
