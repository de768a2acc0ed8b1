#include "config/whole_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
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

TEST_F(WholeFile, ALinkToWhereNothingIsYetStaysOne) {
  const fs::path link = directory_ / "link.yaml", second = directory_ / "second.yaml";
  fs::create_directory(directory_ / "inner");
  fs::create_symlink("inner/model.yaml", link);
  fs::create_symlink(link, second);
  WriteWholeFile(second, "new\n");
  EXPECT_TRUE(fs::is_symlink(link) && fs::is_symlink(second));
  EXPECT_EQ(ReadText(directory_ / "inner" / "model.yaml"), "new\n");
  fs::create_symlink("a", directory_ / "b");
  fs::create_symlink("b", directory_ / "a");
  EXPECT_THROW(WriteWholeFile(directory_ / "a", "x"), std::runtime_error);
}

TEST_F(WholeFile, BothNamesOfAFileShowIt) {
  WriteWholeFile(file_, "old\n");
  fs::create_hard_link(file_, directory_ / "other.yaml");
  WriteWholeFile(file_, "new\n");
  EXPECT_EQ(ReadText(directory_ / "other.yaml"), "new\n");
}

TEST_F(WholeFile, ANameIsTakenFromWhereTheProcessIs) {
  const fs::path before = fs::current_path();
  fs::current_path(directory_);
  WriteWholeFile("model.yaml", "first\n");
  WriteWholeFile("./model.yaml", "second\n");
  fs::current_path(before);
  EXPECT_EQ(ReadText(file_), "second\n");
  EXPECT_EQ(Files(), 1);
}

TEST_F(WholeFile, ANameMayBeAsLongAsNamesAre) {
  const fs::path file = directory_ / std::string(255, 'n');
  WriteWholeFile(file, "x");
  EXPECT_EQ(ReadText(file), "x");
  EXPECT_EQ(Files(), 1);
}

/// `write` as a user who is not root and owns the directory and what is in it; whether it ended well.
template <typename Write>
bool AsSomebody(const fs::path& directory, const Write& write) {
  constexpr uid_t kSomebody = 12345;
  const pid_t child = fork();
  if (child == 0) {
    if (geteuid() == 0) {
      for (const auto& entry : fs::directory_iterator(directory))
        if (lchown(entry.path().c_str(), kSomebody, kSomebody) != 0) _exit(2);
      if (lchown(directory.c_str(), kSomebody, kSomebody) != 0 || seteuid(kSomebody) != 0) _exit(2);
    }
    try {
      write();
    } catch (const std::runtime_error&) {
      _exit(1);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) != 2);
  return WEXITSTATUS(status) == 0;
}

TEST_F(WholeFile, AFileThatMayNotBeWrittenStays) {
  WriteWholeFile(file_, "old\n");
  fs::permissions(file_, fs::perms::owner_read);
  EXPECT_FALSE(AsSomebody(directory_, [&] { WriteWholeFile(file_, "new\n"); }));
  EXPECT_EQ(ReadText(file_), "old\n");
}

TEST_F(WholeFile, ADirectoryThatTakesNoNewFileKeepsTheOldOnesWritable) {
  WriteWholeFile(file_, "old\n");
  fs::permissions(directory_, fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_TRUE(AsSomebody(directory_, [&] { WriteWholeFile(file_, "new\n"); }));
  EXPECT_FALSE(AsSomebody(directory_, [&] { WriteWholeFile(directory_ / "another", "new\n"); }));
  fs::permissions(directory_, fs::perms::owner_all);
  EXPECT_EQ(ReadText(file_), "new\n");
  EXPECT_EQ(Files(), 1);
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
