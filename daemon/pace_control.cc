#include "daemon/pace_control.h"

#include <spdlog/spdlog.h>

#include <string>

#include "config/number_text.h"

namespace contour {
namespace {

/// Beyond the programmed feed a program would have to be planned anew.
constexpr double kLargestFeed_percent = 100.0;

}  // namespace

Answer PaceControl::Change(const PaceRequest& request, const CycleRecord& now) {
  const bool running = now.state == MachineState::kRunning;
  if (request.paused && !running)
    return {false, "the machine is " + std::string(Name(now.state)) + "; there is no program to " +
                       (*request.paused ? "pause" : "go on with")};
  if (request.feed_percent &&
      !(*request.feed_percent >= 0.0 && *request.feed_percent <= kLargestFeed_percent))
    return {false, "found " + RoundedText(*request.feed_percent) + " percent, expected 0 to " +
                       RoundedText(kLargestFeed_percent)};
  const std::lock_guard lock(mutex_);
  if (request.feed_percent) {
    feed_percent_ = *request.feed_percent;
    spdlog::info("feed {} %", RoundedText(feed_percent_));
  }
  if (request.paused) {
    paused_ = *request.paused;
    spdlog::info(paused_ ? "pause" : "resume");
  }
  if (running) pump_.SetPace(paused_ ? 0.0 : 0.01 * feed_percent_, request.paused == false);
  return {true, {}};
}

double PaceControl::Begin() {
  const std::lock_guard lock(mutex_);
  paused_ = false;
  return 0.01 * feed_percent_;
}

PaceStatus PaceControl::Status(const CycleRecord& now) const {
  const std::lock_guard lock(mutex_);
  PaceStatus status;
  status.feed_percent = feed_percent_;
  const bool running = now.state == MachineState::kRunning;
  // At the end of a line, too, where single block has it rest.
  status.paused = running && now.pace == 0.0 && now.path_time_s > 0.0 && (paused_ || feed_percent_ > 0.0);
  if (running) status.halt = pump_.halt();
  status.paused = status.paused || status.halt;
  status.pause_wanted = running && (paused_ || status.paused);
  return status;
}

}  // namespace contour
