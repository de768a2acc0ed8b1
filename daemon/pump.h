#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "daemon/halt_keeper.h"
#include "daemon/path_feeder.h"
#include "daemon/path_planner.h"
#include "daemon/program_tally.h"
#include "daemon/rt/command_mailbox.h"
#include "daemon/rt/state_snapshots.h"
#include "daemon/rt/telemetry_queue.h"
#include "daemon/telemetry/telemetry_hub.h"

namespace contour {

/// The thread on the far side of both doors: empties the telemetry queue into the hub, writes what changed to
/// the text log, and keeps the path queue filled.
class Pump {
 public:
  Pump(TelemetryQueue& queue, CommandMailbox& mailbox, TelemetryHub& hub, double period_s,
       std::vector<std::string> axis_names, std::vector<std::string> bus_names);
  ~Pump();

  /// What switches outputs for programs. Before Start().
  void SwitchOutputsBy(ProgramOutputs& outputs) { halts_.SwitchBy(outputs); }
  /// Something else to empty on this thread, such as the truth of an emulated machine. Before Start().
  void AlsoDrain(std::function<void()> drain) { also_drain_ = std::move(drain); }
  /// Is told the totals of travel (all axes) and of time in motion. Before Start().
  void ReportMotionTo(std::function<void(double travel_m, double moving_s)> report) {
    report_motion_ = std::move(report);
  }
  /// Is shown every cycle that comes out of the queue. Before Start().
  void ShowCyclesTo(std::function<void(const CycleRecord&)> show) { show_cycle_ = std::move(show); }
  /// Copies of the cycle's state, on their way to the flight recorder. Before Start().
  void TakeSnapshotsFrom(StateSnapshots& snapshots) { snapshots_ = &snapshots; }
  void Start();
  /// Empties what is left and ends the thread.
  void Finish();

  /// Waits until this cycle, or a later one, has been shown; false when it took longer, or is unwanted.
  bool AwaitShown(std::uint64_t cycle, std::chrono::milliseconds time, const std::stop_token& unwanted) const;

  /// Supply this program's points until they are all handed over or the program is abandoned.
  /// `halts`: where it waits.
  void Supply(std::unique_ptr<PathGenerator> generator, const PacedPath::Options& options = {},
              std::vector<ProgramHalt> halts = {});
  /// The pace that the program shall go to, as PathFeeder::SetPace has it.
  void SetPace(double rate, bool resume);
  void Abandon();

  /// What the program waits for; nothing: it does not. Any thread.
  [[nodiscard]] std::optional<HaltStatus> halt() const { return halts_.status(); }
  /// Of the program that is supplied, or was last, at its own feed. Any thread.
  [[nodiscard]] PathWalk::Estimate program_duration() const { return feeder_.duration(); }
  [[nodiscard]] double program_time_share() const { return feeder_.time_share(); }
  /// Why the program that is supplied, or was last, could not go on to its end. Empty: it could. Any thread.
  [[nodiscard]] std::string program_failure() const { return feeder_.failure(); }
  /// What has come so far of the program that runs, or ran last. Any thread.
  [[nodiscard]] TallyOfProgram tally() const { return tally_.tally(); }

 private:
  void Work();
  [[nodiscard]] std::chrono::steady_clock::time_point NextRound() const;
  void Drain();
  void Feed();
  void Report(const CycleRecord& record);
  void ReportReferences(const CycleRecord& record);
  void ReportPlanning();
  void StopWhatFailed();
  void ReportFlight();
  void ReportLog();
  void MeasureMotion(const CycleRecord& record);

  TelemetryQueue& queue_;
  CommandMailbox& mailbox_;
  TelemetryHub& hub_;
  std::vector<std::string> axis_names_;
  std::vector<std::string> bus_names_;
  PathFeeder feeder_;  ///< pump thread only, but for what it says is for any
  PathPlanner planner_{feeder_};
  bool waited_for_plan_ = false;  ///< as last told
  bool failed_ = false;           ///< the program, and it has been told
  HaltKeeper halts_;              ///< pump thread only, but for status()
  ProgramTally tally_;
  std::mutex mutex_;  ///< guards the next five
  std::unique_ptr<PathGenerator> next_;
  PacedPath::Options next_options_;
  std::vector<ProgramHalt> next_halts_;
  struct Pace {
    double rate;
    bool resume;
  };
  std::optional<Pace> pace_;
  bool abandon_ = false;
  MachineState last_state_ = MachineState::kOff;
  Reason last_reason_ = Reason::kNone;
  std::uint64_t reported_drops_ = 0;
  std::uint64_t reported_log_losses_ = 0;
  std::atomic<std::uint64_t> shown_cycle_{0};
  StateSnapshots* snapshots_ = nullptr;
  std::string reported_flight_;
  std::string reported_flight_error_;
  std::function<void()> also_drain_;
  std::function<void(const CycleRecord&)> show_cycle_;
  std::function<void(double, double)> report_motion_;
  double travel_m_ = 0.0;
  std::uint64_t moving_cycles_ = 0;
  PerAxis<double> last_position_m_;
  PerAxis<ReferenceState> references_;  ///< as last told
  double period_s_;
  std::chrono::nanoseconds last_grid_time_{0};
  std::atomic<bool> finish_{false};
  std::thread thread_;
};

}  // namespace contour
