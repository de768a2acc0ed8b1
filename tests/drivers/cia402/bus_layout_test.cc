#include "drivers/cia402/bus_layout.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

std::vector<BusDrive> Drives(int n) {
  std::vector<BusDrive> drives;
  for (int i = 1; i <= n; ++i) {
    DriveConfig d;
    d.node_id = i;
    d.rated_torque_Nm = 0.637;
    d.peak_torque_Nm = 1.91;
    d.encoder_counts_per_rev = 1048576;
    d.heartbeat_ms = 100;
    drives.push_back({std::string(1, static_cast<char>('w' + i)), d});
  }
  return drives;
}

BusAnalysis Analyse(int axes, std::uint32_t cycle_us, double send_deadline_us = 0.2 * 1000) {
  return AnalyseBus(Drives(axes), BusConfig{"can0"}, cycle_us, send_deadline_us);
}

// One TPDO of 8 bytes, one RPDO of 4 bytes per axis at 1 Mbit/s.
TEST(BusLayout, OneAxisAtOneMillisecond) {
  const BusAnalysis a = Analyse(1, 1000);
  EXPECT_NEAR(a.load, 0.285, 1e-9);
  EXPECT_EQ(a.quiet.tpdo_us, 325);
  EXPECT_EQ(a.quiet.rpdo_us, 420);
  EXPECT_EQ(a.all_emergencies.tpdo_us, 460);
  EXPECT_EQ(a.all_emergencies.rpdo_us, 555);
  EXPECT_EQ(a.all_emergencies.computing_us, 445);
  EXPECT_TRUE(a.holds);
}

TEST(BusLayout, TwoAxesAtOneMillisecond) {
  const BusAnalysis a = Analyse(2, 1000);
  EXPECT_NEAR(a.load, 0.515, 1e-9);
  EXPECT_EQ(a.quiet.tpdo_us, 460);
  EXPECT_EQ(a.quiet.rpdo_us, 650);
  EXPECT_EQ(a.all_emergencies.tpdo_us, 730);
  EXPECT_EQ(a.all_emergencies.rpdo_us, 920);
  EXPECT_EQ(a.all_emergencies.computing_us, 80);
  EXPECT_EQ(a.one_emergency.computing_us, 215);
  EXPECT_TRUE(a.holds);
  EXPECT_EQ(a.emergencies_carried, 1) << "sent at 200 us, there are 215 us with one";
  EXPECT_EQ(a.batch_us, 135 + 2 * 95 + 55);
  EXPECT_EQ(a.feedback_latest_us, 850);
}

TEST(BusLayout, ThreeAxesAtOneMillisecondOnlyWhenSentEarly) {
  const BusAnalysis a = Analyse(3, 1000);
  EXPECT_NEAR(a.load, 0.745, 1e-9);
  EXPECT_EQ(a.quiet.tpdo_us, 595);
  EXPECT_EQ(a.quiet.rpdo_us, 880);
  EXPECT_GT(a.all_emergencies.rpdo_us.value_or(2000), 1000);
  EXPECT_FALSE(a.holds) << "200 us and 880 us are more than the cycle";
  EXPECT_NE(a.verdict.find("1080 us after the grid point"), std::string::npos) << a.verdict;
  const BusAnalysis early = Analyse(3, 1000, 100);
  EXPECT_TRUE(early.holds);
  EXPECT_EQ(early.emergencies_carried, 0);
}

TEST(BusLayout, FourAxesNeedTwoMilliseconds) {
  const BusAnalysis at_1ms = Analyse(4, 1000);
  EXPECT_NEAR(at_1ms.load, 0.975, 1e-9);
  EXPECT_GT(at_1ms.quiet.rpdo_us.value_or(2000), 1000);
  EXPECT_FALSE(at_1ms.holds);
  const BusAnalysis at_2ms = Analyse(4, 2000, 400);
  EXPECT_EQ(at_2ms.all_emergencies.tpdo_us, 1270);
  EXPECT_EQ(at_2ms.all_emergencies.rpdo_us, 1650);
  EXPECT_EQ(at_2ms.all_emergencies.computing_us, 350);
  EXPECT_EQ(at_2ms.one_emergency.computing_us, 755);
  EXPECT_TRUE(at_2ms.holds);
}

TEST(BusLayout, HalfTheBitRateIsTooSlowForTwoAxes) {
  BusConfig bus{"can0"};
  bus.bitrate_bit_s = 500'000;
  const BusAnalysis a = AnalyseBus(Drives(2), bus, 1000, 200);
  EXPECT_NEAR(a.load, 1.03, 1e-9);
  EXPECT_FALSE(a.holds);
  EXPECT_NE(a.verdict.find("overloaded"), std::string::npos) << a.verdict;
}

TEST(BusLayout, CountsWhatTheConfigurationAsksFor) {
  std::vector<BusDrive> drives = Drives(1);
  const double load = AnalyseBus(drives, BusConfig{"can0"}, 1000, 200).load;
  drives[0].drive.linear_scale = LinearScaleConfig{1000};
  EXPECT_NEAR(AnalyseBus(drives, BusConfig{"can0"}, 1000, 200).load, load + 0.095, 1e-9);
  drives[0].drive.linear_scale.reset();
  drives[0].drive.mode = DriveMode::kCsp;
  EXPECT_NEAR(AnalyseBus(drives, BusConfig{"can0"}, 1000, 200).load, load + 0.040, 1e-9);
  // The master's heartbeat: every 3 ms for a drive that acts after 10 ms.
  const auto messages = BusMessages(drives, BusConfig{"can0"}, 1000, 1);
  const auto& master = messages.back();
  EXPECT_EQ(master.id, 0x77F);
  EXPECT_EQ(master.period_ns, 3'000'000);
}

TEST(BusLayout, ADriveThatAnswersLateCostsItsDelayAndOneMoreBlocking) {
  std::vector<BusDrive> drives = Drives(2);
  drives[1].drive.tpdo_delay_us = 50;
  EXPECT_EQ(AnalyseBus(drives, BusConfig{"can0"}, 1000, 100).feedback_us, 650 + 50 + 135);
}

}  // namespace
}  // namespace contour
