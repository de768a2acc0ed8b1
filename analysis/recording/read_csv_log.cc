#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/recording/csv_table.h"
#include "analysis/recording/grid.h"
#include "analysis/recording/read_log.h"
#include "analysis/recording/table_rows.h"
#include "config/config_error.h"
#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kTurn = 2.0 * std::numbers::pi;

/// Values on the grid; where there is no row the one before goes on when `hold`.
std::vector<double> OnGrid(const Grid& grid, const std::vector<double>& values, bool hold) {
  if (values.empty()) return {};
  std::vector<double> out(grid.index.back() + 1, kNone);
  for (std::size_t i = 0; i < values.size(); ++i) out[grid.index[i]] = values[i];
  double last = kNone;
  for (const double v : values)
    if (!std::isnan(v)) {
      last = v;  // before the first, the first
      break;
    }
  if (std::isnan(last)) return {};  // a column without any number is no column
  for (double& v : out) {
    if (!std::isnan(v)) last = v;
    if (hold) v = last;
  }
  return out;
}

/// Angles that begin again after every turn go on. No axis makes half a turn from row to row.
void Unwrap(std::vector<double>& angle) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const double a : angle) {
    if (std::isnan(a)) continue;
    low = std::min(low, a);
    high = std::max(high, a);
  }
  if (!(high - low > 0.5 * kTurn && high - low < kTurn * (1.0 + 1e-6))) return;
  double before = kNone, turns = 0.0;
  for (double& a : angle) {
    if (std::isnan(a)) continue;
    if (!std::isnan(before) && std::abs(a - before) > 0.5 * kTurn) turns += a < before ? 1.0 : -1.0;
    before = a;
    a += turns * kTurn;
  }
}

/// Where nobody recorded the position.
std::vector<double> IntegralOf(const std::vector<double>& velocity, const Grid& grid) {
  std::vector<double> q(velocity.size(), 0.0);
  for (std::size_t i = 1; i < q.size(); ++i)
    q[i] = q[i - 1] + 0.5 * (velocity[i] + velocity[i - 1]) * grid.period_s *
                          static_cast<double>(grid.index[i] - grid.index[i - 1]);
  return q;
}

/// [share] A column that is further off another one is none of the same motion.
constexpr double kFar = 0.2;

/// What a scale reads has to be the position, but for its zero. Of less than a turn of a screw a gap may take
/// more than that: it is not judged.
void CheckScale(const std::string& file, const TableRows& rows, double table_per_q, double turn_m) {
  double n = 0.0, q = 0.0, x = 0.0, qq = 0.0, qx = 0.0;
  double q0 = kNone, x0 = kNone, low = 0.0, high = 0.0;
  for (std::size_t i = 0; i < rows.position.size(); ++i) {
    if (std::isnan(rows.position[i]) || std::isnan(rows.table_position[i])) continue;
    if (std::isnan(q0)) {
      q0 = rows.position[i];
      x0 = rows.table_position[i];
    }
    const double at = (rows.position[i] - q0) * table_per_q, read = rows.table_position[i] - x0;
    low = std::min(low, at);
    high = std::max(high, at);
    n += 1.0;
    q += at;
    x += read;
    qq += at * at;
    qx += at * read;
  }
  const double moved = qq - q * q / n, ratio = (qx - q * x / n) / moved;
  if (!(moved > 0.0) || high - low < turn_m || std::abs(ratio - 1.0) < kFar) return;
  throw ConfigError(
      {file + ": the scale (table_position_m) reads " + RoundedText(ratio) +
       " times what the position says, expected 1: is one of them in another unit, of another sign or of "
       "another axis, or the lead another one? --columns NAME=HEADER*FACTOR takes a factor; a column by "
       "another name is not read"});
}

/// A velocity has to be that of the position: where it is not, a unit, a sign or an axis is another one.
void CheckVelocity(const std::string& file, const TableRows& rows, const Grid& grid) {
  const std::size_t reach = std::max<std::size_t>(1, static_cast<std::size_t>(0.01 / grid.period_s));
  double squares = 0.0, product = 0.0, recorded = 0.0;
  for (std::size_t i = reach; i + reach < rows.position.size(); ++i) {
    const auto steps = static_cast<double>(grid.index[i + reach] - grid.index[i - reach]);
    const double w = (rows.position[i + reach] - rows.position[i - reach]) / (steps * grid.period_s);
    const double v = rows.velocity[i];
    if (steps > 2.5 * static_cast<double>(reach) || std::isnan(w) || std::isnan(v)) continue;
    squares += w * w;
    product += w * v;
    recorded += v * v;
  }
  // Noise in the one and in the other make these two its bounds.
  const double least = product / squares, most = recorded / product;
  if (squares > 0.0 && !(least < 1.0 + kFar && most > 1.0 - kFar && product > 0.0))
    throw ConfigError(
        {file + ": the velocity is " + RoundedText(least) +
         " times what the position's changes say, expected 1: is one of them in another unit, of "
         "another sign or of another axis? --columns NAME=HEADER*FACTOR takes a factor"});
}

