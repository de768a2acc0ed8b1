#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "analysis/recording/csv_table.h"
#include "config/config_error.h"
#include "tools/validation/emps/free_run.h"

namespace contour::emps {
namespace {

/// Second-order low-pass section by the bilinear transform; both sections of a 4th-order Butterworth differ
/// in Q.
struct Section {
  double b0, b1, b2, a1, a2;
};

Section LowPass(double corner_Hz, double rate_Hz, double q) {
  const double k = std::tan(std::numbers::pi * corner_Hz / rate_Hz);
  const double norm = 1.0 / (1.0 + k / q + k * k);
  return {k * k * norm, 2.0 * k * k * norm, k * k * norm, 2.0 * (k * k - 1.0) * norm,
          (1.0 - k / q + k * k) * norm};
}

/// One pass, settled at the first value.
void Pass(const Section& s, std::vector<double>& x) {
  const double first = x.front();
  double x1 = first, x2 = first, y1 = first, y2 = first;
  for (double& value : x) {
    const double y = s.b0 * value + s.b1 * x1 + s.b2 * x2 - s.a1 * y1 - s.a2 * y2;
    x2 = x1;
    x1 = value;
    y2 = y1;
    y1 = y;
    value = y;
  }
}

/// 4th-order Butterworth, forward and backward.
std::vector<double> Filtered(std::vector<double> x, double corner_Hz, double rate_Hz) {
  const std::array<Section, 2> sections = {
      LowPass(corner_Hz, rate_Hz, 1.0 / (2.0 * std::cos(std::numbers::pi / 8.0))),
      LowPass(corner_Hz, rate_Hz, 1.0 / (2.0 * std::cos(3.0 * std::numbers::pi / 8.0)))};
  for (int direction = 0; direction < 2; ++direction) {
    for (const Section& s : sections) Pass(s, x);
    std::reverse(x.begin(), x.end());
  }
  return x;
}

std::vector<double> CentralDifference(const std::vector<double>& x) {
  std::vector<double> out(x.size());
  for (std::size_t k = 1; k + 1 < x.size(); ++k) out[k] = 500.0 * (x[k + 1] - x[k - 1]);
  return out;
}

}  // namespace

Recording ReadRecording(const std::string& file, const std::string& name) {
  const diagnosis::CsvTable table(file);
  Recording r;
  r.name = name;
  const std::array<std::pair<const char*, std::vector<double>*>, 4> wanted = {
      {{"t_s", &r.time_s}, {"qg_m", &r.reference_m}, {"qm_m", &r.position_m}, {"force_N", &r.force_N}}};
  for (const auto& [column, values] : wanted) {
    const auto at = std::find(table.header().begin(), table.header().end(), column);
    if (at == table.header().end())
      throw ConfigError({file + ": no column " + column + ", expected a file of EMPS"});
    const auto place = static_cast<std::size_t>(at - table.header().begin());
    table.ForEachRow([&](std::size_t line, const std::vector<std::string_view>& fields) {
      values->push_back(diagnosis::NumberOf(fields[place], file, line, column));
    });
  }
  if (r.position_m.size() < 24700)
    throw ConfigError({file + ": has fewer than 24700 rows, expected a file of EMPS"});
  r.filtered_m = Filtered(r.position_m, 150.0, 1000.0);
  r.velocity_m_s = CentralDifference(r.filtered_m);
  r.slow_position_m = Filtered(r.position_m, 50.0, 1000.0);
  r.slow_velocity_m_s = CentralDifference(r.slow_position_m);
  r.slow_acceleration_m_s2 = CentralDifference(r.slow_velocity_m_s);
  // The force is held over each sample: at the instant of a sample it is the mean of two.
  std::vector<double> force = r.force_N;
  for (std::size_t k = 1; k < force.size(); ++k) force[k] = 0.5 * (r.force_N[k] + r.force_N[k - 1]);
  r.slow_force_N = Filtered(std::move(force), 50.0, 1000.0);
  return r;
}

}  // namespace contour::emps
