#include "analysis/metrics/scored_row.h"

namespace contour {

ScoredRow RowOf(const CycleRecord& record, bool estimates_friction) {
  ScoredRow row{record.path_time_s, PerAxis<ScoredAxis>(record.axes.size())};
  for (std::size_t i = 0; i < record.axes.size(); ++i) {
    const AxisRecord& from = record.axes[i];
    ScoredAxis& to = row.axes[i];
    to = {};
    to.reference_m = from.reference.position_m;
    to.encoder_m = from.position_m;
    if (from.feedback.has_scale) to.table_m = from.feedback.table_position_m;
    if (estimates_friction) to.friction_estimate_N = from.estimate.friction_N;
    to.torque_saturated = from.limit == Reason::kTorqueLimit;
  }
  return row;
}

}  // namespace contour
