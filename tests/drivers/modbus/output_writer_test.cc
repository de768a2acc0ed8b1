#include "drivers/modbus/output_writer.h"

#include <gtest/gtest.h>

#include <chrono>

#include "drivers/modbus/io_client.h"
#include "tests/drivers/modbus/modbus_server.h"
#include "tests/support/eventually.h"

namespace contour {
namespace {

using test::Eventually;

class OutputWriterTest : public ::testing::Test {
 protected:
  ModbusConfig Config(double silence_s = 60.0) const {
    ModbusConfig c;
    c.host = "127.0.0.1";
    c.port = server_.port();
    c.poll_ms = 2;
    c.timeout_ms = 200;
    c.outputs.program.emplace();
    c.outputs.program->silence_s = silence_s;
    return c;
  }
  static OutputImage Image(bool spindle, std::uint16_t speed, std::uint16_t tool) {
    OutputImage image;
    image.coils[4] = spindle;
    image.coils[5] = false;
    image.registers[2] = {speed, false};
    image.registers[3] = {tool, true};
    return image;
  }
  static bool Written(OutputWriter& writer, std::uint64_t number) {
    return Eventually([&] { return writer.written() >= number; });
  }

  test::ModbusServer server_;
};

TEST_F(OutputWriterTest, WhatIsWantedStandsAtTheServerWhenItSaysSo) {
  IoClient client(Config());
  client.Start();
  ASSERT_TRUE(Written(*client.outputs(), client.outputs()->Want(Image(true, 900, 7))));
  EXPECT_TRUE(server_.Coil(4));
  EXPECT_FALSE(server_.Coil(5));
  EXPECT_EQ(server_.Holding(2), 900);
  EXPECT_EQ(server_.Holding(3), 7);
  ASSERT_TRUE(Written(*client.outputs(), client.outputs()->Want(Image(true, 900, 7).Off())));
  EXPECT_FALSE(server_.Coil(4));
  EXPECT_EQ(server_.Holding(2), 0);
  EXPECT_EQ(server_.Holding(3), 7) << "the tool in the spindle is the same one";
}

TEST_F(OutputWriterTest, WhatSomebodyLeftOnIsOffFromTheStart) {
  server_.SetCoil(4, true);
  IoClient client(Config());
  client.outputs()->Want(Image(false, 0, 0));
  client.Start();
  EXPECT_TRUE(Eventually([&] { return !server_.Coil(4); }));
}

TEST_F(OutputWriterTest, AServerThatForgotIsToldAgain) {
  IoClient client(Config());
  client.Start();
  ASSERT_TRUE(Written(*client.outputs(), client.outputs()->Want(Image(true, 900, 7))));
  server_.SetCoil(4, false);
  EXPECT_TRUE(Eventually([&] { return server_.Coil(4); }));
}

TEST_F(OutputWriterTest, AnEndSwitchesThemOff) {
  IoClient client(Config());
  client.Start();
  ASSERT_TRUE(Written(*client.outputs(), client.outputs()->Want(Image(true, 900, 7))));
  client.Stop();
  EXPECT_FALSE(server_.Coil(4));
  EXPECT_EQ(server_.Holding(2), 0);
}

TEST_F(OutputWriterTest, ANewConnectionIsToldEverythingAgain) {
  IoClient client(Config());
  client.Start();
  ASSERT_TRUE(Written(*client.outputs(), client.outputs()->Want(Image(true, 900, 7))));
  server_.Stop();
  server_.SetCoil(4, false);  // as a watchdog of the server's does
  ASSERT_TRUE(Eventually([&] { return !client.stats().connected; }));
  const std::uint64_t off = client.outputs()->Want(Image(true, 900, 7).Off());
  server_.SetCoil(4, true);
  server_.Start();
  ASSERT_TRUE(Written(*client.outputs(), off));
  EXPECT_FALSE(server_.Coil(4)) << "what ended while nobody could be told";
}

TEST_F(OutputWriterTest, SilenceSwitchesThemOffUntilTheyAreWantedAnew) {
  IoClient client(Config(0.1));
  client.Start();
  client.outputs()->Want(Image(true, 900, 7));
  ASSERT_TRUE(Eventually([&] { return client.outputs()->TakeSilence(); }));
  EXPECT_FALSE(client.outputs()->TakeSilence());
  client.outputs()->Confirm();
  EXPECT_TRUE(Eventually([&] { return !server_.Coil(4) && server_.Holding(2) == 0; }));
}

TEST_F(OutputWriterTest, AnAddressThatTheServerHasNotIsNeverWritten) {
  IoClient client(Config());
  client.Start();
  OutputImage image;
  image.coils[400] = true;
  const std::uint64_t number = client.outputs()->Want(image);
  const std::uint64_t polls = client.stats().polls;
  ASSERT_TRUE(Eventually([&] { return client.stats().polls > polls + 5; })) << "reading goes on";
  EXPECT_LT(client.outputs()->written(), number);
  EXPECT_NE(client.stats().last_error.find("write coil 400"), std::string::npos);
}

}  // namespace
}  // namespace contour
