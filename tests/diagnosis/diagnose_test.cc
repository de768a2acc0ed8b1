#include "tools/diagnosis/diagnose.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/diagnosis/hidden_axis.h"

namespace contour::diagnosis {
namespace {

TEST(Diagnose, NamesAClearConstantTorque) {
  test::HiddenOptions o;
  o.seed = 11;
  o.duration_s = 40.0;
  o.effects = {{"constant_torque", 0.1, 0.0, 0.0, 0.0}};
  const test::HiddenAxis axis = test::MakeHiddenAxis(o);
  const Diagnosis d = Diagnose(axis.log, axis.stated);
  ASSERT_FALSE(d.causes.empty());
  EXPECT_EQ(d.causes[0].kind, "constant_torque");
  EXPECT_NEAR(d.causes[0].parameters.at("torque_Nm").value, 0.1 * axis.stated.friction.Fc_plus,
              0.02 * axis.stated.friction.Fc_plus);
  EXPECT_GT(d.causes[0].heldout_gain_low, 0.0);
}

TEST(Diagnose, RefusesColumnsOfDifferentLength) {
  test::HiddenOptions o;
  o.duration_s = 5.0;
  test::HiddenAxis axis = test::MakeHiddenAxis(o);
  axis.log.position.pop_back();
  EXPECT_THROW(Diagnose(axis.log, axis.stated), std::invalid_argument);
}

}  // namespace
}  // namespace contour::diagnosis
