#include "analysis/recording/log_columns.h"

#include <gtest/gtest.h>

#include "config/config_error.h"

namespace contour::diagnosis {
namespace {

using Names = std::vector<std::string>;

std::string Error(const Names& header, const std::string& axis = "", const ColumnNames& names = {}) {
  try {
    FindColumns("f.csv", header, axis, names);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(LogColumns, OurSpellingInSmallAndCapitalLetters) {
  const LogColumns c = FindColumns("f", {"Motor_Angle_Rad", "TIME_S", "torque_nm", "temperature_c"}, "", {});
  EXPECT_FALSE(c.linear);
  EXPECT_EQ(c.position, 0U);
  EXPECT_EQ(c.time, 1U);
  EXPECT_EQ(c.command, 2U);
  EXPECT_EQ(c.temperature, 3U);
  EXPECT_FALSE(c.table_position || c.axis2_position || c.reference);
}

TEST(LogColumns, ForceAndPositionAreALinearAxis) {
  const LogColumns c = FindColumns("f", {"time_s", "force_N", "position_m", "reference_position_m"}, "", {});
  EXPECT_TRUE(c.linear);
  EXPECT_EQ(c.command, 1U);
  EXPECT_EQ(c.position, 2U);
  EXPECT_EQ(c.reference, 3U);
  EXPECT_TRUE(c.reference_in_m);
}

TEST(LogColumns, AUnitInBracketsIsPartOfTheName) {
  const LogColumns c =
      FindColumns("f", {"Time [s]", "torque_Nm [Nm]", "Motor angle (rad)", "Velocity [rad/s]"}, "", {});
  EXPECT_EQ(c.time, 0U);
  EXPECT_EQ(c.command, 1U);
  EXPECT_EQ(c.position, 2U);
  EXPECT_EQ(c.velocity, 3U);
  EXPECT_EQ(FindColumns("f", {"time_s", "Torque [N m]", "position [rad]"}, "", {}).command, 1U);
  // Another unit is not the same column.
  EXPECT_NE(Error({"Time [ms]", "Force [N]", "Position [m]"}).find("no column time_s; there are Time [ms]"),
            std::string::npos);
}

TEST(LogColumns, OneAxisOfSeveralAndTheOtherAsItsNeighbour) {
  const Names header = {"time_s",       "x_torque_Nm",   "x_motor_angle_rad",
                        "x_position_m", "y_torque_Nm",   "y_motor_angle_rad",
                        "y_position_m", "y_drive_state", "y_feedback_fresh"};
  const LogColumns c = FindColumns("f", header, "y", {});
  EXPECT_EQ(c.command, 4U);
  EXPECT_EQ(c.position, 5U);
  EXPECT_EQ(c.axis2_position, 3U);
  EXPECT_EQ(c.drive_state, 7U);
  EXPECT_EQ(c.fresh, 8U);
  EXPECT_NE(Error(header).find("--axis"), std::string::npos);
}

TEST(LogColumns, NamesThatAreGivenComeFirst) {
  const Names header = {"t", "time_s", "u", "force_N", "q"};
  const LogColumns c = FindColumns("f", header, "", ParseColumnNames("time_s=t,force_N=u,position_m=q"));
  EXPECT_EQ(c.time, 0U);
  EXPECT_EQ(c.command, 2U);
  EXPECT_EQ(c.position, 4U);
  EXPECT_NE(Error(header, "", ParseColumnNames("time_s=nowhere")).find("time_s=nowhere: no such column"),
            std::string::npos);
}

// Before: position_rad=q*57.3 was read and left aside where the table has a motor_angle_rad.
TEST(LogColumns, ANamedSpellingComesBeforeAnotherThatTheTableHas) {
  const Names header = {"time_s", "torque_Nm", "motor_angle_rad", "x", "reference_angle_rad"};
  const LogColumns angle = FindColumns("f", header, "", {{"position_rad", "x*0.5"}});
  ASSERT_TRUE(angle.position);
  EXPECT_EQ(angle.position->at, 3U);
  EXPECT_EQ(angle.position->factor, 0.5);
  EXPECT_FALSE(angle.position_in_m);
  const LogColumns metres =
      FindColumns("f", header, "", {{"position_m", "x"}, {"reference_position_m", "x"}});
  EXPECT_EQ(metres.position, 3U);
  EXPECT_TRUE(metres.position_in_m);
  EXPECT_FALSE(metres.linear);
  EXPECT_EQ(metres.reference, 3U);
  EXPECT_TRUE(metres.reference_in_m);
}

TEST(LogColumns, WhatIsMissingIsNamedWithWhatThereIs) {
  EXPECT_NE(Error({"time_s", "foo"}).find("neither torque_Nm nor force_N; there are time_s, foo"),
            std::string::npos);
  EXPECT_NE(Error({"torque_Nm", "motor_angle_rad"}).find("no column time_s"), std::string::npos);
  EXPECT_NE(Error({"time_s", "torque_Nm"}).find("no column motor_angle_rad"), std::string::npos);
}

TEST(ParseColumnNames, KnowsItsQuantitiesAndRefusesTheRest) {
  const ColumnNames names = ParseColumnNames("time_s=t_s,temperature_c=T");
  EXPECT_EQ(names.at("time_s"), "t_s");
  EXPECT_EQ(names.at("temperature_degC"), "T");
  for (const char* wrong : {"time_s", "=t", "time_s=", "foo=a", "time_s=a,time_s=b"})
    EXPECT_THROW(ParseColumnNames(wrong), ConfigError) << wrong;
  try {
    ParseColumnNames("torqe_Nm=u");
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean torque_Nm?"), std::string::npos) << e.what();
  }
}

TEST(LogColumns, FactorsAndNumbersOfColumns) {
  const LogColumns c = FindColumns("f", {"1", "2", "3"}, "",
                                   ParseColumnNames("time_s=1*0.001,torque_Nm=3*-2,motor_angle_rad=2"));
  EXPECT_EQ(c.time->at, 0U);
  EXPECT_DOUBLE_EQ(c.time->factor, 1e-3);
  EXPECT_EQ(c.command.at, 2U);
  EXPECT_DOUBLE_EQ(c.command.factor, -2.0);
  // A header that is called so comes first.
  EXPECT_EQ(
      FindColumns("f", {"t", "u*2", "u", "q"}, "", ParseColumnNames("time_s=t,force_N=u*2,position_m=q"))
          .command.at,
      1U);
  EXPECT_NE(Error({"t", "u", "q"}, "", ParseColumnNames("time_s=t*x")).find("no such column"),
            std::string::npos);
}

TEST(LogColumns, WhatWasCommandedComesBeforeWhatWasMeasuredUnlessOneIsNamed) {
  const Names header = {"time_s",    "position_rad",       "velocity_rad_s",
                        "current_A", "measured_torque_Nm", "torque_Nm"};
  LogColumns c = FindColumns("f", header, "", {});
  EXPECT_EQ(c.command.at, 5U);
  EXPECT_FALSE(c.measured || c.in_ampere || c.linear);
  EXPECT_EQ(*c.velocity, 2U);
  c = FindColumns("f", {header.begin(), header.end() - 1}, "", {});
  EXPECT_EQ(c.command.at, 4U);
  EXPECT_TRUE(c.measured);
  c = FindColumns("f", header, "", ParseColumnNames("current_A=current_A"));
  EXPECT_EQ(c.command.at, 3U);
  EXPECT_TRUE(c.measured && c.in_ampere);
}

TEST(LogColumns, ACurrentIsOfTheAxisThatThePositionIsOf) {
  EXPECT_TRUE(FindColumns("f", {"time_s", "current_A", "position_m"}, "", {}).linear);
  EXPECT_FALSE(FindColumns("f", {"time_s", "current_A", "position_rad"}, "", {}).linear);
}

TEST(LogColumns, ATorqueMayComeWithThePositionOfTheTableOrAVelocityAlone) {
  EXPECT_TRUE(FindColumns("f", {"time_s", "torque_Nm", "position_m"}, "", {}).position_in_m);
  const LogColumns c = FindColumns("f", {"torque_Nm", "velocity_rad_s"}, "", {}, true);
  EXPECT_FALSE(c.position || c.time);
}

}  // namespace
}  // namespace contour::diagnosis
