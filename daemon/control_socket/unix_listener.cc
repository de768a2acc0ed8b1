#include "daemon/control_socket/unix_listener.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "core/exit_status.h"

namespace contour {
namespace {

[[noreturn]] void Fail(const std::filesystem::path& path, const std::string& why) {
  throw EnvironmentError("control socket " + path.string() + ": " + why);
}

sockaddr_un Address(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string& name = path.native();
  if (name.size() >= sizeof address.sun_path)
    Fail(path, "the path is longer than " + std::to_string(sizeof address.sun_path - 1) + " bytes");
  std::memcpy(address.sun_path, name.c_str(), name.size() + 1);
  return address;
}

// The cast that the socket interface wants, in one place.
const sockaddr* Generic(const sockaddr_un& address) { return reinterpret_cast<const sockaddr*>(&address); }

Descriptor NewSocket(int flags) {
  return Descriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | flags, 0));
}

/// Someone listens at this path.
bool Answers(const sockaddr_un& address) {
  const Descriptor probe = NewSocket(0);
  return ::connect(probe.get(), Generic(address), sizeof address) == 0;
}

void RemoveLeftOver(const std::filesystem::path& path, const sockaddr_un& address) {
  struct stat found {};
  if (::lstat(path.c_str(), &found) != 0) return;
  if (!S_ISSOCK(found.st_mode)) Fail(path, "there is a file of that name that is no socket");
  if (Answers(address)) Fail(path, "another contourd listens there; give this one its own with --socket");
  ::unlink(path.c_str());
}

}  // namespace

Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}

UnixListener::UnixListener(std::filesystem::path path, mode_t mode)
    : path_(std::move(path)), socket_(NewSocket(SOCK_NONBLOCK)) {
  const sockaddr_un address = Address(path_);
  std::error_code error;
  if (const auto directory = path_.parent_path(); !directory.empty())
    std::filesystem::create_directories(directory, error);
  if (error) Fail(path_, "cannot make its directory: " + error.message());
  RemoveLeftOver(path_, address);
  // The mode of the descriptor is what bind gives the file, less the umask, so that at no moment is it wider
  // than asked for; chmod then adds what the umask took away.
  const bool made = ::fchmod(socket_.get(), mode) == 0 &&
                    ::bind(socket_.get(), Generic(address), sizeof address) == 0 &&
                    ::chmod(path_.c_str(), mode) == 0 && ::listen(socket_.get(), 16) == 0;
  if (!made) Fail(path_, std::strerror(errno));
}

UnixListener::~UnixListener() { ::unlink(path_.c_str()); }

Descriptor UnixListener::Accept() const noexcept {
  return Descriptor(::accept4(socket_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
}

Descriptor ConnectUnix(const std::filesystem::path& path) {
  const sockaddr_un address = Address(path);
  Descriptor socket = NewSocket(0);
  if (::connect(socket.get(), Generic(address), sizeof address) == 0) return socket;
  if (errno == ENOENT || errno == ECONNREFUSED) Fail(path, "no contourd listens there; is it running?");
  if (errno == EACCES) Fail(path, "no permission; join the group that owns it");
  Fail(path, std::strerror(errno));
}

}  // namespace contour
