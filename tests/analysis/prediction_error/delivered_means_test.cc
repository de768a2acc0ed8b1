#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "analysis/prediction_error/forward_filter.h"

namespace contour::diagnosis {
namespace {

TEST(DeliveredMeans, HoldDelayAndLagAreExact) {
  AxisLog log;
  log.period_s = 1e-3;
  log.command.assign(40, 0.0);
  for (std::size_t k = 10; k < 40; ++k) log.command[k] = 1.0;
  const double delay_s = 1.3e-3, lag_s = 0.4e-3;
  const Delivered d = DeliveredMeans(log, delay_s, lag_s, 4);
  for (std::size_t k = 10; k < 20; ++k)
    for (std::size_t j = 0; j < 4; ++j) {
      // Mean over the sub-step of 1 - e^(-(t - t0) / lag), by its integral.
      const auto integral = [&](double t) { return t <= 0.0 ? 0.0 : t + lag_s * std::expm1(-t / lag_s); };
      const double t = (static_cast<double>(k) - 10.0) * 1e-3 + 0.25e-3 * static_cast<double>(j) - delay_s;
      EXPECT_NEAR(d.mean[4 * k + j], (integral(t + 0.25e-3) - integral(t)) / 0.25e-3, 1e-9);
    }
}

// The integral over the whole is that of the command, later by delay and lag.
TEST(DeliveredMeans, NothingIsLostOnTheWay) {
  AxisLog log;
  log.period_s = 1e-3;
  log.command.assign(60, 0.0);
  log.command[10] = 3.0;
  log.command[11] = -1.0;
  for (const double delay_s : {0.0, 0.4e-3, 1e-3, 2.7e-3}) {
    const Delivered d = DeliveredMeans(log, delay_s, 0.3e-3, 4);
    EXPECT_NEAR(std::accumulate(d.mean.begin(), d.mean.end(), 0.0) / 4.0, 2.0, 1e-9) << delay_s;
  }
}

// Without delay and lag there is the command, and nothing comes late.
TEST(DeliveredMeans, WithoutDelayAndLagItIsTheCommand) {
  AxisLog log;
  log.period_s = 1e-3;
  log.command = {1.0, 4.0, -2.0, 0.5};
  for (const double delay_s : {0.0, -1e-3}) {
    const Delivered d = DeliveredMeans(log, delay_s, 0.0, 2);
    for (std::size_t i = 0; i < 8; ++i) {
      EXPECT_DOUBLE_EQ(d.mean[i], log.command[i / 2]);
      EXPECT_NEAR(d.late[i], 0.0, 1e-18);
    }
  }
}

// A unit inertia driven by mean and lateness goes where it would under the torque itself.
TEST(DeliveredMeans, MeanAndLatenessMoveAMassExactly) {
  AxisLog log;
  log.period_s = 1e-3;
  log.command.assign(12, 0.0);
  for (std::size_t k = 2; k < 12; ++k) log.command[k] = 1.0;
  const double delay_s = 0.7e-3, lag_s = 0.5e-3, h = 0.5e-3;
  const Delivered d = DeliveredMeans(log, delay_s, lag_s, 2);
  double x = 0.0, v = 0.0;
  for (std::size_t i = 0; i < d.mean.size(); ++i) {
    x += h * v + 0.5 * h * h * d.mean[i] + d.late[i];
    v += h * d.mean[i];
  }
  // Twice the integral of 1 - e^(-t / lag).
  const double t = 10e-3 - delay_s;
  const double expected = 0.5 * t * t - lag_s * t + lag_s * lag_s * (1.0 - std::exp(-t / lag_s));
  EXPECT_NEAR(x, expected, 1e-12);
}

TEST(DeliveredMeans, StretchesAreWhatTheWholeHasThere) {
  AxisLog log;
  log.period_s = 1e-3;
  for (int k = 0; k < 400; ++k) log.command.push_back(std::sin(0.1 * k * k));
  const Delivered whole = DeliveredMeans(log, 1.3e-3, 0.4e-3, 4);
  const Segment segments[] = {{.from = 100, .rows = 20, .at = 0}, {.from = 300, .rows = 30, .at = 20}};
  Delivered part;
  DeliveredMeans(log, 1.3e-3, 0.4e-3, 4, segments, part);
  ASSERT_EQ(part.mean.size(), 50U * 4U);
  for (std::size_t i = 0; i < 80; ++i) EXPECT_NEAR(part.mean[i], whole.mean[400 + i], 1e-12);
  for (std::size_t i = 0; i < 120; ++i) EXPECT_NEAR(part.late[80 + i], whole.late[1200 + i], 1e-18);
}

}  // namespace
}  // namespace contour::diagnosis
