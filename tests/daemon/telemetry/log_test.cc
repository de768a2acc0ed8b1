#include <gtest/gtest.h>
#include <lcm/eventlog.h>
#include <signal.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/exit_status.h"
#include "daemon/telemetry/log_reader.h"
#include "daemon/telemetry/log_writer.h"
#include "tests/support/random_cycle_entry.h"
#include "tests/support/same_cycle_entry.h"
#include "tests/support/scratch_directory.h"

namespace contour {
namespace {

namespace fs = std::filesystem;

class LogTest : public ::testing::Test {
 protected:
  void SetUp() override { file_ = directory_ / "run.lcmlog"; }

  static LogHeader Header() {
    LogHeader h;
    h.build = "contourd 0.1.0";
    h.machine = "xy_table";
    h.controller = "full";
    h.clock = "virtual";
    h.start_unix_us = 1'700'000'000'000'000;
    h.cycle_us = 1000;
    h.axis_names = {"x", "y"};
    h.config_name = "config/xy.yaml";
    h.config_text = "machine: {name: xy_table}\n# \xC3\xA4\n";
    h.overrides = {"a.b=1", "c=2"};
    return h;
  }

  std::vector<CycleEntry> Write(std::uint64_t cycles, std::uint64_t seed = 1) {
    test::RandomCycleEntry random(seed);
    LogWriter writer(file_, Header());
    TelemetryEncoder encoder({}, 1000, Header().axis_names);
    TelemetrySink* sinks[] = {&writer};
    std::vector<CycleEntry> entries;
    for (std::uint64_t cycle = 1; cycle <= cycles; ++cycle) {
      entries.push_back(random.Next(cycle, 2));
      encoder.Add(entries.back(), sinks);
      if (cycle == 60) writer.Note("program", "shape: circle\n");
    }
    encoder.Flush(sinks);
    writer.Close();
    return entries;
  }

