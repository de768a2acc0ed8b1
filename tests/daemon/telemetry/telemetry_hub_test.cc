#include "daemon/telemetry/telemetry_hub.h"

#include <gtest/gtest.h>

#include <chrono>
#include <contour_lcm/cycle_entry.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "daemon/telemetry/log_reader.h"
#include "drivers/lcm/cycle_messages.h"
#include "tests/support/random_cycle_entry.h"
#include "tests/support/same_cycle_entry.h"
#include "tests/support/scratch_directory.h"

namespace contour {
namespace {

const std::vector<std::string> kAxes{"x", "y"};

TelemetryConfig Silent() {
  TelemetryConfig config;
  config.publish = false;
  return config;
}

TEST(TelemetryHubTest, StatusSeesTheNewestCycleAndTheCounts) {
  TelemetryHub hub(Silent(), 1000, kAxes, std::nullopt);
  test::RandomCycleEntry random(1);
  CycleEntry entry;
  for (std::uint64_t cycle = 1; cycle <= 10; ++cycle) {
    entry = random.Next(cycle, 2);
    entry.timing = {};
    entry.timing.received_ns = 10'000;
    entry.timing.stepped_ns = 40'000 + static_cast<std::int64_t>(cycle) * 1000;
    entry.timing.sent_ns = 100'000;
    entry.timing.late = cycle % 5 == 0;
    entry.timing.skipped_grid_points = cycle == 7 ? 3 : 0;
    hub.Consume(entry);
  }
  const TelemetryHub::Snapshot s = hub.snapshot();
  EXPECT_EQ(s.cycles, 10u);
  EXPECT_EQ(s.health.late_cycles, 2u);
  EXPECT_EQ(s.skipped_grid_points, 3u);
  EXPECT_EQ(s.health.computing.max_us, 40.0);
  EXPECT_EQ(s.health.sent.p50_us, 100.0);
  test::ExpectSame(entry.output.record, s.record);
  test::ExpectSame(entry.output.record, hub.record());
  EXPECT_FALSE(s.publisher.enabled);
  EXPECT_EQ(s.log.file, "");
}

// Else a client that takes nothing holds up the end of the daemon, before the log is closed.
TEST(TelemetryHubTest, OnceFeedsHaveEndedNoClientIsWaitedFor) {
  TelemetryHub hub(Silent(), 1000, kAxes, std::nullopt, std::chrono::hours(1));
  test::RandomCycleEntry random(4);
  const auto feed = std::make_shared<RowFeed>(1);
  hub.Attach(feed);
  hub.Consume(random.Next(1, 2));
  hub.EndFeeds();
  hub.Consume(random.Next(2, 2));
  EXPECT_EQ(feed->lost(), 1u);
}

TEST(TelemetryHubTest, AClientThatDoesNotKeepUpIsTold) {
  TelemetryHub hub(Silent(), 1000, kAxes, std::nullopt);
  test::RandomCycleEntry random(6);
  const auto feed = std::make_shared<RowFeed>(1);
  hub.Attach(feed);
  hub.Consume(random.Next(1, 2));
  EXPECT_EQ(hub.TakeRowsMessage(), std::nullopt);
  hub.Consume(random.Next(2, 2));
  hub.Consume(random.Next(3, 2));
  ASSERT_TRUE(hub.TakeRowsMessage());
  EXPECT_EQ(hub.TakeRowsMessage(), std::nullopt) << "once";
  hub.Detach(feed);
  EXPECT_EQ(hub.TakeRowsMessage(), "a client that collected rows has ended; 2 were dropped");
}

TEST(TelemetryHubTest, ClientsGetRowsWhileAttached) {
  TelemetryHub hub(Silent(), 1000, kAxes, std::nullopt);
  test::RandomCycleEntry random(2);
  const auto feed = std::make_shared<RowFeed>();
  hub.Consume(random.Next(1, 2));
  hub.Attach(feed);
  hub.Consume(random.Next(2, 2));
  hub.Consume(random.Next(3, 2));
  hub.Detach(feed);
  hub.Consume(random.Next(4, 2));
  ASSERT_EQ(feed->size(), 2u);
  contour_lcm::cycle_entry row{};
  ASSERT_TRUE(Decode(feed->Pop().value(), row));
  EXPECT_EQ(row.status.cycle, 2);
}

TEST(TelemetryHubTest, TheLogHoldsEveryCycleAndEveryNote) {
  const test::ScratchDirectory directory;
  TelemetryHub::LogTarget target;
  target.file = directory.path() / "run.lcmlog";
  target.header.axis_names = kAxes;
  test::RandomCycleEntry random(3);
  {
    TelemetryHub hub(Silent(), 1000, kAxes, target);
    for (std::uint64_t cycle = 1; cycle <= 73; ++cycle) hub.Consume(random.Next(cycle, 2));
    hub.Note("program", "shape: hold");
    hub.Close();
    EXPECT_EQ(hub.snapshot().log.cycles, 73u);
  }
  LogReader reader(target.file);
  CycleEntry entry;
  std::uint64_t cycles = 0;
  while (reader.Next(entry)) EXPECT_EQ(entry.input.cycle, ++cycles);
  EXPECT_EQ(cycles, 73u);
  EXPECT_TRUE(reader.complete());
  ASSERT_EQ(reader.notes().size(), 1u);
  EXPECT_EQ(reader.notes()[0].text, "shape: hold");
}

}  // namespace
}  // namespace contour
