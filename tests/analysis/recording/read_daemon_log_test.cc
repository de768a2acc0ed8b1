#include "analysis/recording/read_log.h"

#include <gtest/gtest.h>

#include <memory>

#include "config/config_error.h"
#include "daemon/telemetry/log_writer.h"
#include "tests/config/test_files.h"

namespace contour::diagnosis {
namespace {

std::string Error(const std::string& file, const ReadOptions& options = {}) {
  try {
    ReadLog(file, options);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

/// Cycle k of a daemon's log: feedback of SYNC k-1 and the command computed from it stand in one row.
TEST(ReadDaemonLog, DaemonLogPairsTheFeedbackWithTheCommandComputedFromIt) {
  const std::string file = WriteTestFile("run.lcmlog", "");
  LogHeader header;
  header.controller = "full";
  header.cycle_us = 500;
  header.axis_names = {"x", "y"};
  {
    LogWriter writer(file, header);
    TelemetryEncoder encoder({}, 500, header.axis_names);
    TelemetrySink* sinks[] = {&writer};
    auto entry = std::make_unique<CycleEntry>();
    for (std::uint64_t k = 10; k < 20; ++k) {
      if (k == 14) continue;
      CycleRecord& r = entry->output.record;
      entry->input.cycle = r.cycle = k;
      r.axes.resize(2);
      for (std::size_t i = 0; i < 2; ++i) {
        AxisRecord& a = r.axes[i];
        a.feedback.drive_state = k < 12 ? DriveState::kSwitchedOn : DriveState::kOperationEnabled;
        a.feedback.fresh = k != 16;
        a.feedback.position_rad = static_cast<double>(100 * i + k);
        a.position_m = a.feedback.position_rad * 1e-3;
        a.torque_Nm = 0.01 * static_cast<double>(k);
        a.reference.position_m = 2e-3 * static_cast<double>(k);
      }
      encoder.Add(*entry, sinks);
    }
    encoder.Flush(sinks);
    writer.Close();
  }
  EXPECT_TRUE(IsDaemonLog(file));
  EXPECT_NE(Error(file).find("--axis"), std::string::npos);
  const AxisLog log = ReadLog(file, {.axis = "y", .table_per_q = 1e-3});
  EXPECT_EQ(log.axis, "y");
  ASSERT_EQ(log.size(), 8u);  // cycles 12 to 19
  EXPECT_DOUBLE_EQ(log.period_s, 5e-4);
  EXPECT_EQ(log.present, (std::vector<std::uint8_t>{1, 1, 0, 1, 0, 1, 1, 1}));
  EXPECT_DOUBLE_EQ(log.position[3], 115.0);
  EXPECT_DOUBLE_EQ(log.command[3], 0.15);
  EXPECT_DOUBLE_EQ(log.command[2], 0.13);  // cycle 14 never was: the drive went on with the last
  EXPECT_DOUBLE_EQ(log.command[4], 0.16);  // stale feedback, but the command is known
  EXPECT_DOUBLE_EQ(log.reference_position[3], 30.0);
  EXPECT_DOUBLE_EQ(log.axis2_position_m[3], 15e-3);
  EXPECT_TRUE(log.table_position_m.empty());
}

TEST(ReadDaemonLog, ATableIsNone) {
  EXPECT_FALSE(IsDaemonLog(WriteTestFile("log.csv", "time_s,force_N,position_m\n")));
  EXPECT_FALSE(IsDaemonLog("/nowhere.lcmlog"));
}

}  // namespace
}  // namespace contour::diagnosis
