#include "analysis/identification/simulation.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "analysis/identification/axis_bundle.h"
#include "analysis/parallel/parallel_for.h"

namespace contour::identify {
namespace {

/// What each axis asks of the drive's own force, where the drive leads; those that ask for the same share it.
std::vector<std::shared_ptr<const OwnForce>> OwnForces(const std::vector<LaneAxis>& axes,
                                                       const Measured& data) {
  std::vector<std::shared_ptr<const OwnForce>> own(axes.size());
  if (!data.led_by_drive()) return own;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    for (std::size_t j = 0; j < i && !own[i]; ++j)
      if (SameOwnForce(axes[i].axis(), axes[j].axis())) own[i] = own[j];
    if (!own[i]) own[i] = std::make_shared<OwnForce>(OwnForceOf(axes[i].axis(), data));
  }
  return own;
}

/// Axes whose periods are cut alike, as many as there are lanes.
std::vector<std::vector<std::size_t>> Bundles(const std::vector<LaneAxis>& axes) {
  std::vector<std::vector<std::size_t>> bundles;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto open = std::find_if(bundles.begin(), bundles.end(), [&](const std::vector<std::size_t>& b) {
      return b.size() < kAxisLanes && axes[b.front()].RunsWith(axes[i]);
    });
    if (open == bundles.end())
      bundles.push_back({i});
    else
      open->push_back(i);
  }
  return bundles;
}

double Harmonics(const std::array<double, 2 * LevelVariation::kHarmonics>& c, double cos1, double sin1) {
  double cos_n = cos1;
  double sin_n = sin1;
  double sum = 0.0;
  for (std::size_t n = 0; n < LevelVariation::kHarmonics; ++n) {
    sum += c[2 * n] * cos_n + c[2 * n + 1] * sin_n;
    const double next = cos_n * cos1 - sin_n * sin1;
    sin_n = sin_n * cos1 + cos_n * sin1;
    cos_n = next;
  }
  return sum;
}

double Place(const LevelVariation& v, double x_m) {
  if (!(v.high_m > v.low_m)) return 0.0;
  const double x = std::clamp((2.0 * x_m - v.low_m - v.high_m) / (v.high_m - v.low_m), -1.0, 1.0);
  return v.place[0] * x + v.place[1] * 0.5 * (3.0 * x * x - 1.0) + v.place[2] * 0.5 * (5.0 * x * x - 3.0) * x;
}

}  // namespace

Eigen::MatrixXd PredictionErrors_m(const std::vector<Followed>& axes, const std::vector<Measured>& records,
                                   int threads) {
  Eigen::Index rows = 0;
  for (const Measured& r : records) rows += static_cast<Eigen::Index>(r.compared());
  Eigen::MatrixXd errors = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(axes.size()));
  std::vector<LaneAxis> prepared;
  prepared.reserve(axes.size());
  for (const Followed& f : axes) prepared.emplace_back(f, records.front().period_s);
  std::vector<std::vector<std::shared_ptr<const OwnForce>>> own;
  own.reserve(records.size());
  for (const Measured& r : records) own.push_back(OwnForces(prepared, r));
  const std::vector<std::vector<std::size_t>> bundles = Bundles(prepared);
  ParallelFor(bundles.size(), threads, [&](std::size_t b) {
    std::vector<const LaneAxis*> members;
    for (const std::size_t i : bundles[b]) members.push_back(&prepared[i]);
    AxisBundle bundle(members);
    Eigen::Index first = 0;
    for (std::size_t r = 0; r < records.size(); ++r) {
      for (std::size_t lane = 0; lane < members.size(); ++lane) {
        const std::size_t i = bundles[b][lane];
        bundle.SetLane(lane, own[r][i].get(), {&errors(first, static_cast<Eigen::Index>(i))});
      }
      bundle.Run(records[r]);
      first += static_cast<Eigen::Index>(records[r].compared());
    }
  });
  return errors;
}

std::vector<double> PredictionErrors_m(const TableAxis& axis, const Measured& data, const FollowGain& gain) {
  const Eigen::MatrixXd errors = PredictionErrors_m({{axis, gain}}, {data}, 1);
  return {errors.data(), errors.data() + errors.size()};
}

Simulated Simulate(const TableAxis& axis, const Measured& data, const FollowGain& gain) {
  Simulated s;
  s.table_m.assign(data.size(), 0.0);
  s.friction_N.assign(data.size(), 0.0);
  std::vector<double> errors(data.compared(), 0.0);
  const std::vector<LaneAxis> one{LaneAxis({axis, gain}, data.period_s)};
  AxisBundle bundle({&one.front()});
  const auto own = OwnForces(one, data);
  bundle.SetLane(0, own.front().get(), {errors.data(), s.table_m.data(), s.friction_N.data()});
  bundle.Run(data);
  return s;
}

double LevelFactor(const TableAxis& axis, double motor_m, double table_m, bool up) {
  const LevelVariation& v = axis.variation;
  const double angle = axis.turn_m > 0.0 ? 2.0 * std::numbers::pi * motor_m / axis.turn_m : 0.0;
  const double turn = Harmonics(up ? v.turn_plus : v.turn_minus, std::cos(angle), std::sin(angle));
  return std::max(0.1, (1.0 + Place(v, table_m)) * (1.0 + turn));
}

}  // namespace contour::identify
