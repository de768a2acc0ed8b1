#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/closed_loop/test_machine.h"
#include "tests/support/allocation_guard.h"

// A machine with an effect that its model does not know, and with a model extended by it.
namespace contour::test {
namespace {

const Program kLarge = Circle(10.0, 3, 0.7957747155);  // 3 m/min

double Peak_um(const std::vector<std::string>& overrides) {
  return 1e6 * RunCircle(ExampleMachine(overrides), ControllerName::kFull, kLarge).table_peak_m;
}

TEST(Extensions, CoggingOfThreePerCentOfRatedTorque) {
  const std::string cogging = "cogging={amplitude_Nm: 0.0191, order_per_rev: 12, phase_rad: 0.7}";
  const std::string off = "estimator.cogging_rate=0";
  const double hidden = Peak_um({"emulator.axes.x.effects." + cogging, off});
  const double known =
      Peak_um({"emulator.axes.x.effects." + cogging, "axes.x.model.extensions." + cogging, off});
  const double learnt = Peak_um({"emulator.axes.x.effects." + cogging});
  EXPECT_GT(hidden, 3.0);
  EXPECT_LT(learnt, 0.4 * hidden);
  EXPECT_LT(known, 0.3 * hidden);
}

TEST(Extensions, FrictionAlongTheStroke) {
  std::string position, friction;
  for (int x = -40; x <= 40; x += 2) {
    position += (x == -40 ? "" : ", ") + std::to_string(x);
    friction += (x == -40 ? "" : ", ") +
                std::to_string(0.25 * std::sin(4.0 * 2.0 * std::numbers::pi * x / 400.0 + 0.5));
  }
  const std::string hide =
      "emulator.axes.x.effects.position_friction={amplitude_rel: 0.25, periods_per_stroke: 4, phase_rad: "
      "0.5}";
  const double hidden = Peak_um({hide});
  const double known = Peak_um({hide, "axes.x.model.extensions.position_friction={position_mm: [" + position +
                                          "], friction_rel: [" + friction + "]}"});
  EXPECT_GT(hidden, 1.5);
  EXPECT_LT(known, 0.5 * hidden);
}

TEST(Extensions, PitchErrorIsTakenOutAtTheTable) {
  std::string position, error;
  for (int x = -40; x <= 40; x += 4) {
    position += (x == -40 ? "" : ", ") + std::to_string(x);
    error +=
        (x == -40 ? "" : ", ") + std::to_string(6.0 * std::sin(4.0 * 2.0 * std::numbers::pi * x / 400.0));
  }
  const std::string hide = "emulator.axes.x.effects.pitch_error={amplitude_um: 6, periods_per_stroke: 4}";
  const double hidden = Peak_um({hide});
  const double known = Peak_um({hide, "axes.x.model.extensions.pitch_error={position_mm: [" + position +
                                          "], error_um: [" + error + "]}"});
  EXPECT_GT(hidden, 2.0);
  EXPECT_LT(known, 0.6 * hidden);
}

TEST(Extensions, TheEstimatorStillAllocatesNothing) {
  if (!AllocationGuard::kAvailable) GTEST_SKIP() << "the sanitizer owns the heap";
  const AxisConfig x = ExampleMachine().machine.axes.at("x");
  const Mechanics mechanics = ToSi(x.model.mechanics);
  ExtensionsConfig extensions;
  extensions.cogging = CoggingExtension{{0.02, 12, 0}, {}};
  extensions.position_friction = PositionFrictionExtension{0, {-1, 1}, {0.1, 0.2}};
  AxisEstimator estimator(EstimatorKind::kFull, mechanics, x.model.friction, {}, 1e-3, 2e-4, 0.0,
                          KnownEffects(extensions, mechanics, 500.0));
  estimator.Reset(0.0);
  AxisHorizon horizon(23);
  FrictionPreview preview;
  AxisEstimatorInput input;
  input.enabled = input.fresh = true;
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    estimator.Update(input);
    estimator.PreviewFriction(horizon, horizon.size(), preview);
  }
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace
}  // namespace contour::test
