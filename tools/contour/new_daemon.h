#pragma once

#include <chrono>
#include <functional>
#include <memory>

#include "daemon/control_socket/control_client.h"

namespace contour {

/// A connection to the daemon that begins anew where another has ended, and answers. While the old one
/// closes, its socket may still take a connection that nobody serves. `connect` throws EnvironmentError when
/// nobody listens; throws std::runtime_error at the deadline.
std::unique_ptr<ControlClient> ConnectToNewDaemon(const std::function<ControlClient()>& connect,
                                                  std::chrono::steady_clock::time_point deadline);

}  // namespace contour
