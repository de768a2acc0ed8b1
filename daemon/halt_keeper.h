#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "core/cycle_record.h"
#include "daemon/control_socket/machine_status.h"
#include "daemon/program/gcode/program_halts.h"
#include "daemon/program/paced_path.h"
#include "daemon/program_outputs.h"

namespace contour {

/// Carries out what a program asks for where it halts: waits for the operator, and for outputs to be
/// switched, one after the other. The pump's thread, but for status().
class HaltKeeper {
 public:
  /// Without it nothing is switched.
  void SwitchBy(ProgramOutputs& outputs) { outputs_ = &outputs; }

  /// Another program; it runs under this number.
  void Begin(std::uint32_t program_id, std::vector<ProgramHalt> halts);
  /// Every cycle's record, in order. `ahead`: the newest halt that points have been handed out for.
  void Consume(const CycleRecord& record, const PacedPath::Halt& ahead);
  /// Again and again: outputs take their time.
  void Work();
  /// The program has to end: an output that it needs went off. True once.
  [[nodiscard]] bool TakeLoss();
  /// It waits for the operator.
  [[nodiscard]] bool holding() const;
  /// It waits, for whatever it is.
  [[nodiscard]] bool waiting() const { return Now() != nullptr; }
  /// The operator lets it go on.
  void Resume();
  /// All of it is done: the program may go on. True once for every time it is to be told.
  [[nodiscard]] bool TakeRelease();

  /// What the program waits for now. Any thread.
  [[nodiscard]] std::optional<HaltStatus> status() const;

 private:
  [[nodiscard]] const GcodeEvent* Now() const;
  void Step();
  void Tell();
  void Leave();

  ProgramOutputs* outputs_ = nullptr;
  std::uint32_t program_id_ = 0;
  std::vector<ProgramHalt> halts_;
  std::uint32_t at_ = 0;    ///< number of the halt it stands at, from 1; 0: at none
  std::uint32_t done_ = 0;  ///< halts that are over
  std::size_t event_ = 0;   ///< of the halt
  bool asked_ = false;      ///< the outputs have been told
  bool release_ = false;
  bool runs_ = false;  ///< the program's cycles have been seen
  std::uint64_t waits_ = 0;
  mutable std::mutex mutex_;  // guards the next
  std::optional<HaltStatus> status_;
};

}  // namespace contour
