#pragma once

#include <sys/types.h>

#include <filesystem>
#include <utility>

namespace contour {

/// Owns a file descriptor.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Descriptor();

  [[nodiscard]] int get() const noexcept { return fd_; }

 private:
  int fd_ = -1;
};

/// A listening Unix stream socket with the given permissions from its first moment on. The directory is made
/// when it is missing. A socket left over by a daemon that died is replaced; one that answers is not.
/// Unlinked at the end.
class UnixListener {
 public:
  /// Throws EnvironmentError with path and cause.
  UnixListener(std::filesystem::path path, mode_t mode);
  ~UnixListener();
  UnixListener(const UnixListener&) = delete;
  UnixListener& operator=(const UnixListener&) = delete;

  [[nodiscard]] int get() const noexcept { return socket_.get(); }
  /// A client, non-blocking; -1 in get() when there is none.
  [[nodiscard]] Descriptor Accept() const noexcept;

 private:
  std::filesystem::path path_;
  Descriptor socket_;
};

/// A connected socket; throws EnvironmentError with path and cause. Blocking.
Descriptor ConnectUnix(const std::filesystem::path& path);

}  // namespace contour
