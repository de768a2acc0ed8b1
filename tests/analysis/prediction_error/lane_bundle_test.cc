#include "analysis/prediction_error/lane_bundle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "analysis/prediction_error/problem.h"
#include "tests/analysis/support/distance.h"
#include "tests/analysis/support/hidden_axis.h"
#include "tests/analysis/support/scalar_predictor.h"

namespace contour::diagnosis {
namespace {

struct Shape {
  const char* name;
  bool two, on_load;
  std::function<void(AxisModel&)> change;
};

SharedSignal Wave(std::size_t size, double amplitude) {
  Signal s(size);
  for (std::size_t k = 0; k < size; ++k) s[k] = amplitude * std::sin(0.03 * static_cast<double>(k));
  return std::make_shared<const Signal>(std::move(s));
}

void WithSignals(AxisModel& m, std::size_t of_motor) {
  m.motor_force = Wave(of_motor, 0.1 * m.friction.Fc_plus);
  m.load_force = Wave(m.rows, 0.05 * m.friction.Fc_plus);
  m.level = Wave(m.rows, 0.2);
  m.viscous = Wave(m.rows, 0.3);
  m.reading_error = Wave(m.rows, 1e-5);
  m.offset = 0.03 * m.friction.Fc_plus;
}

/// What the loops can do, but for the gap, which has a test of its own.
std::vector<Shape> Shapes() {
  const auto plain = [](AxisModel&) {};
  const auto one_per_row = [](AxisModel& m) { WithSignals(m, m.rows); };
  const auto two_per_row = [](AxisModel& m) { WithSignals(m, 2 * m.rows); };
  const auto soft = [](AxisModel& m) {
    m.soft_share = 0.3;
    m.soft_ratio = 0.2;
  };
  const auto fading = [](AxisModel& m) { m.friction.vd = 0.7 * m.friction.vs; };
  const auto square = [](AxisModel& m) { m.friction.exponent = 2.0; };
  const auto rest = [](AxisModel& m) {
    m.rough = 1e-4 * m.friction.vs * m.friction.vs;
    m.torque_gain = 0.95;
    m.saturation = 0.02;
    m.start_bristle = 0.5 * m.friction.Fc_plus / m.friction.s0;
    m.lag_for_delay_s = 2e-5;
  };
  const auto payload = [](AxisModel& m) {
    m.payload = 0.2 * m.motor_inertia;
    m.payload_row = m.rows / 2;
  };
  return {{"rigid", false, false, plain},
          {"rigid, signals", false, false, one_per_row},
          {"rigid, soft", false, false, soft},
          {"rigid, fading", false, false, fading},
          {"rigid, square", false, false, square},
          {"rigid, the rest", false, false, rest},
          {"rigid, payload", false, false, payload},
          {"two", true, false, plain},
          {"two, signals", true, false, two_per_row},
          {"two, on the load", true, true, two_per_row},
          {"two, on the load, soft", true, true, soft},
          {"two, payload", true, true, payload},
          {"two, fading", true, true, fading}};
}

TEST(LaneBundle, EveryShapeRunsAsTheScalarPredictor) {
  for (const Shape& shape : Shapes()) {
    test::HiddenOptions o;
    o.duration_s = 5.0;
    o.two_inertia = shape.two;
    o.friction_on_load = shape.on_load;
    const test::HiddenAxis axis = test::MakeHiddenAxis(o);
    Problem problem(axis.log, axis.stated, 1);
    problem.setup.valid[2000] = 0;
    Point stated;
    stated.base.assign(problem.terms.size(), 0.0);
    const AxisModel without = problem.Build(stated);
    // Every lane with parameters of its own, and what is compared last among them.
    std::vector<AxisModel> models(5, without);
    for (std::size_t i = 0; i < models.size(); ++i) {
      shape.change(models[i]);
      models[i].friction.Fc_plus *= 1.0 + 0.02 * static_cast<double>(i);
      models[i].motor_inertia *= 1.0 - 0.01 * static_cast<double>(i);
    }
    const auto batched = RunFilter(problem.setup, models, 1);
    const std::vector<double> scalar = test::ScalarInnovation(problem.setup, models.back());
    const double effect =
        test::Distance(scalar, RunFilter(problem.setup, std::span(&without, 1), 1)[0].innovation);
    EXPECT_GT(effect, 0.0) << shape.name;
    EXPECT_LT(test::Distance(batched.back().innovation, scalar), 1e-6 * effect) << shape.name;
  }
}

TEST(LaneBundle, ModelsThatAreMissingRepeatTheLast) {
  test::HiddenOptions o;
  o.duration_s = 5.0;
  const test::HiddenAxis axis = test::MakeHiddenAxis(o);
  const Problem problem(axis.log, axis.stated, 1);
  AxisModel a = problem.nominal, b = a;
  b.friction.Fc_plus *= 2.0;
  const Delivered means = DeliveredMeans(axis.log, a.delay_s, a.lag_s, problem.setup.substeps_rigid);
  const AxisModel* models[] = {&a, &b};
  const Delivered* delivered[] = {&means, &means};
  const std::vector<double> zeros(axis.log.size(), 0.0);
  const Lanes lanes = MakeLanes(problem.setup, models, delivered, axis.log.position.data(), zeros.data());
  EXPECT_EQ(lanes.Fc_plus[0], a.friction.Fc_plus);
  for (int i = 1; i < kLanes; ++i) EXPECT_EQ(lanes.Fc_plus[i], b.friction.Fc_plus);
  EXPECT_TRUE(lanes.torque.alike);
  EXPECT_FALSE(lanes.two || lanes.soft || lanes.gap || lanes.payload);
}

TEST(LaneBundle, AStretchBeginsWhereItIsKept) {
  test::HiddenOptions o;
  o.duration_s = 5.0;
  const test::HiddenAxis axis = test::MakeHiddenAxis(o);
  const Problem problem(axis.log, axis.stated, 1);
  const AxisModel* models[] = {&problem.nominal};
  const Delivered means = DeliveredMeans(axis.log, 1e-3, 2e-4, problem.setup.substeps_rigid);
  const Delivered* delivered[] = {&means};
  const std::vector<double> zeros(axis.log.size(), 0.0);
  std::vector<double> out(100);
  Lanes lanes = MakeLanes(problem.setup, models, delivered, axis.log.position.data(), zeros.data());
  lanes.innovation[0] = out.data();
  const Lanes part = Over(lanes, {.from = 1000, .rows = 50, .at = 20, .start_q = 1.5, .start_w = 2.5});
  EXPECT_EQ(part.rows, 50U);
  EXPECT_EQ(part.measured, lanes.measured + 1000);
  EXPECT_EQ(part.innovation[0], out.data() + 20);
  EXPECT_EQ(part.torque.at[0], means.mean.data() + 20 * lanes.substeps);
  EXPECT_EQ(part.start_q, 1.5);
  EXPECT_EQ(part.start_w, 2.5);
}

}  // namespace
}  // namespace contour::diagnosis