  std::string Content() const {
    std::ifstream in(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void Replace(const std::string& content) const {
    std::ofstream(file_, std::ios::binary | std::ios::trunc) << content;
  }

  struct Read {
    std::uint64_t cycles = 0;
    std::uint64_t missing = 0;
    bool complete = false;
    std::string error;
  };
  Read ReadAll() const {
    Read result;
    try {
      LogReader reader(file_);
      CycleEntry entry;
      while (reader.Next(entry)) ++result.cycles;
      result.missing = reader.missing_cycles();
      result.complete = reader.complete();
    } catch (const LogError& e) {
      result.error = e.what();
    }
    return result;
  }

  test::ScratchDirectory scratch_;
  const fs::path directory_ = scratch_.path();
  fs::path file_;
};

TEST_F(LogTest, FormatsOfTheSameMessagesAreReadAndSayWhichTheyAre) {
  const auto written_as = [&](std::int32_t format) {
    LogHeader header = Header();
    header.format_version = format;
    LogWriter(file_, header).Close();
    return LogReader(file_).header().format_version;
  };
  for (std::int32_t format = kOldestReadFormat; format <= kLogFormatVersion; ++format)
    EXPECT_EQ(written_as(format), format);
  EXPECT_THROW(written_as(kOldestReadFormat - 1), LogError);
  EXPECT_THROW(written_as(kLogFormatVersion + 1), LogError);
}

TEST_F(LogTest, GivesBackEveryCycleBitForBit) {
  const auto written = Write(137);
  LogReader reader(file_);
  EXPECT_EQ(reader.header(), Header());
  CycleEntry entry;
  for (const CycleEntry& expected : written) {
    ASSERT_TRUE(reader.Next(entry));
    test::ExpectSame(expected, entry);
    if (HasFailure()) FAIL() << "cycle " << expected.input.cycle;
  }
  EXPECT_FALSE(reader.Next(entry));
  EXPECT_TRUE(reader.complete());
  EXPECT_EQ(reader.missing_cycles(), 0u);
  ASSERT_EQ(reader.notes().size(), 1u);
  EXPECT_EQ(reader.notes()[0], (LogNote{50, "program", "shape: circle\n"}));
}

TEST_F(LogTest, IsAnLcmEventLogWithChannelsForLooking) {
  Write(100);
  std::unique_ptr<lcm_eventlog_t, void (*)(lcm_eventlog_t*)> log(lcm_eventlog_create(file_.c_str(), "r"),
                                                                 lcm_eventlog_destroy);
  ASSERT_NE(log, nullptr);
  std::set<std::string> channels;
  std::int64_t number = 0;
  std::int64_t last_us = 0;
  while (lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(log.get())) {
    channels.insert(event->channel);
    EXPECT_EQ(event->eventnum, number++);
    EXPECT_GE(event->timestamp, last_us);
    last_us = event->timestamp;
    lcm_eventlog_free_event(event);
  }
  EXPECT_EQ(last_us, Header().start_unix_us + 99'000);
  for (const char* channel :
       {"CONTOUR_LOG_HEADER", "CONTOUR_CYCLES", "CONTOUR_STATUS", "CONTOUR_FAULTS", "CONTOUR_ERROR",
        "CONTOUR_TIMING", "CONTOUR_AXIS_x", "CONTOUR_AXIS_y", "CONTOUR_FRICTION_x", "CONTOUR_LOG_FOOTER"})
    EXPECT_TRUE(channels.contains(channel)) << channel;
}

TEST_F(LogTest, TheSameRunGivesTheSameBytes) {
  Write(80);
  const std::string first = Content();
  Write(80);
  EXPECT_TRUE(first == Content());
}

TEST_F(LogTest, ALogCutShortIsReadUpToThereAndSaysSo) {
  Write(200);
  const std::string whole = Content();
  EXPECT_EQ(ReadAll().cycles, 200u);
  std::uint64_t last = 0;
  for (std::size_t tenth = 1; tenth < 10; ++tenth) {
    Replace(whole.substr(0, whole.size() * tenth / 10));
    const Read read = ReadAll();
    EXPECT_TRUE(!read.error.empty() || !read.complete) << tenth;
    EXPECT_GE(read.cycles, last);
    EXPECT_EQ(read.cycles % 50, 0u) << "a batch is there or it is not";
    last = read.cycles;
  }
  EXPECT_GE(last, 100u);
}

TEST_F(LogTest, DamageAnywhereInTheRecordOfCyclesIsNoticed) {
  Write(100);
  const std::string whole = Content();
  std::vector<std::size_t> places;
  for (std::size_t at = whole.find("CONTOUR_CYCLES"); at != std::string::npos;
       at = whole.find("CONTOUR_CYCLES", at + 1)) {
    places.push_back(at - 8);                                                  // length of the channel name
    places.push_back(at);                                                      // the name itself
    for (std::size_t i = 0; i < 20; ++i) places.push_back(at + 14 + i * 997);  // the data
  }
  ASSERT_GE(places.size(), 40u);
  for (const std::size_t place : places) {
    ASSERT_LT(place, whole.size());
    std::string damaged = whole;
    damaged[place] = static_cast<char>(damaged[place] ^ 0x41);
    Replace(damaged);
    const Read read = ReadAll();
    EXPECT_TRUE(!read.error.empty() || !read.complete || read.missing > 0) << "byte " << place;
  }
}

TEST_F(LogTest, CountsCyclesThatNeverReachedTheLog) {
  test::RandomCycleEntry random(5);
  LogWriter writer(file_, Header());
  TelemetryEncoder encoder({}, 1000, Header().axis_names);
  TelemetrySink* sinks[] = {&writer};
  for (const std::uint64_t cycle : {1u, 2u, 5u, 6u, 10u}) {
    CycleEntry entry = random.Next(cycle, 2);
    if (cycle == 10) entry.timing.skipped_grid_points = 3;  // 7, 8 and 9 were never cycles
    encoder.Add(entry, sinks);
  }
  encoder.Flush(sinks);
  writer.Close();
  const Read read = ReadAll();
  EXPECT_EQ(read.cycles, 5u);
  EXPECT_EQ(read.missing, 2u);
}

/// Files of this process may not grow beyond a size: a full disk, as write() sees it.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limited{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limited);
  }
  ~FileSizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
};

TEST_F(LogTest, AFullDiskCostsWholeBatchesIsCountedAndWritingGoesOn) {
  test::RandomCycleEntry random(6);
  LogWriter writer(file_, Header());
  TelemetryEncoder encoder({}, 1000, Header().axis_names);
  TelemetrySink* sinks[] = {&writer};
  std::uint64_t cycle = 0;
  const auto write = [&](int cycles) {
    for (int i = 0; i < cycles; ++i) encoder.Add(random.Next(++cycle, 2), sinks);
  };
  write(100);
  EXPECT_EQ(writer.stats().lost_cycles, 0u);
  {
    const FileSizeLimit limit(writer.stats().bytes + 1000);  // a part of the next batch fits
    write(150);
  }
  EXPECT_EQ(writer.stats().lost_cycles, 150u);
  EXPECT_NE(writer.stats().last_error, "");
  EXPECT_EQ(fs::file_size(file_), writer.stats().bytes) << "the part that fitted is cut off again";
  write(50);
  writer.Close();
  EXPECT_EQ(writer.stats().cycles, 150u);
  const Read read = ReadAll();
  EXPECT_EQ(read.error, "");
  EXPECT_TRUE(read.complete);
  EXPECT_EQ(read.cycles, 150u);
  EXPECT_EQ(read.missing, 150u);
}

TEST_F(LogTest, RefusesWhatIsNoLog) {
  EXPECT_NE(ReadAll().error.find("No such file"), std::string::npos);
  Replace("time_s,torque_Nm\n0,0\n");
  EXPECT_NE(ReadAll().error.find("is not a log"), std::string::npos);
  EXPECT_EQ(ReadAll().error.find(file_.string()), 0u);
}

TEST_F(LogTest, ASecondWriterLeavesTheLogOfTheFirstAsItIs) {
  const LogWriter first(file_, Header());
  const std::string written = Content();
  ASSERT_FALSE(written.empty());
  try {
    LogWriter(file_, Header());
    ADD_FAILURE() << "the second writer was not refused";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("another process is writing it"), std::string::npos) << e.what();
  }
  EXPECT_EQ(Content(), written);
}

TEST_F(LogTest, WhatIsNoFileMayHaveSeveralWriters) {
  const LogWriter first("/dev/null", Header());
  EXPECT_NO_THROW(LogWriter("/dev/null", Header()));
}

TEST_F(LogTest, TheNextWriterBeginsTheFileAnew) {
  Write(300);
  const std::string longer = Content();
  Write(100);
  EXPECT_LT(Content().size(), longer.size());
  EXPECT_EQ(ReadAll().cycles, 100u);
}

TEST_F(LogTest, SaysWhyALogCannotBeMade) {
  try {
    LogWriter writer(directory_ / "missing" / "run.lcmlog", Header());
    FAIL() << "made a log in a directory that does not exist";
  } catch (const EnvironmentError& e) {
    EXPECT_NE(std::string(e.what()).find("No such file or directory"), std::string::npos) << e.what();
  }
  // /dev/full opens, and every write to it fails as on a full disk.
  EXPECT_THROW(LogWriter("/dev/full", Header()), std::runtime_error);
}

}  // namespace
}  // namespace contour
