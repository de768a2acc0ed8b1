#include "tests/tools/daemon_commands/scripted_machine.h"

#include <algorithm>
#include <utility>

#include "daemon/program/program.h"

namespace contour::test {

ScriptedMachine::ScriptedMachine() {
  status_.machine = "scripted";
  status_.version = "0";
  status_.controller = "mpc";
  status_.clock = "wall";
  status_.cycle_us = 1000;
  status_.late_cycles = 0;
  for (const char* name : {"x", "y"}) {
    status_.axis_names.emplace_back(name);
    status_.axis_facts.push_back({{name, -0.2, 0.2, 0.25, 5.0, 200.0}, 5e-9});
  }
  status_.buses.push_back({"main", "loopback", {}});
  status_.record.axes.resize(2);
  status_.record.state = MachineState::kIdle;
}

void ScriptedMachine::Refuse(std::string why) {
  const std::lock_guard lock(mutex_);
  refusal_ = std::move(why);
}

void ScriptedMachine::StartFor(int looks) {
  const std::lock_guard lock(mutex_);
  starting_ = looks;
  status_.record.state = MachineState::kStarting;
}

void ScriptedMachine::FailWith(Reason reason, std::string text) {
  const std::lock_guard lock(mutex_);
  fault_ = reason;
  fault_text_ = std::move(text);
}

void ScriptedMachine::FillLog() {
  const std::lock_guard lock(mutex_);
  status_.log = {.file = "run.lcmlog", .cycles = 100, .lost_cycles = 5, .last_error = "File too large"};
}

void ScriptedMachine::TellTruth(OnTruth to) {
  const std::lock_guard lock(mutex_);
  on_truth_ = std::move(to);
}

void ScriptedMachine::Attach(std::shared_ptr<RowFeed> feed) {
  const std::lock_guard lock(mutex_);
  feed_ = std::move(feed);
}

void ScriptedMachine::Detach(const std::shared_ptr<RowFeed>&) {
  const std::lock_guard lock(mutex_);
  feed_.reset();
}

MachineStatus ScriptedMachine::Status() {
  const std::lock_guard lock(mutex_);
  const MachineStatus status = status_;
  if (starting_ > 0 && --starting_ == 0) status_.record.state = MachineState::kIdle;
  return status;
}

Answer ScriptedMachine::Go(MachineState state, Reason reason) {
  const std::lock_guard lock(mutex_);
  if (!refusal_.empty()) return {false, refusal_, ++sequence_, 0, {}};
  if (starting_ > 0) return {false, "the machine is Starting", ++sequence_, 0, {}};
  const bool fault = fault_ != Reason::kNone;
  status_.record.state = fault ? MachineState::kFaulted : state;
  status_.record.reason = fault ? fault_ : reason;
  status_.reason_text = fault_text_;
  return {true, "", ++sequence_, 0, {}};
}

Answer ScriptedMachine::Pace(const PaceRequest& request) {
  const std::lock_guard lock(mutex_);
  if (!refusal_.empty()) return {false, refusal_};
  if (request.paused) {
    status_.record.state = MachineState::kRunning;
    status_.record.program_id = std::max(1U, status_.record.program_id);
    status_.pace.pause_wanted = status_.pace.paused = *request.paused;
    status_.record.pace = *request.paused ? 0.0 : 1.0;
    status_.record.path_time_s += *request.paused ? 0.0 : 1e-3;
  }
  if (request.feed_percent) status_.pace.feed_percent = *request.feed_percent;
  return {true, ""};
}

Answer ScriptedMachine::Run(const ProgramUpload& upload, const std::stop_token& /*unwanted*/) {
  Answer answer = Go(MachineState::kReady, Reason::kProgramEnd);
  if (!answer.accepted) return answer;
  const std::lock_guard lock(mutex_);
  program_ = upload.text;
  const auto format = upload.format == "ngc" ? ProgramFormat::kGcode : ProgramFormat::kYaml;
  PerAxis<PlanLimits> limits;
  for (const AxisFacts& facts : status_.axis_facts) limits.push_back(facts.limits);
  answer.start_m.push_back(0.01);
  answer.start_m.push_back(-0.02);
  answer.zero_m = answer.start_m;
  answer.program_id = ++status_.record.program_id;
  PathGenerator path(ParseProgram(upload.text, upload.name, format), answer.start_m, limits, 1e-3,
                     answer.program_id);
  CycleEntry entry;
  entry.output.record.axes.resize(2);
  PathPoint point;
  for (std::uint64_t i = 0; path.Next(point); ++i) {
    CycleRecord& r = entry.output.record;
    r.cycle = entry.input.cycle = ++status_.record.cycle;
    r.feedback_sync = r.cycle - 1;
    r.state = MachineState::kRunning;
    r.program_id = answer.program_id;
    r.path_time_s = static_cast<double>(i) * 1e-3;
    for (std::size_t a = 0; a < 2; ++a) {
      r.axes[a].reference = point.axes[a];
      r.axes[a].position_m = point.axes[a].position_m;
      r.axes[a].feedback.position_rad = point.axes[a].position_m / kRadius_m_rad;
    }
    if (on_truth_) on_truth_(r.feedback_sync, point.axes);
    if (feed_) feed_->Push(entry);
    if (!status_.log.last_error.empty()) ++status_.log.lost_cycles;
  }
  // A cycle after the program, which does not belong to it.
  entry.output.record.cycle = entry.input.cycle = ++status_.record.cycle;
  entry.output.record.state = status_.record.state;
  if (feed_) feed_->Push(entry);
  return answer;
}

}  // namespace contour::test
