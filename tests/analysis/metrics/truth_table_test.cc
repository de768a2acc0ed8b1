#include "analysis/metrics/truth_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace contour {
namespace {

const std::vector<std::string> kAxes = {"x", "y"};
constexpr double kCount_rad = 2.0 * 3.141592653589793 / 1048576.0;

/// Angles of a circle in whole counts, as an encoder gives them.
PerAxis<double> Angles(double time_s) {
  PerAxis<double> angles(2);
  angles[0] = std::round(20000.0 * std::cos(0.8 * time_s)) * kCount_rad;
  angles[1] = std::round(20000.0 * std::sin(0.8 * time_s)) * kCount_rad;
  return angles;
}

TruthTable CircleTruth() {
  std::vector<TruthSample> samples;
  for (std::uint64_t n = 1; n <= 8000; ++n) {
    const PerAxis<double> angles = Angles(static_cast<double>(n) * 1e-3);
    samples.push_back({n, angles, angles, angles});
  }
  return {std::move(samples), 2};
}

std::vector<ReceivedAngles> Received(std::uint64_t first, std::uint64_t count, std::int64_t offset) {
  std::vector<ReceivedAngles> received;
  for (std::uint64_t n = first; n < first + count; ++n) {
    const double true_number = static_cast<double>(n) + static_cast<double>(offset);
    received.push_back({n, Angles(true_number * 1e-3)});
  }
  return received;
}

TEST(TruthTable, OffsetIsFoundFromTheAngles) {
  const TruthTable truth = CircleTruth();
  EXPECT_EQ(truth.OffsetOf(Received(100, 2000, 0)), 0);
  EXPECT_EQ(truth.OffsetOf(Received(100, 2000, 3511)), 3511);
  EXPECT_EQ(truth.OffsetOf(Received(5000, 2000, -4321)), -4321);
}

TEST(TruthTable, NoOffsetIsGuessed) {
  const TruthTable truth = CircleTruth();
  auto other_run = Received(100, 2000, 77);
  for (auto& r : other_run) r.angle_rad[1] += 0.3;
  EXPECT_FALSE(truth.OffsetOf(other_run).has_value());
  auto standing = Received(100, 2000, 0);
  for (auto& r : standing) r.angle_rad = standing.front().angle_rad;
  EXPECT_FALSE(truth.OffsetOf(standing).has_value());
  auto mixed = Received(100, 1000, 0);
  const auto later = Received(1100, 1000, 50);
  mixed.insert(mixed.end(), later.begin(), later.end());
  EXPECT_FALSE(truth.OffsetOf(mixed).has_value());
}

class TruthFile : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ =
        std::filesystem::temp_directory_path() /
        ("truth_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + ".csv");
  }
  void TearDown() override { std::filesystem::remove(path_); }

  TruthTable Load(const std::string& text) const {
    std::ofstream(path_) << text;
    return TruthTable::Load(path_, kAxes);
  }
  std::string ErrorOf(const std::string& text) const {
    try {
      Load(text);
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "";
  }

  static constexpr const char* kHeader =
      "sync_number,time_s,free_running,y_table_position_m,y_friction_N,y_reported_position_rad,x_drive_state,"
      "x_table_position_m,x_friction_N,x_reported_position_rad\n";
  std::filesystem::path path_;
};

TEST_F(TruthFile, ColumnsAreFoundByName) {
  const TruthTable truth = Load(std::string(kHeader) +
                                "7,0.007,0,0.2,-40,0.4,Operation Enabled,0.1,30,0.3\n"
                                "7,0.0071,1,9,9,9,Fault,9,9,9\n"
                                "8,0.008,0,0.21,-41,0.41,Operation Enabled,0.11,3.1e1,0.31\n"
                                "9,0.009,0,0.2");
  EXPECT_EQ(truth.size(), 2u);
  const TruthSample* sample = truth.Find(8);
  ASSERT_NE(sample, nullptr);
  EXPECT_EQ(sample->table_m[0], 0.11);
  EXPECT_EQ(sample->table_m[1], 0.21);
  EXPECT_EQ(sample->friction_N[0], 31.0);
  EXPECT_EQ(sample->reported_rad[1], 0.41);
  EXPECT_EQ(truth.Find(6), nullptr);
  EXPECT_EQ(truth.Find(9), nullptr);

  ScoredRow row{0.0, PerAxis<ScoredAxis>(2)};
  AddTruth(*truth.Find(7), row);
  EXPECT_EQ(row.axes[0].table_m, 0.1);
  EXPECT_EQ(row.axes[1].friction_truth_N, -40.0);
}

TEST_F(TruthFile, TheTableCountsFromWhereTheEncoderBeganTo) {
  const TruthTable truth = Load(
      "sync_number,free_running,x_table_position_m,x_friction_N,x_reported_position_rad,x_encoder_zero_m,"
      "y_table_position_m,y_friction_N,y_reported_position_rad,y_encoder_zero_m\n"
      "7,0,0.75,0,0,0.5,0.25,0,0,-0.5\n");
  ASSERT_NE(truth.Find(7), nullptr);
  EXPECT_EQ(truth.Find(7)->table_m[0], 0.25);
  EXPECT_EQ(truth.Find(7)->table_m[1], 0.75);
}

TEST_F(TruthFile, ErrorsNameFileAndLine) {
  EXPECT_NE(ErrorOf("sync_number,free_running\n").find(":1: column x_table_position_m is missing"),
            std::string::npos);
  EXPECT_NE(ErrorOf(std::string(kHeader) + "7,0.007,0,0.2\n").find(":2: found 4 fields, expected 10"),
            std::string::npos);
  EXPECT_NE(
      ErrorOf(std::string(kHeader) + "7,0.007,0,much,-40,0.4,Fault,0.1,30,0.3\n").find(":2: found 'much'"),
      std::string::npos);
  EXPECT_THROW(TruthTable::Load("/nowhere/truth.csv", kAxes), std::runtime_error);
}

}  // namespace
}  // namespace contour
