#include "analysis/prediction_error/wrong_readings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/prediction_error/stands_out.h"

namespace contour::diagnosis {
namespace {

/// Of every row: its reading less the middle of those before and after it.
std::vector<double> OffTheMiddle(const std::vector<double>& q) {
  std::vector<double> out(q.size(), 0.0);
  for (std::size_t k = 1; k + 1 < q.size(); ++k) out[k] = q[k] - 0.5 * (q[k - 1] + q[k + 1]);
  return out;
}

}  // namespace

void TakeOutWrongReadings(AxisLog& log, double position_step) {
  const std::vector<double> off = OffTheMiddle(log.position);
  StandsOut stands_out(off, position_step);
  for (std::size_t k = 2; k + 2 < off.size(); ++k) {
    // It pulls the middle of either neighbour along by half of itself; a jump of the speed does not.
    const double left = std::max(std::fabs(off[k - 1] + 0.5 * off[k]), std::fabs(off[k + 1] + 0.5 * off[k]));
    if (!(left < kRows.shock_share * std::fabs(off[k])) || !stands_out(k)) continue;
    log.position[k] = std::numeric_limits<double>::quiet_NaN();
    log.present[k] = 0;
    ++log.wrong_readings;
  }
}

}  // namespace contour::diagnosis
