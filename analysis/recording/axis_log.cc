#include "analysis/recording/axis_log.h"

namespace contour::diagnosis {
namespace {

/// The command of a missing row is not known. For so long the last one is good enough, as a drive goes on
/// with it: a few cycles of a bus, or some rows of a slow recorder.
constexpr double kLongest_s = 0.0101;
constexpr std::size_t kMostRows = 3;

}  // namespace

bool IsGap(std::size_t missing, double period_s) {
  return missing > kMostRows && static_cast<double>(missing) * period_s > kLongest_s;
}

std::vector<std::size_t> Beginnings(const AxisLog& log) {
  std::vector<std::size_t> out = {0};
  std::size_t missing = 0;
  for (std::size_t k = 0; k < log.present.size(); ++k) {
    if (log.present[k] == 0) {
      ++missing;
      continue;
    }
    if (k > missing && IsGap(missing, log.period_s)) out.push_back(k);
    missing = 0;
  }
  return out;
}

}  // namespace contour::diagnosis
