#include "daemon/pace_control.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <string>
#include <utility>

#include "config/number_text.h"
#include "daemon/program/motion_plan.h"
#include "daemon/program/path_walk.h"
#include "daemon/program/program.h"

namespace contour {
namespace {

constexpr double kLargestFeed_percent = 100.0 * PathWalk::kLargestScale;

}  // namespace

Answer PaceControl::Change(const PaceRequest& request, const std::function<CycleRecord()>& newest) {
  const std::lock_guard lock(mutex_);
  const CycleRecord now = newest();
  const bool running = now.state == MachineState::kRunning || begins_;
  if (request.paused && !running)
    return {false, "the machine is " + std::string(Name(now.state)) + "; there is no program to " +
                       (*request.paused ? "pause" : "go on with")};
  if (request.feed_percent &&
      !(*request.feed_percent >= 0.0 && *request.feed_percent <= kLargestFeed_percent))
    return {false, "found " + RoundedText(*request.feed_percent) + " percent, expected 0 to " +
                       RoundedText(kLargestFeed_percent)};
  if (running && request.feed_percent && TakesYears(Left_s(now), 0.01 * *request.feed_percent))
    return {false, YearsText(*request.feed_percent, "the rest of the program") + "; 0 percent holds it"};
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

// Where the program has only begun, the pump may not have got to it yet and still tell of the one before.
double PaceControl::Left_s(const CycleRecord& now) const {
  if (begins_) return program_s_;
  return std::max(program_s_, pump_.program_duration().duration_s) - now.path_time_s;
}

void PaceControl::Begin(const std::string& program, std::unique_ptr<PathGenerator> generator,
                        PacedPath::Options options, std::vector<ProgramHalt> halts) {
  const double program_s = EstimatedDuration_s(*generator->plan());
  const std::lock_guard lock(mutex_);
  RefuseYearsNow(program, program_s);
  paused_ = false;
  may_exceed_ = generator->feed_may_exceed();
  program_s_ = program_s;
  begins_ = true;
  options.feed = 0.01 * feed_percent_;
  pump_.Supply(std::move(generator), options, std::move(halts));
}

void PaceControl::Begun() {
  const std::lock_guard lock(mutex_);
  begins_ = false;
}

void PaceControl::RefuseYears(const std::string& program, double program_s) const {
  const std::lock_guard lock(mutex_);
  RefuseYearsNow(program, program_s);
}

void PaceControl::RefuseYearsNow(const std::string& program, double program_s) const {
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
