#include "config/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

namespace contour {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kPermissions = 07777;
constexpr mode_t kUsualMode = 0666;       // less the umask, as for every new file
constexpr int kMostLinks = 40;            // as many as Linux follows
constexpr std::size_t kMostOfName = 200;  // of the 255 bytes of a name

[[noreturn]] void Fail(const fs::path& file, int error) {
  throw std::runtime_error("cannot write " + file.string() + ": " + std::strerror(error));
}

/// Writes all of `text` and closes `fd`; an errno, or 0. A device that cannot be synchronised is written all
/// the same.
int WriteAndClose(int fd, std::string_view text) {
  int error = 0;
  while (!text.empty() && error == 0) {
    const ssize_t n = write(fd, text.data(), text.size());
    if (n >= 0) text.remove_prefix(static_cast<std::size_t>(n));
    if (n < 0 && errno != EINTR) error = errno;
  }
  if (error == 0 && fsync(fd) != 0 && errno != EINVAL && errno != EROFS) error = errno;
  if (close(fd) != 0 && error == 0) error = errno;
  return error;
}

void WriteInPlace(const fs::path& file, std::string_view text) {
  const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kUsualMode);
  if (fd < 0) Fail(file, errno);
  if (const int error = WriteAndClose(fd, text); error != 0) Fail(file, error);
}

/// A new file beside `target`, with a name of its own; -1 and errno where there can be none.
int OpenBeside(const fs::path& target, std::string& beside) {
  static std::atomic<unsigned> count{0};
  // What is added to the name must fit, too.
  const std::string name = target.filename().string().substr(0, kMostOfName);
  const std::string stem = (target.parent_path() / name).string() + "." + std::to_string(getpid()) + ".";
  int fd = -1;
  do {
    beside = stem + std::to_string(++count) + ".new";
    fd = open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kUsualMode);
  } while (fd < 0 && errno == EEXIST);
  return fd;
}

/// Where no file can be put in another's place, though that one may be written to: a directory that takes no
/// new one, a file that something is mounted on.
bool TakesNoOther(int error) {
  return error == EACCES || error == EPERM || error == EROFS || error == EBUSY || error == EXDEV;
}

/// /dev/stdout and its like lead to a file that somebody else has open. /dev/shm holds files as any other.
bool OfTheSystem(const fs::path& file) {
  const std::string name = file.string();
  return (name.starts_with("/dev/") && !name.starts_with("/dev/shm/")) || name.starts_with("/proc/");
}

/// The file that a name leads to, whether it is there or not; one of the system is not looked behind.
fs::path LedTo(const fs::path& file) {
  fs::path at = fs::absolute(file);
  for (int links = 0; links < kMostLinks; ++links) {
    at = fs::weakly_canonical(at.parent_path()) / at.filename();
    std::error_code unknown;
    if (OfTheSystem(at) || !fs::is_symlink(fs::symlink_status(at, unknown))) return at;
    // A target that begins at the root replaces the directory.
    at = at.parent_path() / fs::read_symlink(at);
  }
  Fail(file, ELOOP);
}

/// Whether another file may take the place of the one that is there.
bool MayBeReplaced(const fs::path& target, const struct stat& old) {
  return !OfTheSystem(target) && S_ISREG(old.st_mode) && old.st_nlink == 1;
}

/// The new name must outlive a power failure, too.
void SyncDirectory(const fs::path& directory) {
  const int fd = open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  fsync(fd);
  close(fd);
}

}  // namespace

void WriteWholeFile(const fs::path& file, std::string_view text) {
  const fs::path target = LedTo(file);
  struct stat old {};
  const bool there = stat(target.c_str(), &old) == 0;
  // A file that nobody may write to stays as it is, whatever its directory takes.
  if (there && faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0) Fail(file, errno);
  if (there && !MayBeReplaced(target, old)) return WriteInPlace(target, text);
  std::string beside;
  const int fd = OpenBeside(target, beside);
  if (fd < 0 && there && TakesNoOther(errno)) return WriteInPlace(target, text);
  if (fd < 0) Fail(file, errno);
  int error = 0;
  if (there) {
    // Somebody else's file stays theirs.
    if (fchown(fd, old.st_uid, old.st_gid) != 0) {
      close(fd);
      unlink(beside.c_str());
      return WriteInPlace(target, text);
    }
    if (fchmod(fd, old.st_mode & kPermissions) != 0) error = errno;
  }
  const int written = WriteAndClose(fd, text);
  if (error == 0) error = written;
  const bool written_whole = error == 0;
  if (written_whole && std::rename(beside.c_str(), target.c_str()) != 0) error = errno;
  if (error != 0) {
    unlink(beside.c_str());
    if (there && written_whole && TakesNoOther(error)) return WriteInPlace(target, text);
    Fail(file, error);
  }
  SyncDirectory(target.parent_path());
}

}  // namespace contour
