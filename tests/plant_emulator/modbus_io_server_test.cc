#include "tools/plant_emulator/modbus_io_server.h"

#include <gtest/gtest.h>
#include <modbus.h>

#include <chrono>
#include <memory>
#include <thread>

#include "core/exit_status.h"

namespace contour {
namespace {

/// A server on the first free port from 21502 on; tests may run side by side.
std::unique_ptr<ModbusIoServer> Serve() {
  EmulatedIoConfig config;
  for (config.port = 21502; config.port < 21602; ++config.port) {
    try {
      return std::make_unique<ModbusIoServer>(config);
    } catch (const EnvironmentError&) {
    }
  }
  return nullptr;
}

class ModbusIo : public ::testing::Test {
 protected:
  void SetUp() override {
    server = Serve();
    ASSERT_NE(server, nullptr);
    client = Connect();
  }
  void TearDown() override {
    modbus_close(client);
    modbus_free(client);
  }
  modbus_t* Connect() const {
    modbus_t* c = modbus_new_tcp("127.0.0.1", server->port());
    EXPECT_EQ(modbus_connect(c), 0);
    return c;
  }
  int Input(int address) const {
    std::uint8_t bit = 9;
    return modbus_read_input_bits(client, address, 1, &bit) == 1 ? bit : -1;
  }

  std::unique_ptr<ModbusIoServer> server;
  modbus_t* client = nullptr;
};

TEST_F(ModbusIo, CircuitsAreClosedUntilAButtonOpensThem) {
  EXPECT_EQ(Input(0), 1);
  EXPECT_EQ(Input(1), 1);
  ASSERT_EQ(modbus_write_bit(client, 100, 1), 1);
  EXPECT_EQ(Input(0), 0);
  EXPECT_EQ(Input(1), 1);
  ASSERT_EQ(modbus_write_bit(client, 100, 0), 1);
  ASSERT_EQ(modbus_write_bit(client, 101, 1), 1);
  EXPECT_EQ(Input(0), 1);
  EXPECT_EQ(Input(1), 0);
  server->OpenEnableChain(false);
  EXPECT_EQ(Input(1), 1);
}

TEST_F(ModbusIo, AButtonReleasedWhileARequestIsServedStaysReleased) {
  for (int i = 0; i < 300; ++i) {
    server->OpenEnableChain(true);
    ASSERT_EQ(Input(1), 0) << i;     // the server may still be busy with this request ...
    server->OpenEnableChain(false);  // ... and must not put back what it showed there
    ASSERT_EQ(Input(1), 1) << i;
  }
}

TEST_F(ModbusIo, TemperatureComesInTenthsSigned) {
  std::uint16_t value = 0;
  server->SetTemperature_degC(23.46);
  ASSERT_EQ(modbus_read_input_registers(client, 0, 1, &value), 1);
  EXPECT_EQ(value, 235);
  server->SetTemperature_degC(-4.0);
  ASSERT_EQ(modbus_read_input_registers(client, 0, 1, &value), 1);
  EXPECT_EQ(static_cast<std::int16_t>(value), -40);
}

TEST_F(ModbusIo, LubricationIsSeen) {
  EXPECT_FALSE(server->lubrication());
  ASSERT_EQ(modbus_write_bit(client, 0, 1), 1);
  ASSERT_EQ(Input(0), 1);  // the answer to the next request comes after the coil has been looked at
  EXPECT_TRUE(server->lubrication());
}

TEST_F(ModbusIo, BadAddressIsAnExceptionNotTheEnd) {
  std::uint8_t bit = 0;
  EXPECT_EQ(modbus_read_input_bits(client, 5000, 1, &bit), -1);
  EXPECT_EQ(Input(0), 1);
}

TEST_F(ModbusIo, ServesSeveralAndSurvivesWhoLeaves) {
  modbus_t* second = Connect();
  std::uint8_t bit = 0;
  ASSERT_EQ(modbus_read_input_bits(second, 0, 1, &bit), 1);
  modbus_close(second);
  EXPECT_EQ(Input(0), 1);
  ASSERT_EQ(modbus_connect(second), 0);
  EXPECT_EQ(modbus_read_input_bits(second, 0, 1, &bit), 1);
  modbus_close(second);
  modbus_free(second);
}

TEST_F(ModbusIo, OccupiedPortIsNamed) {
  EmulatedIoConfig config;
  config.port = server->port();
  try {
    ModbusIoServer other(config);
    FAIL() << "listened on a port that is taken";
  } catch (const EnvironmentError& e) {
    EXPECT_NE(std::string(e.what()).find(std::to_string(config.port)), std::string::npos);
  }
}

}  // namespace
}  // namespace contour
