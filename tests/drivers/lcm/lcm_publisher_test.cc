#include "drivers/lcm/lcm_publisher.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <contour_lcm/axis_state.hpp>
#include <contour_lcm/cycle_batch.hpp>
#include <filesystem>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <string>
#include <vector>

#include "drivers/lcm/cycle_messages.h"
#include "tests/support/random_cycle_entry.h"
#include "tests/support/same_cycle_entry.h"
#include "tests/support/scratch_directory.h"

namespace contour {
namespace {

class Collector final : public TelemetrySink {
 public:
  void OnEvent(const TelemetryEvent& event) noexcept override {
    messages[std::string(event.channel)].emplace_back(event.bytes);
  }
  std::map<std::string, std::vector<std::string>> messages;
};

const std::vector<std::string> kAxes{"x", "y"};

TEST(TelemetryEncoderTest, EveryCycleIsInABatchAndEveryTwentiethIsForLooking) {
  Collector collector;
  TelemetrySink* sinks[] = {&collector};
  TelemetryEncoder encoder({}, 1000, kAxes);
  for (std::uint64_t cycle = 1; cycle <= 1010; ++cycle) {
    CycleEntry entry;
    entry.input.cycle = entry.output.record.cycle = cycle;
    entry.output.record.axes.resize(2);
    encoder.Add(entry, sinks);
  }
  EXPECT_EQ(collector.messages["CONTOUR_CYCLES"].size(), 20u);
  encoder.Flush(sinks);
  encoder.Flush(sinks);
  ASSERT_EQ(collector.messages["CONTOUR_CYCLES"].size(), 21u);
  for (const char* channel : {"CONTOUR_STATUS", "CONTOUR_FAULTS", "CONTOUR_ERROR", "CONTOUR_TIMING",
                              "CONTOUR_AXIS_x", "CONTOUR_AXIS_y", "CONTOUR_FRICTION_x", "CONTOUR_FRICTION_y"})
    EXPECT_EQ(collector.messages[channel].size(), 50u) << channel;
  std::int64_t cycle = 0;
  std::int64_t number = 0;
  for (const std::string& bytes : collector.messages["CONTOUR_CYCLES"]) {
    contour_lcm::cycle_batch batch{};
    ASSERT_TRUE(DecodeChecked(bytes, batch));
    EXPECT_EQ(batch.batch_number, number++);
    for (const auto& entry : batch.entries) EXPECT_EQ(entry.input.cycle, ++cycle);
  }
  EXPECT_EQ(cycle, 1010);
}

TEST(TelemetryEncoderTest, AChangeOfStateIsSentAtOnce) {
  Collector collector;
  TelemetrySink* sinks[] = {&collector};
  TelemetryEncoder encoder({}, 1000, kAxes);
  for (std::uint64_t cycle = 1; cycle <= 10; ++cycle) {
    CycleEntry entry;
    entry.output.record.cycle = cycle;
    entry.output.record.state = cycle < 7 ? MachineState::kOff : MachineState::kFaulted;
    entry.output.record.reason = cycle < 7 ? Reason::kNone : Reason::kBusDown;
    encoder.Add(entry, sinks);
  }
  ASSERT_EQ(collector.messages["CONTOUR_FAULTS"].size(), 1u);
  contour_lcm::faults faults{};
  ASSERT_TRUE(Decode(collector.messages["CONTOUR_FAULTS"][0], faults));
  EXPECT_EQ(faults.cycle, 7);
  EXPECT_EQ(faults.reason_name, "bus_down");
}

TEST(TelemetryEncoderTest, ABatchOfAFullMachineFitsAnLcmMessage) {
  // LCM cuts messages into fragments at 64 KiB and takes up to 4 MiB with the default receive buffers in
  // mind.
  Collector collector;
  TelemetrySink* sinks[] = {&collector};
  TelemetryConfig config;
  config.batch_cycles = 100;
  TelemetryEncoder encoder(config, 1000, kAxes);
  CycleEntry entry = test::RandomCycleEntry(1).Next(1, kMaxAxes);
  entry.input.frames.resize(kMaxFramesPerCycle);
  entry.output.frames.resize(kMaxFramesSentPerCycle);
  entry.input.path.resize(kMaxPathPointsPerCycle);
  for (int i = 0; i < config.batch_cycles; ++i) encoder.Add(entry, sinks);
  ASSERT_EQ(collector.messages["CONTOUR_CYCLES"].size(), 1u);
  EXPECT_LT(collector.messages["CONTOUR_CYCLES"][0].size(), 4u << 20);
}

TEST(LcmPublisherTest, WhatIsPublishedArrivesOnTheChannel) {
  // LCM's own file provider in write mode stands for the network: publish() is the same call, and no route is
  // needed.
  const test::ScratchDirectory directory;
  const std::string file = (directory.path() / "events").string();
  const CycleEntry entry = test::RandomCycleEntry(4).Next(20, 2);
  {
    LcmPublisher publisher("file://" + file + "?mode=w");
    TelemetrySink* sinks[] = {&publisher};
    TelemetryEncoder encoder({}, 1000, kAxes);
    encoder.Add(entry, sinks);
    encoder.Flush(sinks);
    EXPECT_EQ(publisher.stats().messages, 9u);
    EXPECT_EQ(publisher.stats().failures, 0u);
    EXPECT_EQ(publisher.stats().last_error, "");
  }
  lcm::LogFile log(file, "r");
  ASSERT_TRUE(log.good());
  bool axis_seen = false;
  bool batch_seen = false;
  while (const lcm::LogEvent* event = log.readNextEvent()) {
    const std::string_view bytes(static_cast<const char*>(event->data),
                                 static_cast<std::size_t>(event->datalen));
    if (event->channel == "CONTOUR_AXIS_y") {
      contour_lcm::axis_state m{};
      ASSERT_TRUE(Decode(bytes, m));
      EXPECT_TRUE(test::Same("torque", m.torque_Nm, entry.output.record.axes[1].torque_Nm));
      axis_seen = true;
    }
    if (event->channel == "CONTOUR_CYCLES") {
      contour_lcm::cycle_batch m{};
      ASSERT_TRUE(DecodeChecked(bytes, m));
      batch_seen = m.entries.size() == 1;
    }
  }
  EXPECT_TRUE(axis_seen);
  EXPECT_TRUE(batch_seen);
}

TEST(LcmPublisherTest, AProviderThatCannotBeOpenedIsCountedAndNeverFatal) {
  LcmPublisher publisher("udpm://no-such-address:0?ttl=0");
  for (int i = 0; i < 3; ++i) publisher.OnEvent({"CONTOUR_STATUS", "abc", 0, 0});
  EXPECT_EQ(publisher.stats().messages, 0u);
  EXPECT_EQ(publisher.stats().failures, 3u);
  EXPECT_NE(publisher.stats().last_error.find("no-such-address"), std::string::npos);
}

/// In a process of its own, in an empty network: no interface is up, nothing has a route. 0: as it should be.
int PublishWithoutRoute() {
  if (::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0 && ::unshare(CLONE_NEWNET) != 0) return 77;
  LcmPublisher publisher(TelemetryConfig{}.lcm_url);
  for (int i = 0; i < 50; ++i) publisher.OnEvent({"CONTOUR_STATUS", "abc", 0, 0});
  const PublisherStats stats = publisher.stats();
  return stats.messages == 0 && stats.failures == 50 && !stats.last_error.empty() ? 0 : 1;
}

TEST(LcmPublisherTest, AMachineWithoutAMulticastRouteRunsAndCountsWhatItCannotSend) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(PublishWithoutRoute());
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "this kernel gives no network namespace";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace contour
