#pragma once

#include <stdexcept>

namespace contour {

/// Exit status of every program.
enum ExitStatus : int {
  kExitDone = 0,
  kExitFailed = 1,       ///< it ran and failed (a fault)
  kExitBadUsage = 2,     ///< bad usage or configuration
  kExitEnvironment = 3,  ///< the environment lacks something; the message names it
};

/// Thrown at start-up when the environment lacks something: no such bus, no permission. Becomes
/// kExitEnvironment.
class EnvironmentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace contour
