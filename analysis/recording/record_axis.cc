#include "analysis/recording/record_axis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace contour {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

AxisRecorder::AxisRecorder(std::size_t axis, double period_s) : axis_(axis) { log_.period_s = period_s; }

void AxisRecorder::Add(const CycleRecord& record) {
  if (axis_ >= record.axes.size()) return;
  const AxisRecord& a = record.axes[axis_];
  const bool on = a.feedback.drive_state == DriveState::kOperationEnabled;
  if (!first_cycle_ && !on) return;
  if (!first_cycle_) first_cycle_ = record.cycle;
  if (record.cycle < *first_cycle_) return;
  const auto row = static_cast<std::size_t>(record.cycle - *first_cycle_);
  // Cycles that were lost: the drive went on with its last command, as far as is known.
  while (log_.command.size() <= row) {
    log_.command.push_back(log_.command.empty() ? 0.0 : log_.command.back());
    log_.position.push_back(kNone);
    log_.table_position_m.push_back(kNone);
    log_.present.push_back(0);
  }
  log_.command[row] = a.torque_Nm;
  if (!on || !a.feedback.fresh) return;
  log_.position[row] = a.feedback.position_rad;
  log_.present[row] = 1;
  if (a.feedback.has_scale) log_.table_position_m[row] = a.feedback.table_position_m;
}

double AxisRecorder::seconds() const {
  return log_.period_s * static_cast<double>(std::count(log_.present.begin(), log_.present.end(), 1));
}

diagnosis::AxisLog AxisRecorder::Take() {
  log_.rows = static_cast<std::size_t>(std::count(log_.present.begin(), log_.present.end(), 1));
  log_.missing = log_.size() - log_.rows;
  const auto& table = log_.table_position_m;
  if (std::all_of(table.begin(), table.end(), [](double x) { return std::isnan(x); }))
    log_.table_position_m.clear();
  return std::exchange(log_, {});
}

}  // namespace contour
