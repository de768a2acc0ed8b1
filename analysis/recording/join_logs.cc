#include <cmath>
#include <limits>
#include <utility>

#include "analysis/recording/read_log.h"
#include "config/config_error.h"
#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kGap_s = 0.5;

void Append(std::vector<double>& to, const std::vector<double>& from, std::size_t gap, bool hold) {
  if (to.empty() || from.empty()) {
    to.clear();
    return;
  }
  to.insert(to.end(), gap, hold ? to.back() : kNone);
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

AxisLog JoinLogs(std::vector<AxisLog> logs) {
  if (logs.empty()) throw ConfigError({"found no log, expected at least one"});
  AxisLog all = std::move(logs.front());
  for (std::size_t i = 1; i < logs.size(); ++i) {
    const AxisLog& next = logs[i];
    if (next.linear != all.linear)
      throw ConfigError({next.source + ": is of a " + (next.linear ? "linear" : "rotary") + " axis, " +
                         all.source + " is not"});
    if (std::abs(next.period_s - all.period_s) > 1e-3 * all.period_s)
      throw ConfigError({next.source + ": has a row every " + RoundedText(1e6 * next.period_s) + " us, " +
                         all.source + " every " + RoundedText(1e6 * all.period_s)});
    if (next.in_ampere != all.in_ampere)
      throw ConfigError({next.source + ": states " + (next.in_ampere ? "a current, " : "no current, ") +
                         all.source + " does otherwise"});
    auto gap = static_cast<std::size_t>(std::lround(kGap_s / all.period_s));
    while (!IsGap(gap, all.period_s)) ++gap;
    all.present.insert(all.present.end(), gap, 0);
    all.present.insert(all.present.end(), next.present.begin(), next.present.end());
    Append(all.command, next.command, gap, true);
    Append(all.position, next.position, gap, false);
    Append(all.table_position_m, next.table_position_m, gap, false);
    Append(all.temperature_degC, next.temperature_degC, gap, true);
    Append(all.axis2_position_m, next.axis2_position_m, gap, true);
    Append(all.reference_position, next.reference_position, gap, true);
    all.from_velocity = all.from_velocity || next.from_velocity;
    all.rows += next.rows;
    all.missing += next.missing;
    all.source += ", " + next.source;
    if (all.note.empty()) all.note = next.note;
  }
  return all;
}

}  // namespace contour::diagnosis
