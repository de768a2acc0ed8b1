#include <gtest/gtest.h>

#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "payload_step";

TEST(PayloadStep, AddsAShareOfTheWholeInertiaFromAnInstantOn) {
  for (const bool two : {false, true}) {
    const test::KnownAxis axis({.two_inertia = two});
    const SharedEffect e = test::OnGrid(axis, kKind, "row 500");
    // 1e-4 kg m^2 in all; the instant 40 ms, that is 40 rows, later than on the grid.
    const AxisModel m = test::With(axis, e, {0.3, 0.04});
    EXPECT_NEAR(m.payload, 0.3e-4, 1e-15);
    EXPECT_EQ(m.payload_row, 540u);
    const NamedValues told = test::Told(axis, e, {0.3, 0.04});
    EXPECT_NEAR(told.at("inertia_change_rel"), 0.3, 1e-12);
    EXPECT_NEAR(told.at("time_s"), 0.54, 1e-12);
  }
}

TEST(PayloadStep, IsToldOfTheFittedInertia) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "row 500");
  Point point;
  for (const BaseTerm& t : axis.problem.terms)
    point.base.push_back(t.name == "inertia" ? std::log(2.0) : 0.0);
  point.effects = {e};
  point.amplitudes = {{0.3, 0.0}};
  // 0.3 of the stated one is 0.15 of twice of it.
  EXPECT_NEAR((*CauseNamed(kKind).parameters)({axis.problem, point, 0}).at("inertia_change_rel"), 0.15,
              1e-12);
}

TEST(PayloadStep, ItsInstantsReachOneAnotherAndStayInsideTheLog) {
  const test::KnownAxis axis;
  double last_s = 0.0;
  const std::vector<SharedEffect> grid = test::GridOf(axis, kKind);
  for (const SharedEffect& e : grid) {
    EXPECT_NEAR(e->order, 1e-3 * static_cast<double>(e->from_row), 1e-12);
    EXPECT_GT(e->order + e->low[1], 0.0);
    EXPECT_LT(e->order + e->high[1], 2.0);
    if (last_s > 0.0) {
      EXPECT_LE(e->order + e->low[1], last_s + e->high[1]) << e->label;
    }
    last_s = e->order;
    EXPECT_GT(e->low[0], -1.0) << "the inertia stays positive";
  }
  EXPECT_LT(grid.front()->order, 0.11);
  EXPECT_GT(grid.back()->order, 1.89);
}

TEST(PayloadStep, IsScoredAsTheInertiaThatCarriesIt) {
  EXPECT_EQ(test::OnGrid(test::KnownAxis(), kKind, "row 500")->as_term, "inertia");
  EXPECT_EQ(test::OnGrid(test::KnownAxis({.two_inertia = true}), kKind, "row 500")->as_term, "load_inertia");
}

TEST(PayloadStep, NoModelIsExtendedByIt) {
  EXPECT_EQ(*CauseNamed(kKind).extension, nullptr);
  const test::KnownAxis axis;
  EXPECT_TRUE(std::holds_alternative<SequenceShape>(test::DecidingProgram(axis, kKind).shape));
}

TEST(PayloadStep, ASpecimenGetsItInsideTheLog) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  const Drawn drawn = (*s.draw)(test::MachineToDrawFor(), -1.0, test::Numbers({0.5}));
  const test::Emulated emulated = test::EmulatedWith(
      (*s.effect)(drawn, test::MachineToDrawFor(), {.begin_s = 10.0, .duration_s = 100.0}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_NEAR(emulated.axis.effects.payload_step->time_s, 60.0, 1e-9)
      << "in the middle for the middle number";
  EXPECT_EQ(emulated.axis.effects.payload_step->inertia_change_rel, drawn.size);
  EXPECT_LT(drawn.size, 0.0);
}

}  // namespace
}  // namespace contour::diagnosis
