#pragma once

#include <algorithm>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/control_socket/operator_desk.h"

namespace contour::test {

/// A desk that accepts or refuses as told and keeps what it was asked.
class FakeDesk final : public OperatorDesk {
 public:
  std::map<std::string, double> referenced_mm;
  std::map<std::string, std::string> loaded, torque_loops, torque_models;

  Answer Enable(const std::stop_token& unwanted) override {
    Answer answer = Do("enable");
    std::unique_lock lock(mutex_);
    answering_.wait(lock, [this] { return !held_; });
    if (unwanted.stop_requested()) asked_.emplace_back("enable was unwanted");
    return answer;
  }
  Answer Disable() override { return Do("disable"); }
  Answer Stop() override { return Do("stop"); }
  Answer Reset(const std::stop_token& /*unwanted*/) override { return Do("reset"); }
  Answer Reference(const std::map<std::string, double>& position_mm,
                   const std::stop_token& /*unwanted*/) override {
    for (const auto& [axis, at_mm] : position_mm) referenced_mm[axis] = at_mm;
    return Do("reference");
  }
  Answer Reload() override { return Do("reload"); }
  Answer LoadModel(const std::string& axis, const std::string& yaml) override {
    loaded[axis] = yaml;
    return Do("load_model");
  }
  Answer ChangeMode(const std::map<std::string, std::string>& loops,
                    const std::map<std::string, std::string>& models) override {
    torque_loops = loops;
    torque_models = models;
    return Do("torque_mode");
  }
  Answer LeaveToDrives() override { return Do("csp_mode"); }
  void Abandoned() override { Do("abandoned"); }
  Answer Run(const ProgramUpload& program, const std::stop_token& /*unwanted*/) override {
    Answer answer = Do("run");
    const std::lock_guard lock(mutex_);
    upload_ = program;
    answer.program_id = 7;
    answer.start_m.push_back(0.1);
    answer.start_m.push_back(-0.3);
    return answer;
  }
  Answer Zero() override { return Do("zero"); }
  Answer Pace(const PaceRequest& request) override {
    if (request.paused) return Do(*request.paused ? "pause" : "resume");
    {
      const std::lock_guard lock(mutex_);
      feed_percent_ = request.feed_percent.value_or(-1.0);
    }
    return Do("feed");
  }
  double feed_percent() const {
    const std::lock_guard lock(mutex_);
    return feed_percent_;
  }
  MachineStatus Status() override {
    const std::lock_guard lock(mutex_);
    ++statuses_;
    return status_;
  }
  std::string MachineFile() override { return "machine: {name: fake}\n"; }
  void Attach(std::shared_ptr<RowFeed> feed) override {
    const std::lock_guard lock(mutex_);
    feeds_.push_back(std::move(feed));
  }
  void Detach(const std::shared_ptr<RowFeed>& feed) override {
    const std::lock_guard lock(mutex_);
    std::erase(feeds_, feed);
  }

  /// From Hold(true) to Hold(false) an enabling gets no answer.
  void Hold(bool held) {
    const std::lock_guard lock(mutex_);
    held_ = held;
    answering_.notify_all();
  }
  void Refuse(std::string reason) {
    const std::lock_guard lock(mutex_);
    refusal_ = std::move(reason);
  }
  void SetStatus(MachineStatus status) {
    const std::lock_guard lock(mutex_);
    status_ = std::move(status);
  }
  std::vector<std::string> asked() const {
    const std::lock_guard lock(mutex_);
    return asked_;
  }
  ProgramUpload upload() const {
    const std::lock_guard lock(mutex_);
    return upload_;
  }
  int statuses() const {
    const std::lock_guard lock(mutex_);
    return statuses_;
  }
  std::size_t feeds() const {
    const std::lock_guard lock(mutex_);
    return feeds_.size();
  }
  void Push(const CycleEntry& entry) {
    std::vector<std::shared_ptr<RowFeed>> feeds;
    {
      const std::lock_guard lock(mutex_);
      feeds = feeds_;
    }
    for (const auto& feed : feeds) feed->Push(entry);
  }

 private:
  Answer Do(const char* what) {
    const std::lock_guard lock(mutex_);
    asked_.emplace_back(what);
    return {refusal_.empty(), refusal_, static_cast<std::uint32_t>(asked_.size()), 0, {}};
  }

  mutable std::mutex mutex_;
  std::condition_variable answering_;
  bool held_ = false;
  int statuses_ = 0;
  std::vector<std::string> asked_;
  std::vector<std::shared_ptr<RowFeed>> feeds_;
  std::string refusal_;
  ProgramUpload upload_;
  double feed_percent_ = 0.0;
  MachineStatus status_;
};

}  // namespace contour::test
