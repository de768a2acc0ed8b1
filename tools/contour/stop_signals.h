#pragma once

#include <atomic>

namespace contour {

/// From now on SIGINT, SIGTERM and SIGHUP set StopRequested(), for whoever has a machine moving, and end
/// nothing by themselves; neither does output that nobody reads any more.
void StopOnSignals();

/// Set from a signal handler.
std::atomic<bool>& StopRequested();

}  // namespace contour