/// What acted over each row: the mean of what was measured at its ends.
void HoldMeans(std::vector<double>& command, const Grid& grid) {
  for (std::size_t i = 0; i + 1 < command.size(); ++i)
    if (grid.index[i + 1] == grid.index[i] + 1 && !std::isnan(command[i + 1]))
      command[i] = 0.5 * (command[i] + command[i + 1]);
}

void InUnitsOfAxis(const LogColumns& columns, const ReadOptions& options, TableRows& rows) {
  if (columns.reference_in_m && !columns.linear)
    for (double& r : rows.reference) r /= options.table_per_q;
  if (columns.position_in_m)
    for (auto* column : {&rows.position, &rows.velocity})
      for (double& x : *column) x /= options.table_per_q;
  else if (!columns.linear)
    Unwrap(rows.position);
}

/// What analysis is made for: slower rows hold nothing of friction, faster ones are filtered first.
constexpr double kSlowest_Hz = 50.0, kFastest_Hz = 10e3;
/// [relative] A nominal rate is one, though its clock is off.
constexpr double kOffNominal = 0.1;

void DemandRate(const std::string& file, double period_s) {
  const double rate_Hz = 1.0 / period_s;
  const std::string found = file + ": found rows at " + RoundedText(rate_Hz) + " Hz, expected " +
                            RoundedText(kSlowest_Hz) + " to " + RoundedText(kFastest_Hz) + " Hz";
  if (rate_Hz < (1.0 - kOffNominal) * kSlowest_Hz)
    throw ConfigError({found + ": slower ones show nothing of friction; are the times in seconds?"});
  if (rate_Hz > (1.0 + kOffNominal) * kFastest_Hz)
    throw ConfigError({found + "; --resample " + RoundedText(kFastest_Hz) + " puts them on a slower grid"});
}

}  // namespace

AxisLog ReadCsvLog(const std::string& file, const ReadOptions& options) {
  const CsvTable table(file);
  const LogColumns columns =
      FindColumns(file, table.header(), options.axis, options.columns, options.sample_rate_Hz > 0.0);
  if (columns.time && options.sample_rate_Hz > 0.0)
    throw ConfigError({file + ": has times in its column " + table.header()[columns.time->at] +
                       ", found --sample-rate, which is for a table without; expected one of the two"});
  TableRows rows = ReadTableRows(table, columns, options.sample_rate_Hz);
  InUnitsOfAxis(columns, options, rows);
  AxisLog log;
  log.rows = rows.time_s.size();
  Grid grid;
  if (options.resample_Hz > 0.0) {
    rows = Resample(file, rows, columns.measured, options.resample_Hz, grid, log.note);
    log.rows = rows.time_s.size();
  } else {
    grid = FindGrid(file, rows.time_s, rows.line);
    if (columns.measured) HoldMeans(rows.command, grid);
  }
  DemandRate(file, grid.period_s);
  log.from_velocity = rows.position.empty();
  if (log.from_velocity)
    rows.position = IntegralOf(rows.velocity, grid);
  else if (!rows.velocity.empty())
    CheckVelocity(file, rows, grid);
  const bool screw = !columns.linear && options.table_per_q != 1.0;
  if (!rows.table_position.empty() && (columns.linear || columns.position_in_m || screw))
    CheckScale(file, rows, screw ? options.table_per_q : 1.0,
               screw ? kTurn * std::abs(options.table_per_q) : 0.0);

  log.source = file;
  log.axis = options.axis;
  log.linear = columns.linear;
  log.in_ampere = columns.in_ampere;
  log.period_s = grid.period_s;
  log.command = OnGrid(grid, rows.command, true);
  log.position = OnGrid(grid, rows.position, false);
  if (log.command.empty() || log.position.empty())
    throw ConfigError(
        {file + ": the columns of command and position hold no number in which the drive was on"});
  log.table_position_m = OnGrid(grid, rows.table_position, false);
  log.temperature_degC = OnGrid(grid, rows.temperature, true);
  log.axis2_position_m = OnGrid(grid, rows.axis2, true);
  log.reference_position = OnGrid(grid, rows.reference, true);
  log.missing = log.size() - log.rows;
  for (const double q : log.position) log.present.push_back(std::isnan(q) ? 0 : 1);
  return log;
}

}  // namespace contour::diagnosis
