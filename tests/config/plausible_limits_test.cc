#include "config/plausible_limits.h"

#include <gtest/gtest.h>

#include <string>

#include "config/load_machine.h"
#include "config/machine_checks.h"
#include "config/stopping.h"
#include "tests/config/test_files.h"

namespace contour {
namespace {

MachineConfig Good() { return LoadMachine(ExampleMachine("xy_emulated.yaml")); }

// The one problem of a machine, as "key: message".
std::string Only(const MachineConfig& c) {
  std::string all;
  for (const ConfigProblem& p : Check(c)) all += (all.empty() ? "" : "\n") + p.key + ": " + p.message;
  EXPECT_EQ(all.find('\n'), std::string::npos) << all;
  return all;
}

// What the cycle would refuse when it is made.
TEST(PlausibleLimits, AStopOnThePathHasTheRoomThatTheCycleKeepsForIt) {
  MachineConfig c = Good();
  c.axes.at("x").limits.velocity_mm_s = 100.0;
  c.axes.at("x").limits.jerk_mm_s3 = 1.0;
  EXPECT_EQ(Only(c),
            "axes.x.limits.jerk_mm_s3: found 1, with which a stop on the path from 100 mm/s takes 24.49 s, "
            "expected at least 162.8: 1.92 s are what the cycle keeps points of the path for; a lower "
            "velocity_mm_s or a longer machine.cycle_us would do, too");
  c.axes.at("x").limits.jerk_mm_s3 = 163.0;
  EXPECT_TRUE(Check(c).empty());
  c.axes.at("x").limits.acceleration_mm_s2 = 70.0;
  c.axes.at("x").limits.jerk_mm_s3 = 1e4;
  EXPECT_TRUE(Only(c).starts_with("axes.x.limits.acceleration_mm_s2: found 70, with which a stop "));
}

TEST(PlausibleLimits, DistancesThatBoundNothing) {
  MachineConfig c = Good();
  c.axes.at("x").limits.following_error_mm = 1e6;
  EXPECT_EQ(Only(c),
            "axes.x.limits.following_error_mm: found 1000000, expected at most 20, a twentieth of a stroke "
            "of 400 mm");
  c.axes.at("x").limits.following_error_mm = 2.1;
  EXPECT_EQ(
      Only(c),
      "axes.x.limits.following_error_mm: found 2.1, expected at most safe_travel_mm 2: an axis off its path "
      "is to be stopped within that");
  c = Good();
  c.axes.at("x").limits.safe_travel_mm = 5000;
  EXPECT_EQ(
      Only(c),
      "axes.x.limits.safe_travel_mm: found 5000, expected at most 100, a quarter of a stroke of 400 mm: "
      "more keeps nothing from its end");
}

TEST(PlausibleLimits, FollowingErrorWithinTheCountsOfTheEncoder) {
  MachineConfig c = Good();
  c.axes.at("x").limits.following_error_mm = 1e-5;
  EXPECT_EQ(Only(c),
            "axes.x.limits.following_error_mm: found 1e-05, expected at least 4.768e-05, ten counts of the "
            "encoder: below, standing still is a fault");
  c.axes.at("x").limits.following_error_mm = 4.8e-5;
  EXPECT_TRUE(Check(c).empty());
}

TEST(PlausibleLimits, SilenceOfADrive) {
  MachineConfig c = Good();
  c.axes.at("x").drive.heartbeat_timeout_ms = 501;
  EXPECT_NE(Only(c).find("axes.x.drive.heartbeat_timeout_ms: found 501, expected at most 500"),
            std::string::npos);
  c.axes.at("x").drive.heartbeat_timeout_ms = 500;
  EXPECT_TRUE(Check(c).empty());
}

TEST(PlausibleLimits, QuickStopThatIsCutOffOrNeverEnds) {
  MachineConfig c = Good();
  // From 1.2 * 250 mm/s at 22600 rad/s^2 of a 5 mm screw, 17.98 m/s^2: 16.7 ms, and 40 ms until the drive is
  // off.
  c.axes.at("x").drive.quick_stop_ms = 50;
  EXPECT_NE(Only(c).find("axes.x.drive.quick_stop_ms: found 50, expected at least 56.68"), std::string::npos)
      << Only(c);
  c.axes.at("x").drive.quick_stop_ms = 10000;
  EXPECT_NE(Only(c).find("found 10000, expected at most 1567"), std::string::npos) << Only(c);
}

// Blind for 1020 ms at 250 mm/s: 255 mm and the quick stop. Both axes are refused, each by its own stroke.
TEST(PlausibleLimits, BlindTravel) {
  MachineConfig c = Good();
  c.io.modbus->timeout_ms = 1000;
  c.axes.at("y").limits.position_mm = {-300.0, 300.0};
  EXPECT_NE(Only(c).find("seen up to 1020 ms late, and axis 'x' goes 257"), std::string::npos) << Only(c);
  c.io.modbus->accept_blind_travel = true;
  EXPECT_TRUE(Check(c).empty());
  c.io.modbus->accept_blind_travel = false;
  c.io.modbus->timeout_ms = 500;
  EXPECT_TRUE(Check(c).empty());
}

TEST(PlausibleLimits, TelemetryStaysInItsNetwork) {
  MachineConfig c = Good();
  c.telemetry.lcm_url = "udpm://239.255.76.67:7667?recv_buf_size=1&ttl=32";
  EXPECT_EQ(
      Only(c),
      "telemetry.lcm_url: found ttl=32, expected 0 (this computer) or 1 (this network): above, routers pass "
      "the packets on; telemetry.leave_network: true allows it");
  c.telemetry.leave_network = true;
  EXPECT_TRUE(Check(c).empty());
  c.telemetry = {};
  c.telemetry.lcm_url = "udpm://239.255.76.67:7667?ttl=1";
  EXPECT_TRUE(Check(c).empty());
  c.telemetry.lcm_url = "udpm://239.255.76.67:7667?ttl=1x";
  EXPECT_NE(Only(c).find("expected a ttl from 0 to 255"), std::string::npos);
}

}  // namespace
}  // namespace contour
