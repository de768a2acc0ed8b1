#include "config/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

namespace contour {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kPermissions = 07777;
constexpr mode_t kUsualMode = 0666;  // less the umask, as for every new file

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
  const std::string stem = target.string() + "." + std::to_string(getpid()) + ".";
  int fd = -1;
  do {
    beside = stem + std::to_string(++count) + ".new";
    fd = open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kUsualMode);
  } while (fd < 0 && errno == EEXIST);
  return fd;
}

/// /dev/stdout and its like lead to a file that somebody else has open.
bool OfTheSystem(const fs::path& file) {
  const std::string name = fs::absolute(file).lexically_normal().string();
  return name.starts_with("/dev/") || name.starts_with("/proc/");
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
  std::error_code unknown;
  const bool there = fs::exists(file, unknown);
  if (there && (OfTheSystem(file) || !fs::is_regular_file(file, unknown))) return WriteInPlace(file, text);
  const fs::path target = fs::weakly_canonical(file);
  std::string beside;
  const int fd = OpenBeside(target, beside);
  if (fd < 0 && there && (errno == EACCES || errno == EPERM)) return WriteInPlace(target, text);
  if (fd < 0) Fail(file, errno);
  int error = 0;
  if (struct stat old{}; there && stat(target.c_str(), &old) == 0) {
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
  if (error == 0 && std::rename(beside.c_str(), target.c_str()) != 0) error = errno;
  if (error != 0) {
    unlink(beside.c_str());
    Fail(file, error);
  }
  SyncDirectory(target.parent_path());
}

}  // namespace contour
