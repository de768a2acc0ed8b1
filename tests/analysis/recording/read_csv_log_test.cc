#include "analysis/recording/read_log.h"

#include <gtest/gtest.h>

#include <cmath>

#include "config/config_error.h"
#include "tests/config/test_files.h"

namespace contour::diagnosis {
namespace {

std::string Error(const std::string& file, const ReadOptions& options = {}) {
  try {
    ReadLog(file, options);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(ReadCsvLog, TableWithMissingRowsGoesToItsGrid) {
  const std::string file =
      WriteTestFile("log.csv",
                    "# a comment\ntime_s,torque_nm,motor_angle_rad,temperature_c\n"
                    "5.000,0.1,1.0,20\n5.001,0.2,1.1,\n5.004,0.3,1.4,21\n5.005,0.4,1.5,21\n");
  const AxisLog log = ReadLog(file, {});
  EXPECT_FALSE(log.linear);
  EXPECT_DOUBLE_EQ(log.period_s, 1e-3);
  EXPECT_EQ(log.rows, 4u);
  EXPECT_EQ(log.missing, 2u);
  EXPECT_EQ(log.present, (std::vector<std::uint8_t>{1, 1, 0, 0, 1, 1}));
  EXPECT_EQ(log.command, (std::vector<double>{0.1, 0.2, 0.2, 0.2, 0.3, 0.4}));
  EXPECT_TRUE(std::isnan(log.position[2]));
  EXPECT_DOUBLE_EQ(log.position[4], 1.4);
  EXPECT_EQ(log.temperature_degC, (std::vector<double>{20, 20, 20, 20, 21, 21}));
  EXPECT_TRUE(log.table_position_m.empty());
}

TEST(ReadCsvLog, NamesOfColumnsCanBeGiven) {
  const std::string file =
      WriteTestFile("emps.csv", "t_s;qg_m;qm_m;u\n0;0.1;0.2;3\n0.00100002;0.11;0.21;4\n0.002;0.12;0.22;5\n");
  const AxisLog log = ReadLog(
      file, {.columns = ParseColumnNames("time_s=t_s,force_n=u,position_m=qm_m,reference_position_m=qg_m")});
  EXPECT_TRUE(log.linear);
  EXPECT_EQ(log.command, (std::vector<double>{3, 4, 5}));
  EXPECT_EQ(log.position, (std::vector<double>{0.2, 0.21, 0.22}));
  EXPECT_EQ(log.reference_position, (std::vector<double>{0.1, 0.11, 0.12}));
  EXPECT_THROW(ParseColumnNames("time=t"), ConfigError);
  EXPECT_THROW(ParseColumnNames("time_s"), ConfigError);
}

TEST(ReadCsvLog, OurOwnTableOfSeveralAxesNeedsAName) {
  const std::string file = WriteTestFile("cycles.csv",
                                         "time_s,x_motor_angle_rad,x_torque_Nm,x_position_m,x_drive_state,y_"
                                         "motor_angle_rad,y_torque_Nm,y_position_m\n"
                                         "0,1,2,3,Switched On,5,6,7\n0.001,1,2,3,Operation "
                                         "Enabled,5,6,7.5\n0.002,1.5,2.5,3,Operation Enabled,5,6,8\n");
  EXPECT_NE(Error(file).find("--axis"), std::string::npos);
  const AxisLog log = ReadLog(file, {.axis = "x"});
  EXPECT_EQ(log.axis, "x");
  EXPECT_FALSE(log.linear);
  EXPECT_EQ(log.present, (std::vector<std::uint8_t>{0, 1, 1}));
  EXPECT_EQ(log.command.back(), 2.5);
  EXPECT_EQ(log.axis2_position_m, (std::vector<double>{7, 7.5, 8}));
}

TEST(ReadCsvLog, ErrorsNameFileAndLine) {
  const auto table = [](const std::string& rows) {
    return WriteTestFile("bad.csv", "time_s,force_n,position_m\n" + rows);
  };
  EXPECT_NE(Error(table("0,1,2\n0.001,1,2\n0.001,1,2\n")).find("bad.csv:4: time_s"), std::string::npos);
  EXPECT_NE(Error(table("0,1,2\n0.001,x,2\n0.002,1,2\n")).find("bad.csv:3: force_n: found 'x'"),
            std::string::npos);
  EXPECT_NE(Error(table("0,1,2\n0.001,1\n")).find("bad.csv:3: found 2 fields"), std::string::npos);
  EXPECT_NE(
      Error(table("0,1,2\n0.001,1,2\n0.002,1,2\n0.0034,1,2\n0.004,1,2\n0.005,1,2\n")).find("off a grid"),
      std::string::npos);
  EXPECT_NE(Error(WriteTestFile("no.csv", "time_s,foo\n0,1\n")).find("neither torque_Nm nor force_N"),
            std::string::npos);
  EXPECT_NE(Error("/nowhere.csv").find("cannot be read"), std::string::npos);
}

// Before: "nothing was found" of rows a second apart, and a Python traceback.
TEST(ReadCsvLog, RowsTooSlowOrTooFastForFrictionAreRefused) {
  const auto at = [](double period_s) {
    std::string rows = "time_s,force_n,position_m\n";
    for (int k = 0; k < 20; ++k) rows += std::to_string(k * period_s) + ",1," + std::to_string(k) + "\n";
    return Error(WriteTestFile("rate.csv", rows));
  };
  EXPECT_NE(at(1.0).find("found rows at 1 Hz, expected 50 to 10000 Hz"), std::string::npos) << at(1.0);
  EXPECT_NE(at(5e-5).find("--resample 10000"), std::string::npos) << at(5e-5);
  EXPECT_EQ(at(0.02), "");
}

TEST(ReadCsvLog, ARateBesideTimesIsRefused) {
  const std::string file =
      WriteTestFile("times.csv", "time_s,force_n,position_m\n0,1,2\n0.001,1,2\n0.002,1,2\n");
  ReadOptions options;
  options.sample_rate_Hz = 500.0;
  try {
    ReadLog(file, options);
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("has times in its column time_s"), std::string::npos) << e.what();
  }
}

TEST(ReadCsvLog, QuotedNotesBesideTheNumbersAreNoTrouble) {
  const std::string file = WriteTestFile(
      "log.csv",
      "time_s,force_N,position_m,\"note, if any\"\n0,1,2,\"start, slow\"\n0.001,3,4,\n0.002,5,6,\"end\"\n");
  EXPECT_EQ(ReadLog(file, {}).command, (std::vector<double>{1, 3, 5}));
}

TEST(ReadCsvLog, AReferenceStatedAtTheTableIsSeenAtTheMotor) {
  const std::string file = WriteTestFile("log.csv",
                                         "time_s,torque_Nm,motor_angle_rad,reference_position_m\n0,1,2,0."
                                         "002\n0.001,3,4,0.004\n0.002,3,4,0.004\n");
  EXPECT_EQ(ReadLog(file, {.table_per_q = 1e-3}).reference_position, (std::vector<double>{2, 4, 4}));
}

TEST(ReadCsvLog, WithoutAnyPositionThereIsNothingToRead) {
  EXPECT_NE(Error(WriteTestFile("log.csv", "time_s,force_N,position_m\n0,1,\n0.001,1,\n0.002,1,\n"))
                .find("hold no number"),
            std::string::npos);
}

TEST(ReadCsvLog, WhatWasMeasuredActsAsTheMeanOfBothEndsOfARow) {
  const std::string file =
      WriteTestFile("log.csv", "time_s,current_A,position_rad\n0,1,0\n0.001,3,0\n0.002,7,1\n");
  const AxisLog log = ReadLog(file, {});
  EXPECT_TRUE(log.in_ampere);
  EXPECT_EQ(log.command, (std::vector<double>{2, 5, 7}));
}

TEST(ReadCsvLog, AnglesThatBeginAgainGoOn) {
  std::string text = "time_s,torque_Nm,position_rad\n";
  for (int i = 0; i < 40; ++i)
    text += std::to_string(1e-3 * i) + ",0," + std::to_string(std::fmod(5.0 + 0.25 * i, 6.283185307)) + "\n";
  const AxisLog log = ReadLog(WriteTestFile("log.csv", text), {});
  for (std::size_t k = 0; k < log.size(); ++k)
    EXPECT_NEAR(log.position[k], 5.0 + 0.25 * static_cast<double>(k), 1e-5);
}

TEST(ReadCsvLog, AVelocityOfAnotherUnitOrSignIsRefused) {
  const auto table = [](double factor) {
    std::string text = "time_s,torque_Nm,position_rad,velocity_rad_s\n";
    for (int i = 0; i < 100; ++i)
      text += std::to_string(1e-3 * i) + ",0," + std::to_string(std::sin(0.1 * i)) + "," +
              std::to_string(factor * 100.0 * std::cos(0.1 * i)) + "\n";
    return WriteTestFile("log.csv", text);
  };
  EXPECT_EQ(Error(table(1.0)), "");
  EXPECT_NE(Error(table(57.3)).find("velocity is 6"), std::string::npos);
  EXPECT_NE(Error(table(-1.0)).find("-1"), std::string::npos);
}

// Before: a scale that stood still, or read in mm, was a pitch error of the whole stroke.
TEST(ReadCsvLog, AScaleOfAnotherUnitSignOrAxisIsRefused) {
  const auto error = [](double factor, double lead_m = 0.0, double reach = 4.0) {
    const double per_rad = lead_m / (2.0 * M_PI);
    std::string text = lead_m > 0.0 ? "time_s,torque_Nm,position_rad,table_position_m\n"
                                    : "time_s,force_N,position_m,table_position_m\n";
    for (int i = 0; i < 100; ++i) {
      const double q = 0.5 + reach * std::sin(0.1 * i);
      text += std::to_string(1e-3 * i) + ",0," + (i == 0 ? "" : std::to_string(q)) + "," +
              std::to_string(7.0 + factor * (lead_m > 0.0 ? 1e3 * per_rad * q : q)) + "\n";
    }
    return Error(WriteTestFile("log.csv", text), {.table_per_q = lead_m > 0.0 ? 1e3 * per_rad : 1.0});
  };
  EXPECT_EQ(error(1.0), "");
  EXPECT_EQ(error(1.01), "");
  EXPECT_EQ(error(1.0, 5e-3), "");
  EXPECT_NE(error(0.0).find("reads 0 times"), std::string::npos);
  EXPECT_NE(error(1e3).find("reads 1000 times"), std::string::npos);
  EXPECT_NE(error(-1.0).find("another sign"), std::string::npos);
  EXPECT_NE(error(2.0, 5e-3).find("the lead another one"), std::string::npos);
  // Of half a turn a gap may take a lot.
  EXPECT_EQ(error(0.7, 5e-3, 1.5), "");
}

TEST(ReadCsvLog, AVelocityAloneIsIntegrated) {
  const std::string file = WriteTestFile("log.csv", "torque_Nm,velocity_rad_s\n0,2\n0,4\n0,4\n");
  const AxisLog log = ReadLog(file, {.sample_rate_Hz = 100.0});
  EXPECT_DOUBLE_EQ(log.period_s, 0.01);
  EXPECT_NEAR(log.position[2], 0.07, 1e-12);
}

}  // namespace
}  // namespace contour::diagnosis
