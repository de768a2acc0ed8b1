#include "daemon/telemetry/background_log.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <string>
#include <thread>

#include "daemon/telemetry/log_reader.h"
#include "tests/support/random_cycle_entry.h"
#include "tests/support/scratch_directory.h"

namespace contour {
namespace {

using Clock = std::chrono::steady_clock;

LogHeader Header() {
  LogHeader header;
  header.axis_names = {"x", "y"};
  return header;
}

class BackgroundLogTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(::mkfifo(fifo_.c_str(), 0600), 0); }
  /// So many cycles in batches of 50.
  void Write(BackgroundLog& log, int cycles) {
    TelemetrySink* sinks[] = {&log};
    for (int i = 0; i < cycles; ++i) encoder_.Add(random_.Next(++cycle_, 2), sinks);
  }

  test::ScratchDirectory scratch_;
  const std::filesystem::path fifo_ = scratch_.path() / "fifo";
  test::RandomCycleEntry random_{1};
  TelemetryEncoder encoder_{{}, 1000, Header().axis_names};
  std::uint64_t cycle_ = 0;
};

// Nobody ever reads: this would not end if anybody waited for the pipe.
TEST_F(BackgroundLogTest, APipeThatNobodyReadsCostsCyclesAndNothingElse) {
  const int reader = ::open(fifo_.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  BackgroundLog::Limits limits;
  limits.max_bytes = 500'000;
  BackgroundLog log(fifo_, Header(), limits);
  Write(log, 2000);
  log.Note("program 1 a.yaml", "shape: hold");
  LogStats stats = log.stats();
  EXPECT_GT(stats.lost_cycles, 0u);
  EXPECT_GT(stats.waiting_cycles, 0u);
  EXPECT_EQ(stats.lost_notes, 0u) << "notes have room of their own";
  EXPECT_EQ(stats.cycles + stats.lost_cycles + stats.waiting_cycles, 2000u);
  EXPECT_NE(stats.last_error, "");
  EXPECT_FALSE(log.Close(Clock::now())) << "not everything was taken";
  EXPECT_EQ(log.stats().lost_cycles + log.stats().waiting_cycles + log.stats().cycles, 2000u);
  ::close(reader);
}

TEST_F(BackgroundLogTest, APipeThatNobodyOpensIsAnErrorAndNotAWaitForEver) {
  BackgroundLog::Limits limits;
  limits.opening = std::chrono::milliseconds(1);
  EXPECT_THROW(BackgroundLog(fifo_, Header(), limits), std::runtime_error);
}

TEST_F(BackgroundLogTest, WhatWasLostOnTheWayIsCountedInTheLogItself) {
  const auto file = scratch_.path() / "run.lcmlog";
  BackgroundLog::Limits limits;
  limits.max_bytes = 1;  // one batch under way, and no more: some are lost, how many depends on the host
  BackgroundLog log(file, Header(), limits);
  Write(log, 5000);
  ASSERT_TRUE(log.Close(Clock::now() + std::chrono::minutes(1)));
  const LogStats stats = log.stats();
  EXPECT_EQ(stats.waiting_cycles, 0u);
  EXPECT_EQ(stats.cycles + stats.lost_cycles, 5000u);
  LogReader reader(file);
  CycleEntry entry;
  std::uint64_t read = 0;
  while (reader.Next(entry)) ++read;
  EXPECT_TRUE(reader.complete());
  EXPECT_EQ(read, stats.cycles);
  EXPECT_EQ(reader.missing_cycles(), stats.lost_cycles);
}

TEST_F(BackgroundLogTest, InLockstepTimeWaitsForASlowDisk) {
  const auto file = scratch_.path() / "run.lcmlog";
  BackgroundLog::Limits limits;
  limits.max_bytes = 1;
  limits.patience = std::chrono::minutes(1);
  BackgroundLog log(file, Header(), limits);
  Write(log, 5000);
  ASSERT_TRUE(log.Close(Clock::now() + std::chrono::minutes(1)));
  EXPECT_EQ(log.stats().lost_cycles, 0u);
  EXPECT_EQ(log.stats().cycles, 5000u);
}

}  // namespace
}  // namespace contour
