#pragma once

#include <cstdint>
#include <string>

namespace contour {

/// How sending telemetry went so far.
struct PublisherStats {
  bool enabled = false;
  std::uint64_t messages = 0;  ///< handed to the network
  std::uint64_t failures = 0;  ///< messages that could not be sent
  std::string last_error;      ///< empty while nothing has failed
};

}  // namespace contour
