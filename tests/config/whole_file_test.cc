#include "config/whole_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "tests/config/test_files.h"

namespace contour {
namespace {

namespace fs = std::filesystem;

class WholeFile : public ::testing::Test {
 protected:
  WholeFile() { fs::create_directory(directory_); }
  ~WholeFile() override { fs::remove_all(directory_); }

  std::ptrdiff_t Files() const {
    return std::distance(fs::directory_iterator(directory_), fs::directory_iterator());
  }

  fs::path directory_ = ::testing::TempDir() + "whole_file_" + std::to_string(getpid());
  fs::path file_ = directory_ / "model.yaml";
};

/// No file may grow beyond so many bytes, as on a disk that is full; writing tells, it does not kill.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit less{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &less);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int) = SIG_DFL;
};

TEST_F(WholeFile, StandsThereAloneWithAllOfIt) {
  WriteWholeFile(file_, "first\n");
  EXPECT_EQ(ReadText(file_), "first\n");
  WriteWholeFile(file_, "second, longer\n");
  WriteWholeFile(file_, "3\n");
  EXPECT_EQ(ReadText(file_), "3\n");
  EXPECT_EQ(Files(), 1);
}

TEST_F(WholeFile, AFailedWriteLeavesTheOldOne) {
  WriteWholeFile(file_, "old\n");
  std::string why;
  try {
    const FullDisk full(1000);
    WriteWholeFile(file_, std::string(2000, 'x'));
  } catch (const std::runtime_error& e) {
    why = e.what();
  }
  EXPECT_EQ(why, "cannot write " + file_.string() + ": File too large");
  EXPECT_EQ(ReadText(file_), "old\n");
  EXPECT_EQ(Files(), 1) << "something was left beside it";
}

TEST_F(WholeFile, NamesWhatCannotBeWritten) {
  EXPECT_THROW(WriteWholeFile(directory_ / "missing" / "model.yaml", "x"), std::runtime_error);
  EXPECT_THROW(WriteWholeFile(directory_, "x"), std::runtime_error);
}

TEST_F(WholeFile, ALinkStaysALink) {
  const fs::path link = directory_ / "link.yaml";
  WriteWholeFile(file_, "old\n");
  fs::create_symlink("model.yaml", link);
  WriteWholeFile(link, "new\n");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(ReadText(file_), "new\n");
}

TEST_F(WholeFile, PermissionsStay) {
  WriteWholeFile(file_, "old\n");
  fs::permissions(file_, fs::perms::owner_read | fs::perms::owner_write);
  WriteWholeFile(file_, "new\n");
  EXPECT_EQ(fs::status(file_).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(WholeFile, TheOwnerStays) {
  if (geteuid() != 0) GTEST_SKIP() << "only root writes somebody else's file";
  WriteWholeFile(file_, "old\n");
  constexpr uid_t kSomebody = 12345;
  ASSERT_EQ(chown(file_.c_str(), kSomebody, kSomebody), 0);
  WriteWholeFile(file_, "new\n");
  struct stat now {};
  ASSERT_EQ(stat(file_.c_str(), &now), 0);
  EXPECT_EQ(now.st_uid, kSomebody);
  EXPECT_EQ(now.st_gid, kSomebody);
  EXPECT_EQ(ReadText(file_), "new\n");
}

TEST_F(WholeFile, ADeviceStaysADevice) {
  WriteWholeFile("/dev/null", "x");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

}  // namespace
}  // namespace contour
