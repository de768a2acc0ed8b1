#include "tools/validation/contest/kept_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

namespace contour {
namespace {

class KeptCellsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    file = std::filesystem::path(::testing::TempDir()) / ("kept_cells_" + std::string(test->name()) + ".tsv");
    std::filesystem::remove(file);
  }
  void TearDown() override { std::filesystem::remove(file); }

  std::filesystem::path file;
};

ContestCell Cell(ControllerName controller, std::uint64_t seed, std::uint64_t source) {
  ContestCell cell;
  cell.controller = controller;
  cell.program_name = "ring";
  cell.machine_name = "nominal";
  cell.seed = seed;
  cell.source = source;
  return cell;
}

CellResult Result(double um) {
  CellResult r;
  r.peak_um = um;
  r.rms_um = um / 3.0;
  r.encoder_peak_um = 0.1 + um;
  r.window_peak_um = {um, 0.7 * um, std::nextafter(um, 2.0)};
  return r;
}

TEST_F(KeptCellsTest, ComesBackBitForBit) {
  CellResult stopped;
  stopped.failure = "the machine\tstopped\n: following_error";
  stopped.peak_um = std::numeric_limits<double>::infinity();
  CellResult round = Result(0.1);
  round.circular_deviation_um = 1.0 / 3.0;
  {
    KeptCells kept(file, false, {});
    kept.Keep(Cell(ControllerName::kFull, 1, 5), round);
    kept.Keep(Cell(ControllerName::kPid, 1, 5), stopped);
  }
  const KeptCells kept(file, true, {});
  const CellResult* full = kept.Find(Cell(ControllerName::kFull, 1, 5));
  ASSERT_NE(full, nullptr);
  EXPECT_EQ(full->peak_um, round.peak_um);
  EXPECT_EQ(full->rms_um, round.rms_um);
  EXPECT_EQ(full->encoder_peak_um, round.encoder_peak_um);
  EXPECT_EQ(full->circular_deviation_um, round.circular_deviation_um);
  EXPECT_EQ(full->window_peak_um, round.window_peak_um);
  EXPECT_FALSE(full->failed());
  const CellResult* pid = kept.Find(Cell(ControllerName::kPid, 1, 5));
  ASSERT_NE(pid, nullptr);
  EXPECT_TRUE(std::isinf(pid->peak_um));
  EXPECT_EQ(pid->failure, "the machine stopped : following_error");
  EXPECT_FALSE(pid->circular_deviation_um);
}

TEST_F(KeptCellsTest, AnotherSeedMachineOrControllerIsAnotherRun) {
  KeptCells kept(file, false, {});
  kept.Keep(Cell(ControllerName::kFull, 1, 5), Result(1.0));
  EXPECT_NE(kept.Find(Cell(ControllerName::kFull, 1, 5)), nullptr);
  EXPECT_EQ(kept.Find(Cell(ControllerName::kFull, 2, 5)), nullptr);
  EXPECT_EQ(kept.Find(Cell(ControllerName::kFull, 1, 6)), nullptr) << "the file has changed";
  EXPECT_EQ(kept.Find(Cell(ControllerName::kCsp, 1, 5)), nullptr);
}

TEST_F(KeptCellsTest, RunsToBeMadeAgainAreForgottenAndWithoutResumeAllAre) {
  {
    KeptCells kept(file, false, {});
    kept.Keep(Cell(ControllerName::kFull, 1, 5), Result(1.0));
    kept.Keep(Cell(ControllerName::kPid, 1, 5), Result(2.0));
  }
  {
    const KeptCells kept(file, true, {"full"});
    EXPECT_EQ(kept.Find(Cell(ControllerName::kFull, 1, 5)), nullptr);
    EXPECT_NE(kept.Find(Cell(ControllerName::kPid, 1, 5)), nullptr);
  }
  const KeptCells kept(file, false, {});
  EXPECT_EQ(kept.Find(Cell(ControllerName::kPid, 1, 5)), nullptr);
}

TEST_F(KeptCellsTest, ALineThatWasCutOffIsRunAgain) {
  {
    KeptCells kept(file, false, {});
    kept.Keep(Cell(ControllerName::kFull, 1, 5), Result(1.0));
    kept.Keep(Cell(ControllerName::kPid, 1, 5), Result(2.0));
  }
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 3);
  {
    KeptCells kept(file, true, {});
    EXPECT_NE(kept.Find(Cell(ControllerName::kFull, 1, 5)), nullptr);
    EXPECT_EQ(kept.Find(Cell(ControllerName::kPid, 1, 5)), nullptr);
    kept.Keep(Cell(ControllerName::kPid, 1, 5), Result(2.0));
  }
  const KeptCells kept(file, true, {});
  EXPECT_NE(kept.Find(Cell(ControllerName::kPid, 1, 5)), nullptr) << "the new line stands on its own";
}

}  // namespace
}  // namespace contour
