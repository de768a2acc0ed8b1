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
  const std::string hide = "emulator.axes.x.effects." + cogging;
  const std::string off = "estimator.cogging_rate=0";
  for (const std::string law : {"control.friction=srukf", "control.friction=linear"}) {
    const double hidden = Peak_um({law, hide, off});
    const double known = Peak_um({law, hide, "axes.x.model.extensions." + cogging, off});
    const double learnt = Peak_um({law, hide});
    EXPECT_GT(hidden, 3.0) << law;
    EXPECT_LT(learnt, 0.4 * hidden) << law;
    EXPECT_LT(known, 0.3 * hidden) << law;
  }
}

// Nothing is learnt of a motor that does not cog: what friction leaves over a turn is not the angle's.
TEST(Extensions, AMotorThatDoesNotCogIsNotMadeTo) {
  for (const std::string law : {"control.friction=srukf", "control.friction=linear"})
    EXPECT_NEAR(Peak_um({law}), Peak_um({law, "estimator.cogging_rate=0"}), 0.02) << law;
}

/// Friction along the stroke, hidden and as it is known.
struct AlongTheStroke {
  std::string hide, know;
};
AlongTheStroke FourPeriods() {
  std::string position, friction;
  for (int x = -40; x <= 40; x += 2) {
    position += (x == -40 ? "" : ", ") + std::to_string(x);
    friction += (x == -40 ? "" : ", ") +
                std::to_string(0.25 * std::sin(4.0 * 2.0 * std::numbers::pi * x / 400.0 + 0.5));
  }
  const std::string hide =
      "emulator.axes.x.effects.position_friction={amplitude_rel: 0.25, periods_per_stroke: 4, phase_rad: "
      "0.5}";
  return {hide, "axes.x.model.extensions.position_friction={position_mm: [" + position +
                    "], friction_rel: [" + friction + "]}"};
}

TEST(Extensions, FrictionAlongTheStroke) {
  const AlongTheStroke along = FourPeriods();
  for (const std::string law : {"control.friction=srukf", "control.friction=linear"}) {
    const double without = Peak_um({law});
    const double hidden = Peak_um({law, along.hide});
    const double known = Peak_um({law, along.hide, along.know});
    EXPECT_GT(hidden, 1.5) << law;
    EXPECT_LT(known - without, 0.5 * (hidden - without)) << law;
  }
}

/// Nothing but what is hidden: models that are right, with levels alike in both directions.
std::vector<std::string> RightModels() {
  std::vector<std::string> out{"control.friction=linear", "emulator.parameter_variation_rel=0"};
  for (const std::string axis : {"x", "y"}) {
    for (const char* key : {"position_amplitude_rel=0", "ripple_amplitude_rel=0"})
      out.push_back("emulator.axes." + axis + ".friction." + key);
    for (const char* key :
         {"motor_inertia_kgm2=5e-5", "table_mass_kg=10", "screw_stiffness_N_um=40", "screw_damping_Ns_m=1100",
          "friction.Fs_plus_N=50", "friction.Fs_minus_N=50", "friction.Fc_plus_N=40",
          "friction.Fc_minus_N=40", "friction.vs_mm_s=2", "friction.sigma0_N_m=5e6",
          "friction.sigma1_Ns_m=3000", "friction.sigma1_decay_mm_s=2", "friction.sigma2_Ns_m=500"})
      for (const std::string& where : {"axes." + axis + ".model.", "emulator.axes." + axis + "."})
        out.push_back(where + key);
  }
  return out;
}

// With friction by its terms along the reference the bristle has to keep its stiffness where its level is
// another one.
TEST(Extensions, FrictionOfManyPeriodsAlongTheStrokeWhereItIsLinear) {
  std::string position, friction;
  for (int x = -40; x <= 40; ++x) {
    position += (x == -40 ? "" : ", ") + std::to_string(x);
    friction += (x == -40 ? "" : ", ") +
                std::to_string(0.35 * std::sin(12.0 * 2.0 * std::numbers::pi * x / 400.0 + 0.5));
  }
  std::vector<std::string> set = RightModels();
  const double nothing = Peak_um(set);
  set.push_back(
      "emulator.axes.x.effects.position_friction={amplitude_rel: 0.35, periods_per_stroke: 12, phase_rad: "
      "0.5}");
  const double hidden = Peak_um(set);
  set.push_back("axes.x.model.extensions.position_friction={position_mm: [" + position +
                "], friction_rel: [" + friction + "]}");
  const double known = Peak_um(set);
  EXPECT_GT(hidden, 3.0 * nothing);
  EXPECT_LT(known, 1.5 * nothing);
}

// A cable pulls at the table, and what holds it there winds the screw up: led by motor or drive, it is as if
// there were none.
TEST(Extensions, ACableWindsTheScrewUp) {
  const std::vector<std::string> pull{"emulator.axes.x.effects.cable_spring={torque_at_stroke_end_Nm: 0.6}"};
  const std::string know =
      "axes.x.model.extensions.cable_spring={position_mm: [-200, 200], torque_Nm: [0.6, -0.6]}";
  for (const std::string law : {"control.friction=srukf", "control.friction=linear"})
    for (const std::vector<std::string>& drive :
         {std::vector<std::string>{}, {"axes.x.drive.mode=csp", "axes.y.drive.mode=csp"}}) {
      const auto peak_um = [&](const std::vector<std::string>& more) {
        std::vector<std::string> set = RightModels();
        set[0] = law;
        set.emplace_back("axes.x.limits.safe_travel_mm=5");  // with the cable's pull it stops later
        set.insert(set.end(), drive.begin(), drive.end());
        set.insert(set.end(), more.begin(), more.end());
        return Peak_um(set);
      };
      const double nothing = peak_um({});
      const double hidden = peak_um(pull);
      const double known = peak_um({pull[0], know});
      EXPECT_GT(hidden, 1.5 * nothing) << law << drive.size();
      EXPECT_LT(known, nothing + 0.2 * (hidden - nothing)) << law << drive.size();
    }
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
