#include "design/spectral_radius.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>

#include "design/loop_margins.h"
#include "tests/design/family_axes.h"

namespace contour {
namespace {

using Index = Eigen::Index;

double ByEigen(const LoopMatrix& m) {
  return Eigen::EigenSolver<LoopMatrix>(m, false).eigenvalues().cwiseAbs().maxCoeff();
}

/// As MarginsOn closes it.
LoopMatrix Closed(const LoopMember& member, const TwoInertiaLoop& loop, double force_N) {
  const LinearSystem plant = MakePlant(member, 1e-3, force_N).system,
                     controller = MakeController(loop, force_N);
  const Index n = plant.a.rows(), m = controller.a.rows();
  LoopMatrix a(n + m, n + m);
  a << plant.a + plant.b.col(0) * controller.d * plant.c, plant.b.col(0) * controller.c,
      controller.b * plant.c, controller.a;
  return a;
}

// Their states are of several sizes: far beyond that, products say nothing any more, and eigenvalues decide.
TEST(SpectralRadius, SaysWhetherLoopsAreStableOnAllThatAnAxisMayBe) {
  for (const FamilyAxis& family : kFamily)
    for (const bool scale : {false, true}) {
      const LoopAxis axis = AxisOf(family, scale);
      const TwoInertiaLoop loop = DesignLoop(axis.axis, kTuning, 1e-3, scale);
      const double force_N = 1e6 * (axis.axis.motor_mass_kg + axis.axis.table_mass_kg);
      for (const LoopMember& member : UncertaintySet(axis)) {
        const LoopMatrix closed = Closed(member, loop, force_N);
        const double radius = ByEigen(closed), told = SpectralRadius(closed, 1.0);
        EXPECT_EQ(told < 1.0, radius < 1.0) << family.name << ", " << member.name << ": " << radius;
        EXPECT_GE(told, radius * (1.0 - 1e-9)) << family.name << ", " << member.name;
      }
    }
}

// Who asks whether a loop is stable has the answer sooner.
TEST(SpectralRadius, IsBoundedFromAboveWhereThatIsEnough) {
  std::mt19937 generator(2);
  std::normal_distribution<double> draw;
  for (int i = 0; i < 200; ++i) {
    LoopMatrix m(12, 12);
    for (double& value : m.reshaped()) value = 0.28 * draw(generator);
    const double radius = ByEigen(m), told = SpectralRadius(m, 1.0);
    EXPECT_EQ(told < 1.0, radius < 1.0) << radius;
    EXPECT_GE(told, radius * (1.0 - 1e-12));
    if (radius >= 1.0) {
      EXPECT_NEAR(told, radius, 1e-12 * radius);
    }
  }
}

TEST(SpectralRadius, OfARotationIsItsLength) {
  LoopMatrix m(2, 2);
  m << 0.3, -0.4, 0.4, 0.3;
  EXPECT_NEAR(SpectralRadius(m), 0.5, 1e-15);
}

TEST(SpectralRadius, OfARingOfDelaysIsFound) {
  // All eigenvalues are of one size.
  LoopMatrix m = LoopMatrix::Zero(8, 8);
  for (Index i = 0; i < 8; ++i) m(i, (i + 1) % 8) = 0.9;
  EXPECT_NEAR(SpectralRadius(m), 0.9, 1e-13);
}

TEST(SpectralRadius, OfAQueueThatEmptiesIsNothing) {
  LoopMatrix m = LoopMatrix::Zero(4, 4);
  for (Index i = 0; i + 1 < 4; ++i) m(i, i + 1) = 1.0;
  EXPECT_EQ(SpectralRadius(m), 0.0);
  EXPECT_EQ(SpectralRadius(m, 1.0), 0.0);
}

TEST(SpectralRadius, OfWhatIsNoNumberIsNotStable) {
  LoopMatrix m = LoopMatrix::Identity(3, 3);
  m(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(SpectralRadius(m) < 1.0);
  EXPECT_FALSE(SpectralRadius(m, 1.0) < 1.0);
}

}  // namespace
}  // namespace contour
