#include "daemon/path_planner.h"

#include <chrono>

namespace contour {
namespace {

/// Where nothing is to be planned. Short against what is planned ahead, 128 periods at least (PacedPath).
constexpr std::chrono::milliseconds kLookAgain{2};

}  // namespace

void PathPlanner::Start() {
  thread_ = std::jthread([this](const std::stop_token& end) { Work(end); });
}

void PathPlanner::Finish() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void PathPlanner::Work(const std::stop_token& end) {
  while (!end.stop_requested()) {
    if (!feeder_.PlanStep()) std::this_thread::sleep_for(kLookAgain);
  }
}

}  // namespace contour
