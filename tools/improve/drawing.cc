#include "tools/improve/drawing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "config/extended_model.h"
#include "daemon/program/program.h"

namespace contour::improve {
namespace {

/// What a model says stands between motor and table.
struct Between {
  Mechanics mechanics;
  KnownEffects known;

  explicit Between(const ModelConfig& model)
      : mechanics(ToSi(Extended(model).mechanics)), known(model.extensions, mechanics, 0.0) {}

  /// `then`: known when it was drawn. What was not has been told as friction; a constant torque, too, which
  /// is the motor's and winds nothing up.
  [[nodiscard]] double Table_m(const DrawnAxis& a, const KnownEffects& then) const {
    const double through_N = a.friction_N - then.TableForce_N(a.encoder_m) + known.Constant_N() -
                             then.Constant_N() + mechanics.table_mass_kg * a.acceleration_m_s2;
    return a.encoder_m - through_N / mechanics.stiffness_N_m - known.Lead_m(a.encoder_m);
  }
};

/// Between motor and table in one drawing.
class Screws {
 public:
  Screws(const MachineConfig& yardstick, const Drawing& drawing) : then_(drawing.known) {
    for (const auto& [name, axis] : yardstick.axes) between_.emplace_back(axis.model);
    then_.resize(between_.size());
  }
  [[nodiscard]] std::size_t size() const { return between_.size(); }
  [[nodiscard]] double Table_m(const DrawnCycle& c, std::size_t axis) const {
    return between_[axis].Table_m(c.axes[axis], then_[axis]);
  }

 private:
  std::vector<Between> between_;
  PerAxis<KnownEffects> then_;
};

/// Mean and largest of what is added.
struct Sum {
  double largest_m = 0.0, squares_m2 = 0.0;
  std::size_t count = 0;
  void Add(double error_m) {
    largest_m = std::max(largest_m, std::abs(error_m));
    squares_m2 += error_m * error_m;
    ++count;
  }
  [[nodiscard]] PathError Error() const {
    return {1e6 * largest_m,
            1e6 * std::sqrt(squares_m2 / static_cast<double>(std::max<std::size_t>(count, 1)))};
  }
};

/// Distances of places from one path.
class Judge {
 public:
  explicit Judge(std::shared_ptr<const MotionPlan> plan) : plan_(std::move(plan)) {}

  [[nodiscard]] bool Counts(const DrawnCycle& c) const {
    return c.path_time_s >= 0.0 && plan_->Scored(c.path_time_s);
  }
  void Add(const DrawnCycle& c, const PerAxis<double>& place_m, Sum& sum) const {
    sum.Add(c.axes.size() > 1 ? plan_->Distance_m(place_m) : place_m[0] - c.axes[0].reference_m);
  }

 private:
  std::shared_ptr<const MotionPlan> plan_;
};

/// A scale's zero is its own: over a drawing the table is on average where the motor says.
PerAxis<double> ZeroOfScales(const Drawing& drawing, const Judge& judge, const Screws& screws) {
  PerAxis<double> zero_m(screws.size());
  for (std::size_t i = 0; i < screws.size(); ++i) {
    double sum_m = 0.0;
    std::size_t count = 0;
    for (const DrawnCycle& c : drawing.cycles) {
      if (!judge.Counts(c) || std::isnan(c.axes[i].scale_m)) continue;
      sum_m += c.axes[i].scale_m - screws.Table_m(c, i);
      ++count;
    }
    zero_m[i] = count > 0 ? sum_m / static_cast<double>(count) : 0.0;
  }
  return zero_m;
}

bool HasScales(const Drawing& drawing) {
  return !drawing.cycles.empty() &&
         std::all_of(drawing.cycles.begin(), drawing.cycles.end(), [](const DrawnCycle& c) {
           return std::none_of(c.axes.begin(), c.axes.end(),
                               [](const DrawnAxis& a) { return std::isnan(a.scale_m); });
         });
}

std::optional<PathError> TruthOf(const Drawing& drawing, const Judge& judge, const TruthTable& truth) {
  std::vector<ReceivedAngles> angles;
  for (const DrawnCycle& c : drawing.cycles) {
    ReceivedAngles& r = angles.emplace_back();
    r.feedback_sync = c.feedback_sync;
    for (const DrawnAxis& a : c.axes) r.angle_rad.push_back(a.angle_rad);
  }
  const auto offset = truth.OffsetOf(angles);
  if (!offset) return {};
  Sum sum;
  for (const DrawnCycle& c : drawing.cycles) {
    const TruthSample* at =
        truth.Find(static_cast<std::uint64_t>(static_cast<std::int64_t>(c.feedback_sync) + *offset));
    if (at != nullptr && judge.Counts(c)) judge.Add(c, at->table_m, sum);
  }
  return sum.Error();
}

}  // namespace

PerAxis<KnownEffects> KnownOf(const MachineConfig& machine) {
  PerAxis<KnownEffects> out;
  for (const auto& [name, axis] : machine.axes) out.push_back(Between(axis.model).known);
  return out;
}

void AddCycle(const CycleRecord& record, Drawing& drawing) {
  DrawnCycle& c = drawing.cycles.emplace_back();
  c.path_time_s = record.path_time_s;
  c.feedback_sync = record.feedback_sync;
  for (const AxisRecord& a : record.axes)
    c.axes.push_back({a.reference.position_m, a.reference.acceleration_m_s2, a.position_m,
                      a.feedback.has_scale ? a.feedback.table_position_m : kNoTruth, a.estimate.friction_N,
                      a.feedback.position_rad});
}

PathErrors ErrorsOf(const Drawing& drawing, const ProgramText& program, const PerAxis<PlanLimits>& limits,
                    const MachineConfig& yardstick, const TruthTable* truth) {
  const Judge judge(
      PlanMotion(ParseProgram(program.text, program.name, program.format), drawing.start_m, limits));
  const Screws screws(yardstick, drawing);
  const bool scales = HasScales(drawing);
  const PerAxis<double> zero_m = ZeroOfScales(drawing, judge, screws);
  Sum encoder, believed, scale;
  for (const DrawnCycle& c : drawing.cycles) {
    if (!judge.Counts(c)) continue;
    PerAxis<double> at_encoder, at_table, at_scale;
    for (std::size_t i = 0; i < c.axes.size(); ++i) {
      at_encoder.push_back(c.axes[i].encoder_m);
      at_table.push_back(screws.Table_m(c, i));
      at_scale.push_back(c.axes[i].scale_m - zero_m[i]);
    }
    judge.Add(c, at_encoder, encoder);
    judge.Add(c, at_table, believed);
    if (scales) judge.Add(c, at_scale, scale);
  }
  PathErrors out{encoder.Error(), believed.Error(), {}, {}};
  if (scales) out.scale = scale.Error();
  if (truth != nullptr) out.truth = TruthOf(drawing, judge, *truth);
  return out;
}

}  // namespace contour::improve
