#include "daemon/pace_control.h"

#include <spdlog/spdlog.h>

#include <string>

#include "config/number_text.h"
#include "daemon/program/motion_plan.h"
#include "daemon/program/path_walk.h"
#include "daemon/program/program.h"

namespace contour {
namespace {

constexpr double kLargestFeed_percent = 100.0 * PathWalk::kLargestScale;

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
  if (running && request.feed_percent &&
      TakesYears(pump_.program_duration().duration_s - now.path_time_s, 0.01 * *request.feed_percent))
    return {false, YearsText(*request.feed_percent, "the rest of the program") + "; 0 percent holds it"};
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
  return {true, running && request.feed_percent ? NoteNow() : std::string()};
}

double PaceControl::Begin(bool may_exceed) {
  const std::lock_guard lock(mutex_);
  paused_ = false;
  may_exceed_ = may_exceed;
  return 0.01 * feed_percent_;
}

void PaceControl::RefuseYears(const std::string& program, double program_s) const {
  const std::lock_guard lock(mutex_);
  if (!TakesYears(program_s, 0.01 * feed_percent_)) return;
  throw ProgramError(program + ": " + YearsText(feed_percent_, "the program") +
                     "; contour feed sets another, 0 percent holds it");
}

std::string PaceControl::Note() const {
  const std::lock_guard lock(mutex_);
  return NoteNow();
}

std::string PaceControl::NoteNow() const {
  if (may_exceed_ || feed_percent_ <= 100.0) return {};
  return "this program runs at 100 percent of its feed, not at " + RoundedText(feed_percent_) +
         ": only G-code can be faster than programmed, and not where it is shifted by what was learnt";
}

PaceStatus PaceControl::Status(const CycleRecord& now) const {
  const std::lock_guard lock(mutex_);
  PaceStatus status;
  status.feed_percent = feed_percent_;
  status.feed_fixed = !may_exceed_;
  const bool running = now.state == MachineState::kRunning;
  // At the end of a line, too, where single block has it rest.
  status.paused = running && now.pace == 0.0 && now.path_time_s > 0.0 && (paused_ || feed_percent_ > 0.0);
  if (running) status.halt = pump_.halt();
  status.paused = status.paused || status.halt;
  status.pause_wanted = running && (paused_ || status.paused);
  return status;
}

}  // namespace contour
