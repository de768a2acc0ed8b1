#pragma once

#include <string>

namespace contour {

/// One contourd commands a CAN interface of this computer. Held from construction to destruction, also when
/// the process is killed: it is the name of a Unix socket without a file, so anybody may take it and nothing
/// is left over. Such names belong to a network namespace, as CAN interfaces do.
class InterfaceLock {
 public:
  /// Throws BusUnavailable when another process has it, with its number where the kernel tells it.
  explicit InterfaceLock(const std::string& interface);
  ~InterfaceLock();
  InterfaceLock(const InterfaceLock&) = delete;
  InterfaceLock& operator=(const InterfaceLock&) = delete;

 private:
  int fd_ = -1;
};

}  // namespace contour
