#include "drivers/modbus/io_client.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>

#include "tests/drivers/modbus/modbus_server.h"
#include "tests/support/eventually.h"

namespace contour {
namespace {

std::int64_t Now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

using test::Eventually;

class IoClientTest : public ::testing::Test {
 protected:
  ModbusConfig Config() const {
    ModbusConfig c;
    c.host = "127.0.0.1";
    c.port = server_.port();
    c.poll_ms = 2;
    c.timeout_ms = 200;
    c.inputs.emergency_stop = 3;
    c.inputs.enable_chain = 5;
    c.inputs.screw_temperature = TemperatureInputConfig{2, 0.1, -1.0};
    return c;
  }
  /// A sample taken after this call has been stored.
  static bool PolledAgain(const IoClient& client) {
    const std::uint64_t seen = client.stats().polls;
    return Eventually([&] { return client.stats().polls >= seen + 2; });
  }

  test::ModbusServer server_;
};

TEST_F(IoClientTest, ReadsInputsAndTemperature) {
  server_.SetInput(3, true);
  server_.SetRegister(2, -45);
  IoClient client(Config());
  client.Start();
  ASSERT_TRUE(PolledAgain(client));
  IoInput io = client.Read(Now_ns());
  EXPECT_TRUE(io.configured);
  EXPECT_TRUE(io.emergency_stop_ok);
  EXPECT_FALSE(io.enable_chain_ok);
  EXPECT_DOUBLE_EQ(io.screw_temperature_degC, -5.5);

  server_.SetInput(3, false);
  server_.SetInput(5, true);
  ASSERT_TRUE(PolledAgain(client));
  io = client.Read(Now_ns());
  EXPECT_FALSE(io.emergency_stop_ok);
  EXPECT_TRUE(io.enable_chain_ok);
}

TEST_F(IoClientTest, NothingIsPermittedBeforeTheFirstPoll) {
  const IoClient client(Config());
  const IoInput io = client.Read(Now_ns());
  EXPECT_TRUE(io.configured);
  EXPECT_FALSE(io.fresh);
  EXPECT_FALSE(io.emergency_stop_ok);
  EXPECT_FALSE(io.enable_chain_ok);
  EXPECT_TRUE(std::isnan(io.screw_temperature_degC));
}

TEST_F(IoClientTest, OldDataCountAsOpen) {
  server_.SetInput(3, true);
  server_.SetInput(5, true);
  IoClient client(Config());
  client.Start();
  ASSERT_TRUE(PolledAgain(client));
  client.Stop();
  const std::int64_t now = Now_ns();
  // The loop's time decides: the same sample a time-out later is old.
  EXPECT_FALSE(client.Read(now + 201'000'000).fresh);
  EXPECT_FALSE(client.Read(now + 201'000'000).emergency_stop_ok);
  EXPECT_FALSE(client.Read(now + 201'000'000).enable_chain_ok);
}

// A host that is busy for seconds holds up the polls and the cycle alike, and in lock-step no time has gone
// by.
TEST_F(IoClientTest, InLockstepWhatWasPolledHoldsUntilPollsFail) {
  server_.SetInput(3, true);
  server_.SetInput(5, true);
  ModbusConfig held_up = Config();
  held_up.poll_ms = 60'000;
  IoClient slow(held_up);
  EXPECT_FALSE(slow.ReadInLockstep().fresh);
  slow.Start();
  ASSERT_TRUE(Eventually([&] { return slow.stats().polls > 0 && !slow.Read(Now_ns()).fresh; }));
  EXPECT_TRUE(slow.ReadInLockstep().fresh) << "a poll that was held up is none that failed";
  EXPECT_TRUE(slow.ReadInLockstep().emergency_stop_ok);
  slow.Stop();

  IoClient client(Config());
  client.Start();
  ASSERT_TRUE(PolledAgain(client));
  server_.SetMute(true);
  ASSERT_TRUE(Eventually([&] { return !client.ReadInLockstep().fresh; }));
  EXPECT_FALSE(client.ReadInLockstep().emergency_stop_ok);
  EXPECT_FALSE(client.ReadInLockstep().enable_chain_ok);
  server_.SetMute(false);
  EXPECT_TRUE(Eventually([&] { return client.ReadInLockstep().enable_chain_ok; }));
}

TEST_F(IoClientTest, AMuteServerIsLostDataAndAFailureAndComesBack) {
  server_.SetInput(3, true);
  server_.SetInput(5, true);
  IoClient client(Config());
  client.Start();
  ASSERT_TRUE(Eventually([&] { return client.Read(Now_ns()).emergency_stop_ok; }));
  server_.SetMute(true);
  ASSERT_TRUE(Eventually([&] { return !client.Read(Now_ns()).fresh; }));
  ASSERT_TRUE(Eventually([&] { return client.stats().failures > 0; }));
  EXPECT_FALSE(client.Read(Now_ns()).emergency_stop_ok);
  EXPECT_NE(client.stats().last_error.find("timed out"), std::string::npos) << client.stats().last_error;
  server_.SetMute(false);
  EXPECT_TRUE(Eventually([&] { return client.Read(Now_ns()).enable_chain_ok; }));
}

TEST_F(IoClientTest, ConnectsAgainWhenTheServerComesBack) {
  server_.SetInput(3, true);
  IoClient client(Config());
  client.Start();
  ASSERT_TRUE(Eventually([&] { return client.Read(Now_ns()).emergency_stop_ok; }));
  server_.Stop();
  ASSERT_TRUE(Eventually([&] { return !client.Read(Now_ns()).fresh; }));
  ASSERT_TRUE(Eventually([&] { return !client.stats().connected; }));
  server_.Start();
  EXPECT_TRUE(Eventually([&] { return client.Read(Now_ns()).emergency_stop_ok; }));
  EXPECT_GE(client.stats().connections, 2u);
}

TEST_F(IoClientTest, AServerThatIsNotThereIsNoReasonToGiveUp) {
  server_.Stop();
  IoClient client(Config());
  client.Start();
  ASSERT_TRUE(Eventually([&] { return client.stats().failures >= 2; }));
  EXPECT_NE(client.stats().last_error.find("refused"), std::string::npos) << client.stats().last_error;
  server_.Start();
  EXPECT_TRUE(Eventually([&] { return client.Read(Now_ns()).fresh; }));
}

TEST_F(IoClientTest, AnAddressTheServerDoesNotHaveIsNamedAndNeverFresh) {
  ModbusConfig config = Config();
  config.inputs.enable_chain = 4711;
  IoClient client(config);
  client.Start();
  ASSERT_TRUE(Eventually([&] { return client.stats().failures >= 2; }));
  EXPECT_NE(client.stats().last_error.find("4711"), std::string::npos) << client.stats().last_error;
  EXPECT_TRUE(client.stats().connected) << "an exception is an answer";
  EXPECT_FALSE(client.Read(Now_ns()).fresh);
}

TEST_F(IoClientTest, InputsThatAreNotWiredTakeNothingAway) {
  ModbusConfig config = Config();
  config.inputs.emergency_stop.reset();
  config.inputs.screw_temperature.reset();
  server_.SetInput(5, true);
  IoClient client(config);
  client.Start();
  ASSERT_TRUE(PolledAgain(client));
  const IoInput io = client.Read(Now_ns());
  EXPECT_TRUE(io.emergency_stop_ok);
  EXPECT_TRUE(io.enable_chain_ok);
  EXPECT_TRUE(std::isnan(io.screw_temperature_degC));
}

TEST_F(IoClientTest, LubricatesAfterTravelAndSwitchesOffWhenStopped) {
  ModbusConfig config = Config();
  config.outputs.lubrication = LubricationConfig{7, 0.5, 0.0, 3600.0};
  IoClient client(config);
  client.Start();
  client.ReportMotion(0.4, 10.0);
  ASSERT_TRUE(PolledAgain(client));
  EXPECT_FALSE(server_.Coil(7));
  client.ReportMotion(0.6, 11.0);
  EXPECT_TRUE(Eventually([&] { return server_.Coil(7); }));
  EXPECT_EQ(client.stats().lubrication_pulses, 1u);
  client.Stop();
  EXPECT_FALSE(server_.Coil(7));
}

TEST(LubricationTest, PulsesByTravelOrByTimeInMotion) {
  Lubrication lubrication(LubricationConfig{0, 10.0, 60.0, 2.0});
  constexpr std::int64_t s = 1'000'000'000;
  EXPECT_FALSE(lubrication.Update(9.9, 0.0, 0));
  EXPECT_TRUE(lubrication.Update(10.0, 0.0, 1 * s));
  EXPECT_TRUE(lubrication.Update(10.0, 1.0, 2 * s));
  EXPECT_FALSE(lubrication.Update(10.0, 2.0, 3 * s));
  EXPECT_FALSE(lubrication.Update(12.0, 59.0, 4 * s));
  EXPECT_TRUE(lubrication.Update(12.0, 60.0, 5 * s)) << "by time";
  EXPECT_FALSE(lubrication.Update(21.9, 60.0, 8 * s)) << "travel counts from the last pulse";
  EXPECT_TRUE(lubrication.Update(22.0, 60.0, 9 * s));
  EXPECT_EQ(lubrication.pulses(), 3u);
}

TEST(LubricationTest, TriggersAtZeroAreOff) {
  Lubrication lubrication(LubricationConfig{0, 0.0, 0.0, 2.0});
  EXPECT_FALSE(lubrication.Update(1e6, 1e6, 0));
}

TEST(IoSnapshotTest, KeepsEveryPartAndRoundsTimeDown) {
  IoSnapshot snapshot;
  EXPECT_FALSE(snapshot.Load().taken);
  for (const bool stop : {false, true}) {
    for (const bool chain : {false, true}) {
      for (const std::int16_t counts : {std::int16_t{-32768}, std::int16_t{-1}, std::int16_t{32767}}) {
        snapshot.Store({123'456'789'012'345, stop, chain, counts, true});
        const IoSample s = snapshot.Load();
        EXPECT_TRUE(s.taken);
        EXPECT_EQ(s.emergency_stop_closed, stop);
        EXPECT_EQ(s.enable_chain_closed, chain);
        EXPECT_EQ(s.temperature_counts, counts);
        EXPECT_EQ(s.time_ns, 123'456'789'000'000);
      }
    }
  }
}

TEST(ModbusConfigTest, ATimeOutShorterThanTwoPollsIsAProblem) {
  ModbusConfig config;
  EXPECT_EQ(Problem(config), "");
  config.timeout_ms = 30;
  EXPECT_NE(Problem(config), "");
}

}  // namespace
}  // namespace contour
