#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/control_socket/operator_desk.h"
#include "daemon/program/path_generator.h"

namespace contour::test {

/// Stands for the daemon behind the control socket: two axes that follow every program exactly, at once, with
/// a motor of 5 mm lead; it can be told to refuse, or to end in a fault.
class ScriptedMachine final : public OperatorDesk {
 public:
  ScriptedMachine();

  Answer Enable(const std::stop_token&) override { return Go(MachineState::kReady, Reason::kNone); }
  Answer Disable() override { return Go(MachineState::kIdle, Reason::kDisableRequest); }
  Answer Stop() override { return Go(MachineState::kReady, Reason::kOperatorStop); }
  Answer Reference(const std::map<std::string, double>& position_mm,
                   const std::stop_token& /*unwanted*/) override {
    for (const auto& [axis, at_mm] : position_mm) referenced_mm[axis] = at_mm;
    return {true, ""};
  }
  std::map<std::string, double> referenced_mm;
  Answer Reload() override { return {true, "nothing has changed"}; }
  Answer LoadModel(const std::string& /*axis*/, const std::string& /*yaml*/) override { return {true, ""}; }
  Answer ChangeMode(const std::map<std::string, std::string>& /*loops*/,
                    const std::map<std::string, std::string>& /*models*/) override {
    return {true, ""};
  }
  Answer LeaveToDrives() override { return {true, ""}; }
  void Abandoned() override {}
  Answer Reset(const std::stop_token&) override { return Go(MachineState::kIdle, Reason::kNone); }
  Answer Run(const ProgramUpload& upload, const std::stop_token&) override;
  Answer Zero() override { return Go(MachineState::kReady, Reason::kNone); }
  Answer Pace(const PaceRequest& request) override;
  MachineStatus Status() override;
  std::string MachineFile() override { return {}; }
  void Attach(std::shared_ptr<RowFeed> feed) override;
  void Detach(const std::shared_ptr<RowFeed>& feed) override;

  void Refuse(std::string why);
  /// Its drives come up: it is Starting, and refuses, for so many looks at its status.
  void StartFor(int looks);
  /// Text of the program that ran last.
  [[nodiscard]] std::string program() {
    const std::lock_guard lock(mutex_);
    return program_;
  }
  /// Requests are accepted and lead to this fault.
  void FailWith(Reason reason, std::string text);
  /// Its log is full: it loses the cycles of every program to come, and has lost some before.
  void FillLog();
  /// Takes a line of the truth of every cycle run: sync_number and both axes' angles and positions. Called by
  /// the thread that carries out the request.
  using OnTruth = std::function<void(std::uint64_t sync, const PerAxis<ReferencePoint>& axes)>;
  void TellTruth(OnTruth to);

  static constexpr double kRadius_m_rad = 5e-3 / 6.283185307179586;

 private:
  Answer Go(MachineState state, Reason reason);

  std::mutex mutex_;
  MachineStatus status_;
  std::string refusal_;
  int starting_ = 0;
  std::string program_;
  Reason fault_ = Reason::kNone;
  std::string fault_text_;
  std::shared_ptr<RowFeed> feed_;
  OnTruth on_truth_;
  std::uint32_t sequence_ = 0;
};

}  // namespace contour::test
