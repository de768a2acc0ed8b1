#include "analysis/recording/record_axis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace contour {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

AxisRecorder::AxisRecorder(std::size_t axis, double period_s, const RecordedTorque& torque)
    : axis_(axis), torque_(torque) {
  log_.period_s = period_s;
}

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
    reported_Nm_.push_back(reported_Nm_.empty() ? 0.0 : reported_Nm_.back());
    log_.position.push_back(kNone);
    log_.table_position_m.push_back(kNone);
    log_.present.push_back(0);
  }
  log_.command[row] = a.torque_Nm;
  if (a.feedback.fresh) reported_Nm_[row] = a.feedback.torque_Nm;
  if (!on || !a.feedback.fresh) return;
  log_.position[row] = a.feedback.position_rad;
  log_.present[row] = 1;
  if (a.feedback.has_scale) log_.table_position_m[row] = a.feedback.table_position_m;
}

/// What a drive in csp makes of its torque, as if it had been commanded: the offset that was sent, whose
/// periods are known exactly, and what its own loop adds. That is what it reported less the offset, settled
/// by then; over a period the mean of both ends, a lag earlier, since it is behind the current loop already.
void AxisRecorder::CommandFromReports() {
  const std::size_t d = torque_.delay_cycles;
  std::vector<double> own(reported_Nm_);
  for (std::size_t k = d + 1; k < own.size(); ++k) own[k] -= log_.command[k - 1 - d];
  const double lead = torque_.lag_s / log_.period_s;
  for (std::size_t k = 0; k + d + 1 < own.size(); ++k) {
    const double from = own[k + d], to = own[k + d + 1];
    log_.command[k] += 0.5 * (from + to) + lead * (to - from);
  }
}

double AxisRecorder::seconds() const {
  return log_.period_s * static_cast<double>(std::count(log_.present.begin(), log_.present.end(), 1));
}

diagnosis::AxisLog AxisRecorder::Take() {
  log_.rows = static_cast<std::size_t>(std::count(log_.present.begin(), log_.present.end(), 1));
  log_.missing = log_.size() - log_.rows;
  if (torque_.reported) {
    log_.offset = log_.command;
    log_.reported = reported_Nm_;
    CommandFromReports();
  }
  reported_Nm_.clear();
  const auto& table = log_.table_position_m;
  if (std::all_of(table.begin(), table.end(), [](double x) { return std::isnan(x); }))
    log_.table_position_m.clear();
  return std::exchange(log_, {});
}

}  // namespace contour
