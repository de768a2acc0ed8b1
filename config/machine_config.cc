#include "config/machine_config.h"

#include <iterator>

namespace contour {
namespace {

template <class T>
std::vector<std::string> Keys(const std::map<std::string, T>& map) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : map) keys.push_back(key);
  return keys;
}

}  // namespace

std::vector<std::string> AxisNames(const MachineConfig& config) { return Keys(config.axes); }
std::vector<std::string> BusNames(const MachineConfig& config) { return Keys(config.buses); }

std::size_t BusIndex(const MachineConfig& config, const std::string& bus) {
  return static_cast<std::size_t>(std::distance(config.buses.begin(), config.buses.find(bus)));
}

std::int64_t SendDeadline_ns(const MachineConfig& config) {
  const std::int64_t default_us = config.machine.cycle_us / 5;
  return 1000 *
         std::int64_t{config.realtime.send_deadline_us.value_or(static_cast<std::int32_t>(default_us))};
}

}  // namespace contour
