#include "daemon/telemetry/cycle_csv.h"

#include <gtest/gtest.h>

#include <charconv>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace contour {
namespace {

std::vector<std::string> Split(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line) {
    if (c == '\n') break;
    if (c == ',') {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

class CycleCsvTest : public ::testing::Test {
 protected:
  std::map<std::string, std::string> Fields() const {
    std::string row;
    csv_.AppendRow(record_, timing_, row);
    EXPECT_EQ(row.back(), '\n');
    const auto names = Split(csv_.Header());
    const auto values = Split(row);
    EXPECT_EQ(names.size(), values.size());
    std::map<std::string, std::string> fields;
    for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) {
      EXPECT_TRUE(fields.emplace(names[i], values[i]).second) << names[i] << " occurs twice";
    }
    return fields;
  }

  std::vector<std::string> names_{"x", "y"};
  CycleCsv csv_{names_, 1000};
  CycleRecord record_;
  CycleTiming timing_;
};

double Parse(const std::string& text) {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

TEST_F(CycleCsvTest, OnlyTheColumnsAskedForInTheirOrder) {
  const std::vector<std::string> wanted{"y_torque_Nm", "state", "cycle"};
  const CycleCsv csv(names_, 1000, wanted);
  record_.cycle = 4;
  record_.state = MachineState::kRunning;
  record_.axes.resize(2);
  record_.axes[1].torque_Nm = -0.2;
  std::string row;
  csv.AppendRow(record_, timing_, row);
  EXPECT_EQ(csv.Header() + row, "y_torque_Nm,state,cycle\n-0.2,Running,4\n");
  const std::vector<std::string> none{"z_torque_Nm"};
  EXPECT_THROW(CycleCsv(names_, 1000, none), std::invalid_argument);
}

TEST_F(CycleCsvTest, PutsEveryAxisInItsOwnColumnsWithUnits) {
  record_.cycle = 4;
  record_.state = MachineState::kRunning;
  record_.axes.resize(2);
  record_.axes[0].torque_Nm = 0.1;
  record_.axes[1].torque_Nm = -0.2;
  record_.axes[1].feedback.position_rad = 3.5;
  timing_.sent_ns = 123456;
  const auto f = Fields();
  EXPECT_EQ(f.at("time_s"), "0.003");
  EXPECT_EQ(f.at("state"), "Running");
  EXPECT_EQ(f.at("x_torque_Nm"), "0.1");
  EXPECT_EQ(f.at("y_torque_Nm"), "-0.2");
  EXPECT_EQ(f.at("y_motor_angle_rad"), "3.5");
  EXPECT_EQ(f.at("sent_us"), "123.456");
}

TEST_F(CycleCsvTest, NumbersReadBackAsTheSameValue) {
  record_.axes.resize(2);
  for (const double value : {0.1 + 0.2, 1.0 / 3.0, 5e-324, 1.7976931348623157e308, -0.0, 4.8e-9}) {
    record_.axes[0].position_m = value;
    EXPECT_EQ(Parse(Fields().at("x_position_m")), value);
  }
}

TEST_F(CycleCsvTest, LeavesWhatDoesNotExistEmpty) {
  record_.axes.resize(2);
  record_.axes[0].feedback.table_position_m = 0.25;
  record_.io.screw_temperature_degC = 31.5;
  auto f = Fields();
  EXPECT_EQ(f.at("x_table_position_m"), "");
  EXPECT_EQ(f.at("temperature_degC"), "");
  EXPECT_EQ(f.at("reason_axis"), "");

  record_.axes[0].feedback.has_scale = true;
  record_.io.configured = true;
  record_.reason_axis = 1;
  f = Fields();
  EXPECT_EQ(f.at("x_table_position_m"), "0.25");
  EXPECT_EQ(f.at("temperature_degC"), "31.5");
  EXPECT_EQ(f.at("reason_axis"), "1");

  record_.io.screw_temperature_degC = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(Fields().at("temperature_degC"), "");
}

TEST_F(CycleCsvTest, WritesAxesThatARecordLacksAsZeros) {
  record_.axes.resize(1);
  EXPECT_EQ(Fields().at("y_torque_Nm"), "0");
}

}  // namespace
}  // namespace contour
