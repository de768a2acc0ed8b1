#include "daemon/logging/logging.h"

#include <gtest/gtest.h>
#include <spdlog/logger.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "core/exit_status.h"
#include "tests/support/scratch_directory.h"

namespace contour {
namespace {

namespace fs = std::filesystem;

class LoggingTest : public ::testing::Test {
 protected:
  void SetUp() override {}

  static std::string Read(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  test::ScratchDirectory scratch_;
  const fs::path directory_ = scratch_.path();
};

TEST_F(LoggingTest, TheJournalGetsAPriorityAndNoTime) {
  ::testing::internal::CaptureStderr();
  const auto logger = MakeLogger({}, true);
  logger->info("drives found");
  logger->warn("late");
  logger->error("emergency stop");
  logger->debug("not at this level");
  logger->flush();
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "<6>drives found\n<4>late\n<3>emergency stop\n");
}

TEST_F(LoggingTest, ElsewhereALineHasTimeAndLevel) {
  ::testing::internal::CaptureStderr();
  MakeLogger({}, false)->warn("late");
  const std::string line = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(line.find("warning late\n"), std::string::npos) << line;
  EXPECT_EQ(line.find('<'), std::string::npos) << line;
}

TEST_F(LoggingTest, TheFileRotates) {
  LoggingOptions options;
  options.file = directory_ / "sub" / "contourd.log";
  options.max_file_bytes = 2000;
  options.max_files = 2;
  ::testing::internal::CaptureStderr();
  {
    const auto logger = MakeLogger(options, false);
    for (int i = 0; i < 200; ++i) logger->info("line {}", i);
  }
  ::testing::internal::GetCapturedStderr();
  EXPECT_NE(Read(*options.file).find("line 199"), std::string::npos);
  EXPECT_TRUE(fs::exists(directory_ / "sub" / "contourd.1.log"));
  EXPECT_TRUE(fs::exists(directory_ / "sub" / "contourd.2.log"));
  EXPECT_FALSE(fs::exists(directory_ / "sub" / "contourd.3.log"));
  EXPECT_LE(fs::file_size(*options.file), 2000u);
}

TEST_F(LoggingTest, AFileThatCannotBeWrittenIsNamed) {
  LoggingOptions options;
  options.file = directory_;  // a directory
  try {
    MakeLogger(options, false);
    FAIL();
  } catch (const EnvironmentError& e) {
    EXPECT_NE(std::string(e.what()).find(directory_.string()), std::string::npos);
  }
}

TEST_F(LoggingTest, KnowsTheJournalByDeviceAndInodeOfStderr) {
  ::unsetenv("JOURNAL_STREAM");
  EXPECT_FALSE(StderrIsJournal());
  ::setenv("JOURNAL_STREAM", "1:2", 1);
  EXPECT_FALSE(StderrIsJournal());
  struct stat own {};
  ASSERT_EQ(::fstat(STDERR_FILENO, &own), 0);
  const std::string stream = std::to_string(own.st_dev) + ":" + std::to_string(own.st_ino);
  ::setenv("JOURNAL_STREAM", stream.c_str(), 1);
  EXPECT_TRUE(StderrIsJournal());
  ::unsetenv("JOURNAL_STREAM");
}

}  // namespace
}  // namespace contour
