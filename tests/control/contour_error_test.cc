#include "control/contour_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "control/contour_path.h"

namespace contour {
namespace {

constexpr double kPeriod = 1e-3;

// Points of a circle about the origin at times (first + j) periods.
PerAxis<AxisHorizon> CircleFrom(double radius_m, double omega_rad_s, int first, int count) {
  PerAxis<AxisHorizon> reference(2);
  for (AxisHorizon& axis : reference) axis.clear();
  for (int j = 0; j < count; ++j) {
    const double phi = omega_rad_s * kPeriod * (first + j);
    const double s = std::sin(phi), c = std::cos(phi), w = omega_rad_s;
    reference[0].push_back({radius_m * c, -radius_m * w * s, -radius_m * w * w * c});
    reference[1].push_back({radius_m * s, radius_m * w * c, -radius_m * w * w * s});
  }
  return reference;
}

PerAxis<double> At(double x, double y) {
  PerAxis<double> p;
  p.push_back(x);
  p.push_back(y);
  return p;
}

TEST(ContourError, IsTheRadialErrorOnACircle) {
  for (const double radius : {1e-4, 1e-2}) {
    const double omega = 0.05 / radius > 20.0 ? 5.0 : 0.05 / radius;
    const PerAxis<AxisHorizon> reference = CircleFrom(radius, omega, 0, 20);
    for (const double off : {-0.1, 0.003, 0.1}) {  // of the radius
      for (const double ahead : {-3.3, -1.0, 0.0, 0.4, 6.7}) {
        const double phi = omega * kPeriod * ahead;
        const double r = radius * (1.0 + off);
        const ContourError e = FindContourError(At(r * std::cos(phi), r * std::sin(phi)), reference, kPeriod);
        EXPECT_NEAR(e.contour_m, std::abs(off) * radius, 2e-6 * radius)
            << radius << " " << off << " " << ahead;
        EXPECT_NEAR(e.nearest_periods, ahead, 0.01);
        EXPECT_NEAR(e.lag_m, -r * std::sin(phi), 1e-12);
      }
    }
  }
}

TEST(ContourError, LagIsPositiveBehind) {
  const PerAxis<AxisHorizon> reference = CircleFrom(0.01, 5.0, 0, 5);
  EXPECT_GT(FindContourError(At(0.01, -1e-6), reference, kPeriod).lag_m, 0.0);
  EXPECT_LT(FindContourError(At(0.01, 1e-6), reference, kPeriod).lag_m, 0.0);
}

TEST(ContourError, AtRestItIsTheDistance) {
  PerAxis<AxisHorizon> reference(2);
  for (AxisHorizon& axis : reference) {
    axis.clear();
    for (int j = 0; j < 5; ++j) axis.push_back({});
  }
  const ContourError e = FindContourError(At(3e-6, -4e-6), reference, kPeriod);
  EXPECT_NEAR(e.contour_m, 5e-6, 1e-18);
  EXPECT_EQ(e.lag_m, 0.0);
}

// A right-angled corner: along x at 50 mm/s until node 3, then along y. Points before `now` are the past.
TEST(ContourError, SeesBothLegsOfACorner) {
  PerAxis<AxisHorizon> reference(2);
  for (AxisHorizon& axis : reference) axis.clear();
  for (int j = 0; j < 12; ++j) {
    const double along = 5e-5 * (j - 3);
    reference[0].push_back({std::min(along, 0.0), j < 3 ? 0.05 : 0.0, 0.0});
    reference[1].push_back({std::max(along, 0.0), j < 3 ? 0.0 : 0.05, 0.0});
  }
  // The reference is 100 um round the corner, the axis still 20 um before it and 3 um off the first leg.
  const ContourError e = FindContourError(At(-20e-6, -3e-6), reference, kPeriod, 5);
  EXPECT_NEAR(e.contour_m, 3e-6, 1e-6);
  EXPECT_LT(e.nearest_periods, -1.9);
}

TEST(ContourError, OneAndThreeAxes) {
  PerAxis<AxisHorizon> reference(1);
  reference[0].clear();
  for (int j = 0; j < 6; ++j) reference[0].push_back({1e-5 * j, 1e-2, 0.0});
  PerAxis<double> p;
  p.push_back(3.3e-5);
  EXPECT_NEAR(FindContourError(p, reference, kPeriod).contour_m, 0.0,
              1e-15);  // one axis never leaves its line
  PerAxis<AxisHorizon> space(3);
  for (AxisHorizon& axis : space) {
    axis.clear();
    for (int j = 0; j < 6; ++j) axis.push_back({1e-5 * j, 1e-2, 0.0});
  }
  PerAxis<double> q;
  q.push_back(1e-6);
  q.push_back(-1e-6);
  q.push_back(0.0);
  EXPECT_NEAR(FindContourError(q, space, kPeriod).contour_m, std::numbers::sqrt2 * 1e-6, 1e-15);
}

// A helix of 10 mm and 3 mm a turn: errors along its normal and its binormal count as they are, those along
// it do not.
TEST(ContourError, InSpaceItIsTheDistanceFromAHelix) {
  constexpr double kRadius = 0.01, kOmega = 5.0, kClimb = kOmega * 3e-3 / (2.0 * std::numbers::pi);
  PerAxis<AxisHorizon> reference = CircleFrom(kRadius, kOmega, 0, 20);
  reference.resize(3);
  reference[2].clear();
  for (int j = 0; j < 20; ++j) reference[2].push_back({kClimb * kPeriod * j, kClimb, 0.0});
  const double speed = std::hypot(kRadius * kOmega, kClimb);
  for (const double ahead : {-2.0, 0.0, 0.6, 5.0}) {
    const double phi = kOmega * kPeriod * ahead;
    const double normal[] = {std::cos(phi), std::sin(phi), 0.0};
    const double share = kClimb / speed;
    const double binormal[] = {share * std::sin(phi), -share * std::cos(phi), kRadius * kOmega / speed};
    for (const double off : {-20e-6, 3e-6}) {
      PerAxis<double> beside(3), above(3);
      for (std::size_t i = 0; i < 3; ++i) {
        const double on = i == 2 ? kClimb * kPeriod * ahead : kRadius * normal[i];
        beside[i] = on + off * normal[i];
        above[i] = on + off * binormal[i];
      }
      EXPECT_NEAR(FindContourError(beside, reference, kPeriod).contour_m, std::abs(off), 1e-9);
      EXPECT_NEAR(FindContourError(above, reference, kPeriod).contour_m, std::abs(off), 1e-9);
      EXPECT_NEAR(FindContourError(above, reference, kPeriod).nearest_periods, ahead, 0.01);
    }
  }
}

TEST(ContourPath, TangentAndCurvatureOfACircle) {
  const PerAxis<AxisHorizon> reference = CircleFrom(0.01, 5.0, 0, 20);
  const ContourPath path(reference, kPeriod);
  EXPECT_DOUBLE_EQ(path.end(), 19.0);
  PathSample sample;
  PerAxis<double> tangent;
  for (const double at : {-2.5, 0.0, 0.5, 7.25, 19.0, 21.0}) {
    path.At(at, sample);
    const double phi = 5.0 * kPeriod * at;
    EXPECT_NEAR(sample.position_m[0], 0.01 * std::cos(phi), 1e-9);
    ASSERT_TRUE(ContourPath::Tangent(sample, tangent));
    EXPECT_NEAR(tangent[0], -std::sin(phi), 2e-4);
    EXPECT_NEAR(tangent[1], std::cos(phi), 2e-4);
    EXPECT_NEAR(ContourPath::Curvature_1_m(sample), 100.0, 0.1);
  }
}

TEST(ContourPath, NoTangentAtRest) {
  PathSample sample;
  sample.velocity_m_s.push_back(0.0);
  sample.acceleration_m_s2.push_back(0.0);
  PerAxis<double> tangent;
  EXPECT_FALSE(ContourPath::Tangent(sample, tangent));
  EXPECT_EQ(tangent[0], 0.0);
  EXPECT_EQ(ContourPath::Curvature_1_m(sample), 0.0);
}

}  // namespace
}  // namespace contour
