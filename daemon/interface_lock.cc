#include "daemon/interface_lock.h"

#include <net/if.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>

#include "drivers/can/socketcan_bus.h"

namespace contour {
namespace {

struct Address {
  sockaddr_un address{};
  socklen_t length = 0;
  [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&address); }
};

/// The interface's own name, whichever of its names the machine file uses.
std::string OwnName(const std::string& interface) {
  std::array<char, IF_NAMESIZE> name{};
  const unsigned index = if_nametoindex(interface.c_str());
  return index != 0 && if_indextoname(index, name.data()) != nullptr ? name.data() : interface;
}

Address AddressOf(const std::string& interface) {
  const std::string name = "contourd-can-" + OwnName(interface);
  Address out;
  out.address.sun_family = AF_UNIX;
  // A zero in front: a name without a file.
  const std::size_t room = sizeof out.address.sun_path - 1;
  std::copy_n(name.begin(), std::min(name.size(), room), out.address.sun_path + 1);
  out.length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + std::min(name.size(), room));
  return out;
}

/// Whoever listens there; 0 when the kernel does not tell.
pid_t Holder(const Address& address) {
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) return 0;
  ucred who{};
  socklen_t size = sizeof who;
  const bool known = connect(fd, address.get(), address.length) == 0 &&
                     getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &who, &size) == 0;
  close(fd);
  return known ? who.pid : 0;
}

}  // namespace

InterfaceLock::InterfaceLock(const std::string& interface) {
  const Address address = AddressOf(interface);
  fd_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  // Somebody who asks who we are waits in the queue for ever; more than a few find it full and are told no
  // less.
  if (fd_ >= 0 && bind(fd_, address.get(), address.length) == 0 && listen(fd_, 8) == 0) return;
  const int error = errno;
  if (fd_ >= 0) close(fd_);
  if (error != EADDRINUSE)
    throw BusUnavailable("CAN interface " + interface + ": cannot be locked against a second contourd (" +
                         std::strerror(error) + ")");
  const pid_t holder = Holder(address);
  throw BusUnavailable("CAN interface " + interface + ": another contourd" +
                       (holder > 0 ? " (process " + std::to_string(holder) + ")" : std::string()) +
                       " commands it on this computer. Two masters on one bus would both drive the axes: end "
                       "that one first");
}

InterfaceLock::~InterfaceLock() {
  if (fd_ >= 0) close(fd_);
}

}  // namespace contour
