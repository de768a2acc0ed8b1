#include "tools/plant_emulator/truth_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace contour {
namespace {

std::vector<std::string> Fields(const std::string& line) {
  std::vector<std::string> fields;
  std::stringstream in(line);
  for (std::string f; std::getline(in, f, ',');) fields.push_back(f);
  return fields;
}

TEST(TruthWriter, WritesNamedColumnsAndExactNumbers) {
  const std::string path = ::testing::TempDir() + "truth_writer_test.csv";
  TruthRow row;
  row.axes.resize(2);
  row.axes[1].friction_N = 1.0 / 3.0;
  row.axes[1].drive_state = DriveState::kOperationEnabled;
  {
    TruthWriter writer(path, {"x", "y"});
    for (int k = 0; k < 5000; ++k) {  // beyond one buffer
      row.sync_number = static_cast<std::uint64_t>(k);
      row.time_s = 1e-3 * k;
      row.free_running = k == 4999;
      writer.OnTruth(row);
    }
    EXPECT_TRUE(writer.ok());
  }
  std::ifstream in(path);
  std::string line;
  ASSERT_TRUE(std::getline(in, line));
  const auto names = Fields(line);
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  ASSERT_LT(column("y_friction_N"), names.size());
  ASSERT_LT(column("x_drive_state"), names.size());
  int rows = 0;
  std::vector<std::string> last;
  while (std::getline(in, line)) {
    last = Fields(line);
    ASSERT_EQ(last.size(), names.size());
    EXPECT_EQ(std::stoi(last[column("sync_number")]), rows);
    ++rows;
  }
  EXPECT_EQ(rows, 5000);
  EXPECT_EQ(std::stod(last[column("y_friction_N")]), 1.0 / 3.0);
  EXPECT_EQ(last[column("y_drive_state")], "Operation Enabled");
  EXPECT_EQ(last[column("free_running")], "1");
}

TEST(TruthWriter, SaysWhichFileCannotBeWritten) {
  EXPECT_THROW(TruthWriter("/nonexistent/truth.csv", {"x"}), std::runtime_error);
}

TEST(TruthWriter, AFullDiskIsKnown) {
  TruthWriter writer("/dev/full", {"x"});
  EXPECT_FALSE(writer.ok());
  EXPECT_EQ(writer.error(), ENOSPC);
  writer.OnTruth({});
  writer.Flush();
  EXPECT_EQ(writer.error(), ENOSPC);
}

}  // namespace
}  // namespace contour
