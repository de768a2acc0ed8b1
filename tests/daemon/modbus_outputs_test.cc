#include "daemon/modbus_outputs.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>

#include "daemon/output_words.h"
#include "drivers/modbus/modbus_connection.h"
#include "tests/drivers/modbus/modbus_server.h"

namespace contour {
namespace {

class ModbusOutputsTest : public ::testing::Test {
 protected:
  ModbusOutputsTest() : connection_("127.0.0.1", server_.port(), 1, 2000), writer_(std::chrono::hours(1)) {
    connection_.Connect();
  }
  static ProgramOutputsConfig Config() {
    ProgramOutputsConfig c;
    c.spindle_forward = ProgramCoilConfig{1, 0.0};
    c.spindle_backward = ProgramCoilConfig{2, 0.0};
    c.spindle_speed = SpeedRegisterConfig{0, 2.0, 10000.0, 0.0};
    c.mist = ProgramCoilConfig{3, 0.0};
    c.flood = ProgramCoilConfig{4, 0.0};
    c.tool_number = ToolRegisterConfig{1};
    c.tool_change = ToolChangeConfig{5, true, 0.0};
    return c;
  }
  static GcodeEvent Event(char letter, int code, double value) {
    GcodeEvent event;
    event.letter = letter;
    event.code = code;
    event.value = value;
    return event;
  }
  void Do(ModbusOutputs& outputs, char letter, int code, double value = 0.0) {
    outputs.Do(Event(letter, code, value));
    EXPECT_FALSE(outputs.Done()) << "before anything was written";
    Settle(outputs);
  }
  void Settle(ModbusOutputs& outputs) {
    for (int i = 0; i < 3000 && !outputs.Done(); ++i) {
      ASSERT_TRUE(writer_.Write(connection_)) << connection_.error();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  /// Coils 1 to 5, then both registers.
  [[nodiscard]] std::string State() {
    writer_.Write(connection_);
    std::string text;
    for (int i = 1; i <= 5; ++i) text += server_.Coil(i) ? std::to_string(i) : "-";
    return text + " " + std::to_string(server_.Holding(0)) + " " + std::to_string(server_.Holding(1));
  }

  test::ModbusServer server_;
  ModbusConnection connection_;
  OutputWriter writer_;
};

TEST_F(ModbusOutputsTest, EveryWordSwitchesWhatItSays) {
  ModbusOutputs outputs(Config(), writer_);
  EXPECT_EQ(State(), "----- 0 0");
  Do(outputs, 'S', 0, 1200);
  EXPECT_EQ(State(), "----- 2400 0");
  Do(outputs, 'M', 3);
  EXPECT_EQ(State(), "1---- 2400 0");
  Do(outputs, 'M', 4);
  EXPECT_EQ(State(), "-2--- 2400 0") << "one direction only";
  Do(outputs, 'M', 7);
  Do(outputs, 'M', 8);
  EXPECT_EQ(State(), "-234- 2400 0");
  Do(outputs, 'T', 0, 12);
  Do(outputs, 'M', 6, 12);
  EXPECT_EQ(State(), "-2345 2400 12");
  outputs.Over(Event('M', 6, 12));
  EXPECT_EQ(State(), "-234- 2400 12");
  Do(outputs, 'M', 9);
  EXPECT_EQ(State(), "-2--- 2400 12");
  Do(outputs, 'M', 5);
  EXPECT_EQ(State(), "----- 2400 12");
  Do(outputs, 'M', 3);
  outputs.Off();
  EXPECT_EQ(State(), "----- 0 12");
}

TEST_F(ModbusOutputsTest, AToolThatIsChangedWithoutTheOperatorHasItsTime) {
  ProgramOutputsConfig config = Config();
  config.tool_change->hold = false;
  config.tool_change->settle_s = 0.05;
  ModbusOutputs outputs(config, writer_);
  outputs.Do(Event('M', 6, 3));
  ASSERT_TRUE(writer_.Write(connection_));
  EXPECT_TRUE(server_.Coil(5));
  Settle(outputs);
  EXPECT_EQ(State(), "----- 0 0");
}

TEST_F(ModbusOutputsTest, OnlyWhatIsMappedListens) {
  ProgramOutputsConfig config;
  config.flood = ProgramCoilConfig{4, 0.0};
  for (const int code : {0, 1, 3, 4, 5, 6, 7}) EXPECT_FALSE(Listens(config, Event('M', code, 0))) << code;
  EXPECT_TRUE(Listens(config, Event('M', 8, 0)));
  EXPECT_TRUE(Listens(config, Event('M', 9, 0)));
  EXPECT_FALSE(Listens(config, Event('S', 0, 100)));
  ModbusOutputs outputs(config, writer_);
  Do(outputs, 'M', 8);
  EXPECT_EQ(State(), "---4- 0 0");
}

TEST(OutputWordsTest, WhatAnOutputCannotDoIsRefused) {
  ProgramOutputsConfig config;
  config.spindle_speed = SpeedRegisterConfig{0, 1.0, 6000.0, 0.0};
  config.tool_number = ToolRegisterConfig{1};
  GcodeEvent speed;
  speed.letter = 'S';
  speed.value = 6001;
  EXPECT_NE(Problem(config, speed).find("largest_rpm, 6000"), std::string::npos);
  speed.value = 6000;
  EXPECT_EQ(Problem(config, speed), "");
  GcodeEvent tool;
  tool.letter = 'T';
  for (const double value : {1.5, -1.0, 70000.0}) {
    tool.value = value;
    EXPECT_NE(Problem(config, tool), "") << value;
  }
}

}  // namespace
}  // namespace contour
