#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "daemon/control_socket/control_client.h"

namespace contour {

/// A connection to the daemon that begins anew where another has ended, and answers. While the old one
/// closes, its socket may still take a connection that nobody serves. `connect` throws EnvironmentError when
/// nobody listens; throws std::runtime_error at the deadline, and once the old one's process, in which the
/// new one begins, has ended.
std::unique_ptr<ControlClient> ConnectToNewDaemon(const std::function<ControlClient()>& connect,
                                                  const Descriptor& process,
                                                  std::chrono::steady_clock::time_point deadline);

/// The daemon refuses to begin anew, and why; it goes on as it is.
class BeginRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Has the daemon begin anew (`request` is a load_model or torque_mode) and waits until it is Idle. It may
/// begin anew twice, where what was asked for does not come up. Throws BeginRefused, or std::runtime_error at
/// the deadline; `client` is the last connection.
void BeginAnew(std::unique_ptr<ControlClient>& client, const nlohmann::json& request,
               const std::function<ControlClient()>& connect, std::chrono::steady_clock::time_point deadline);

}  // namespace contour
