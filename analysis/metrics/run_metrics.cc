#include "analysis/metrics/run_metrics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/metrics/least_squares_circle.h"

namespace contour {
namespace {

constexpr double kHalfQuadrantWindow_rad = 15.0 * std::numbers::pi / 180.0;
constexpr double kHoldScored_s = 20.0;
constexpr double kMicro = 1e6;

std::optional<double> RootMean(double sum_squared, std::uint64_t count) {
  if (count == 0) return std::nullopt;
  return std::sqrt(sum_squared / static_cast<double>(count));
}

std::optional<double> Scaled(const std::optional<double>& value, double factor) {
  return value ? std::optional(*value * factor) : std::nullopt;
}

}  // namespace

RunScorer::RunScorer(std::shared_ptr<const MotionPlan> plan, std::vector<ScoredAxisFacts> axes)
    : plan_(std::move(plan)), circle_(plan_->circle()), facts_(std::move(axes)), axes_(facts_.size()) {}

void RunScorer::Add(const ScoredRow& row) {
  if (row.path_time_s < 0.0 || row.path_time_s <= last_path_time_s_) return;
  last_path_time_s_ = row.path_time_s;
  ++rows_;
  const bool scored = plan_->Scored(row.path_time_s);
  const bool held = plan_->is_hold() && row.path_time_s > plan_->duration_s() - kHoldScored_s;
  for (std::size_t i = 0; i < axes_.size(); ++i) AddAxis(row.axes[i], scored, held, axes_[i]);
  if (!scored) return;
  ++scored_;
  PerAxis<double> encoder(row.axes.size());
  PerAxis<double> table(row.axes.size());
  bool table_known = true;
  for (std::size_t i = 0; i < row.axes.size(); ++i) {
    encoder[i] = row.axes[i].encoder_m;
    table[i] = row.axes[i].table_m;
    table_known = table_known && std::isfinite(table[i]);
  }
  AddContour(encoder, encoder_);
  if (table_known) AddContour(table, table_);
}

void RunScorer::AddAxis(const ScoredAxis& from, bool scored, bool held, Axis& to) {
  to.saturated += from.torque_saturated ? 1 : 0;
  if (held) {
    to.lowest_m = to.held == 0 ? from.encoder_m : std::min(to.lowest_m, from.encoder_m);
    to.highest_m = to.held == 0 ? from.encoder_m : std::max(to.highest_m, from.encoder_m);
    ++to.held;
  }
  if (!scored) return;
  const double following = from.encoder_m - from.reference_m;
  to.following_squared_m2 += following * following;
  to.following_peak_m = std::max(to.following_peak_m, std::abs(following));
  const double error = from.friction_estimate_N - from.friction_truth_N;
  if (std::isfinite(error)) {
    to.friction_squared_N2 += error * error;
    ++to.friction_count;
  }
}

void RunScorer::AddContour(const PerAxis<double>& position_m, Place& place) const {
  const double error = plan_->Distance_m(position_m);
  place.sum_squared_m2 += error * error;
  place.peak_m = std::max(place.peak_m, error);
  ++place.count;
  if (!circle_) return;
  const double x = position_m[circle_->axis[0]] - circle_->centre_m[0];
  const double y = position_m[circle_->axis[1]] - circle_->centre_m[1];
  place.points_m.push_back({x, y});
  const double radial = std::abs(std::hypot(x, y) - circle_->radius_m);
  const double angle = std::atan2(y, x);
  for (std::size_t q = 0; q < 4; ++q) {
    const double from_reversal =
        std::remainder(angle - 0.5 * std::numbers::pi * static_cast<double>(q), 2.0 * std::numbers::pi);
    if (std::abs(from_reversal) > kHalfQuadrantWindow_rad) continue;
    place.quadrant_peak_m[q] = std::max(place.quadrant_peak_m[q], radial);
  }
}

ContourMetrics RunScorer::FinishContour(const Place& place) const {
  ContourMetrics m;
  m.rms_um = Scaled(RootMean(place.sum_squared_m2, place.count), kMicro);
  if (place.count > 0) m.peak_um = place.peak_m * kMicro;
  if (place.points_m.size() >= 3) {
    const Circle circle = LeastSquaresCircle(place.points_m);
    m.circular_deviation_um = RadialRange(place.points_m, circle.centre) * kMicro;
    m.quadrant_peak_um = place.quadrant_peak_m;
    for (double& peak : *m.quadrant_peak_um) peak *= kMicro;
  }
  return m;
}

RunMetrics RunScorer::Finish() const {
  RunMetrics m;
  m.encoder = FinishContour(encoder_);
  m.table = FinishContour(table_);
  m.scored_cycles = scored_;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const Axis& a = axes_[i];
    AxisMetrics axis;
    axis.axis = facts_[i].name;
    axis.friction_estimate_error_rms_N = RootMean(a.friction_squared_N2, a.friction_count);
    if (rows_ > 0)
      axis.torque_saturated_fraction = static_cast<double>(a.saturated) / static_cast<double>(rows_);
    axis.following_error_rms_um = Scaled(RootMean(a.following_squared_m2, scored_), kMicro);
    if (scored_ > 0) axis.following_error_peak_um = a.following_peak_m * kMicro;
    if (a.held > 0) {
      // Counts are whole numbers; the division is not.
      axis.encoder_pp_counts = std::round((a.highest_m - a.lowest_m) / facts_[i].encoder_count_m);
      m.encoder_pp_counts = std::max(m.encoder_pp_counts.value_or(0.0), *axis.encoder_pp_counts);
    }
    m.axes.push_back(axis);
  }
  return m;
}

}  // namespace contour
