#include "daemon/control_socket/socket_path.h"

#include <unistd.h>

#include <cstdlib>
#include <string>

namespace contour {
namespace {

std::filesystem::path Variable(const char* name) {
  const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): read at start-up, before threads
  return value != nullptr ? value : "";
}

}  // namespace

std::filesystem::path DefaultSocketPath() {
  if (auto socket = Variable("CONTOUR_SOCKET"); !socket.empty()) return socket;
  // systemd may list several directories, colon between them; the first is the service's own.
  if (const std::string own = Variable("RUNTIME_DIRECTORY").string(); !own.empty())
    return std::filesystem::path(own.substr(0, own.find(':'))) / "control.sock";
  std::filesystem::path service = "/run/contourd/control.sock";
  if (::geteuid() == 0) return service;
  const auto user = Variable("XDG_RUNTIME_DIR");
  const auto own = user.empty() ? std::filesystem::path("/tmp/contourd-" + std::to_string(::geteuid()))
                                : user / "contourd";
  std::error_code ignored;
  const bool only_service =
      !std::filesystem::exists(own / "control.sock", ignored) && std::filesystem::exists(service, ignored);
  return only_service ? service : own / "control.sock";
}

}  // namespace contour
