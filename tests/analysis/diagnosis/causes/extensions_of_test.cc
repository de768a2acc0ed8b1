#include "analysis/diagnosis/causes/extensions_of.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

TEST(ExtensionsOf, WhatIsToBeMendedExtendsNoModel) {
  EXPECT_TRUE(CanExtend("cogging"));
  EXPECT_FALSE(CanExtend("backlash"));
  EXPECT_FALSE(CanExtend("payload_step"));
  EXPECT_FALSE(CanExtend("no_such_cause"));
}

TEST(ExtensionsOf, EveryCauseIsAddedThatCanBe) {
  ExtensionsConfig e;
  e.constant_torque.emplace().torque_Nm = 0.01;
  AddCauses({test::CauseWith("constant_torque", {{"torque_Nm", 0.02}}),
             test::CauseWith("backlash", {{"gap_um", 5.0}}),
             test::CauseWith("temperature_viscosity", {{"rate_1_K", -0.02}})},
            27.0, e);
  EXPECT_NEAR(e.constant_torque->torque_Nm, 0.03, 1e-12);
  ASSERT_TRUE(e.temperature_viscosity);
  EXPECT_EQ(e.temperature_viscosity->reference_degC, 27.0) << "rates are of the log's first temperature";
}

TEST(ExtensionsOf, ALogsTemperatureIsItsFirstAndTheOneFarthestFromIt) {
  AxisLog log;
  EXPECT_EQ(TemperatureOf(log).first_degC, 20.0);
  EXPECT_EQ(TemperatureOf(log).farthest_degC, 20.0);
  log.temperature_degC = {kNone, 22.0, 23.0, kNone, 18.5, 24.0};
  EXPECT_EQ(TemperatureOf(log).first_degC, 22.0);
  EXPECT_EQ(TemperatureOf(log).farthest_degC, 18.5);
  log.temperature_degC = {kNone, kNone};
  EXPECT_EQ(TemperatureOf(log).first_degC, 20.0);
}

}  // namespace
}  // namespace contour::diagnosis
