#include "analysis/identification/response_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

namespace contour::identify {
namespace {

constexpr double kPeriod_s = 1e-3;

/// A table of 290 kg on a screw of 104 N/um, a tenth of it swinging at 57 Hz: twice below the screw's own.
struct Truth {
  double motor_kg = 1200.0, table_kg = 290.0, stiffness_N_m = 1.04e8, damping_Ns_m = 9e3;
  double share = 0.12, side_Hz = 57.0, side_ratio = 0.02, delay_s = 1.2e-3;
};

std::vector<ResponsePoint> ResponseOf(const Truth& t) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.01);
  std::vector<ResponsePoint> response;
  for (double f = 40.0; f < 300.0; f += 2.0) {
    const std::complex<double> s(0.0, 2.0 * std::numbers::pi * f);
    const double side_kg = t.share * t.table_kg, w = 2.0 * std::numbers::pi * t.side_Hz;
    const std::complex<double> spring = side_kg * (w * w + 2.0 * t.side_ratio * w * s);
    const std::complex<double> inertia = side_kg * s * s;
    const std::complex<double> table = (t.table_kg - side_kg) * s * s + inertia * spring / (inertia + spring);
    const std::complex<double> screw = t.stiffness_N_m + t.damping_Ns_m * s;
    const std::complex<double> motor = t.motor_kg * s * s + screw * table / (screw + table);
    const std::complex<double> a = s * s / motor * std::exp(-s * t.delay_s);
    response.push_back({f, std::abs(a) * (1.0 + noise(random)), 0.99, std::arg(a) + noise(random)});
  }
  return response;
}

TableAxis Start() {
  TableAxis a;
  a.two_inertia = true;
  // As far off as a fit of two masses alone has been seen to end.
  a.motor_inertia = 1380.0;
  a.load_inertia = 120.0;
  a.stiffness = 4e7;
  return a;
}

TEST(FitResponse, FindsAPartThatSwingsBelowTheScrew) {
  const Truth t;
  const auto found = FitResponse(Start(), ResponseOf(t), kPeriod_s);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->side.frequency_Hz / t.side_Hz, 1.0, 0.01);
  EXPECT_NEAR(found->side.share / t.share, 1.0, 0.1);
  EXPECT_NEAR(found->load_inertia / t.table_kg, 1.0, 0.05);
  EXPECT_NEAR(found->motor_inertia / t.motor_kg, 1.0, 0.02);
  EXPECT_NEAR(found->stiffness / t.stiffness_N_m, 1.0, 0.05);
}

TEST(FitResponse, SaysNothingOfNoise) {
  std::vector<ResponsePoint> response = ResponseOf(Truth{});
  for (ResponsePoint& p : response) p.coherence = 0.3;
  EXPECT_FALSE(FitResponse(Start(), response, kPeriod_s).has_value());
}

}  // namespace
}  // namespace contour::identify
