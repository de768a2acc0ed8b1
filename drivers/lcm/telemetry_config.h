#pragma once

#include <string>

#include "core/visit.h"

namespace contour {

/// `telemetry:` of a machine file.
struct TelemetryConfig {
  bool publish = true;
  std::string lcm_url = "udpm://239.255.76.67:7667?ttl=0";
  bool leave_network = false;
  int batch_cycles = 50;
  int look_hz = 50;
  double flight_recorder_s = 10.0;
  std::string flight_directory;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("publish", publish, "whether telemetry goes out over LCM at all");
    v.Optional("lcm_url", lcm_url, "LCM provider; ttl=0 keeps the multicast on this machine");
    v.Optional("leave_network", leave_network,
               "true: lcm_url may have a ttl above 1, with which routers pass the telemetry on");
    v.Optional("batch_cycles", batch_cycles, Range{1, 100}, "cycles in one CONTOUR_CYCLES message");
    v.Optional("look_hz", look_hz, Range{1, 1000}, "rate of the messages meant for looking at");
    v.Optional("flight_recorder_s", flight_recorder_s, Range{0, 120},
               "seconds kept in memory, and written to a file when a fault stops the machine; 0: none");
    v.Optional("flight_directory", flight_directory,
               "where these files go; empty: the service's log directory, else the user's state directory");
  }
};

}  // namespace contour
