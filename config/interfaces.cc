#include "config/interfaces.h"

#include <net/if.h>
#include <net/if_arp.h>

#include <algorithm>
#include <fstream>

#include "core/exit_status.h"

namespace contour {

InterfaceKind FindInterface(const std::string& interface) {
  if (if_nametoindex(interface.c_str()) == 0) return InterfaceKind::kAbsent;
  std::ifstream file("/sys/class/net/" + interface + "/type");
  int type = ARPHRD_CAN;
  // Without sysfs the socket will tell.
  file >> type;
  return !file || type == ARPHRD_CAN ? InterfaceKind::kCan : InterfaceKind::kOther;
}

bool IsVirtualCan(const std::string& interface) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  return interface.size() > 4 && interface.starts_with("vcan") &&
         std::all_of(interface.begin() + 4, interface.end(), digit);
}

void RequireInterface(const std::string& bus, const std::string& interface) {
  if (interface == "loopback") return;
  const std::string found = "buses." + bus + ".interface: found '" + interface + "', ";
  switch (FindInterface(interface)) {
    case InterfaceKind::kCan:
      return;
    case InterfaceKind::kOther:
      throw EnvironmentError(found + "which is not a CAN interface");
    case InterfaceKind::kAbsent:
      throw EnvironmentError(
          found + "but this computer has no such interface; " +
          (IsVirtualCan(interface) ? "make one: ip link add dev " + interface + " type vcan && ip link set up " + interface : "`ip link show type can` lists what there is"));
  }
}

void RequireInterfaces(const MachineConfig& config) {
  for (const auto& [name, bus] : config.buses) RequireInterface(name, bus.interface);
}

}  // namespace contour
