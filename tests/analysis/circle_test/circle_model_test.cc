#include "analysis/circle_test/circle_model.h"

#include <gtest/gtest.h>

#include <cmath>

namespace contour {
namespace {

TEST(CircleAxisOf, IsTheStatedAxisWithItsExtensions) {
  ModelConfig model;
  model.mechanics = {5.0, 5e-5, 10.0, 40.0, 1100.0};
  const CircleAxis axis = CircleAxisOf("x", model);
  EXPECT_NEAR(axis.lead_m, 5e-3, 1e-12);
  EXPECT_NEAR(axis.mass_kg, 89.0, 0.1);
  EXPECT_DOUBLE_EQ(axis.stiffness_N_m, 40e6);
}

TEST(IntoModel, StatesShareItsUncertaintyAndTheWobble) {
  ModelConfig model;
  model.uncertainty["screw_stiffness_N_um"] = 0.02;
  CircleAxisFound found;
  found.motor_share = {0.2874, 0.012};
  found.wobble_seen = true;
  found.wobble_sine = {0.2e-6, 0.01e-6};
  found.wobble_cosine = {-0.1e-6, 0.01e-6};
  IntoModel(found, model);
  EXPECT_DOUBLE_EQ(model.friction.motor_share_rel, 0.287);
  EXPECT_DOUBLE_EQ(model.uncertainty.at("motor_share_rel"), 0.019);  // with that of K
  ASSERT_TRUE(model.extensions.lead_wobble);
  EXPECT_NEAR(model.extensions.lead_wobble->amplitude_um, std::hypot(0.2, 0.1), 1e-4);
  EXPECT_NEAR(model.extensions.lead_wobble->phase_rad, std::atan2(-0.1, 0.2), 1e-4);
}

TEST(IntoModel, AWaveWithinItsUncertaintyIsNone) {
  ModelConfig model;
  model.extensions.lead_wobble = LeadWobbleExtension{{0.5, 1.0, 0.0}, {}};
  CircleAxisFound found;
  found.motor_share = {-0.02, 0.02};
  found.wobble_seen = true;
  found.wobble_sine = {0.02e-6, 0.02e-6};
  IntoModel(found, model);
  EXPECT_FALSE(model.extensions.lead_wobble);
  EXPECT_EQ(model.friction.motor_share_rel, 0.0);
}

}  // namespace
}  // namespace contour
