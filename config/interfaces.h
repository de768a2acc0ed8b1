#pragma once

#include <string>
#include <vector>

#include "config/machine_config.h"

namespace contour {

/// Whether this computer has a network interface, and what kind.
enum class InterfaceKind { kAbsent, kCan, kOther };
InterfaceKind FindInterface(const std::string& interface);

/// Throws EnvironmentError, with what to do about it, unless `interface` is `loopback` or a CAN interface of
/// this computer. `bus` is the name under `buses:`.
void RequireInterface(const std::string& bus, const std::string& interface);

/// RequireInterface for every bus of a machine.
void RequireInterfaces(const MachineConfig& config);

/// vcan0, vcan1, ...: made by software, so it may well come later than the machine file.
bool IsVirtualCan(const std::string& interface);

}  // namespace contour
