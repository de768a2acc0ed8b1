#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "daemon/control_socket/machine_status.h"
#include "daemon/program/part_of_program.h"
#include "daemon/telemetry/row_feed.h"

namespace contour {

/// A program as a client uploads it.
struct ProgramUpload {
  std::string name;        ///< file name, for messages; its ending does not matter
  std::string format;      ///< "yaml" or "ngc"
  std::string text;        ///< the program itself
  std::string controller;  ///< empty: the one in use
  bool forget = false;     ///< what has been learnt of programs is forgotten first
  PartOfProgram part{};    ///< of G-code
  bool from_here = false;  ///< it counts from where the machine stands, whatever program zero is
};

/// What is to become of a program's pace; what is not said stays.
struct PaceRequest {
  std::optional<bool> paused{};
  std::optional<double> feed_percent{};  ///< of the programmed feed
};

/// What became of a request.
struct Answer {
  bool accepted = false;
  std::string reason;  ///< why it was refused, one sentence; accepted: what is to be known of it, or empty
  std::uint32_t sequence = 0;    ///< as CycleRecord::acknowledged counts; 0 when it never reached the cycle
  std::uint32_t program_id = 0;  ///< Run() only: what CycleRecord::program_id will say
  PerAxis<double> start_m{};     ///< Run() only: where the machine stood
  PerAxis<double> zero_m{};      ///< Run() only: where the program counts from
  bool zero_set = false;         ///< Run() only: there was no program zero, so it is where the machine stands
  std::size_t learnt_passes = 0;  ///< Run() only: that this program is shifted by what they taught
  double best_peak_um = 0.0;      ///< largest error that the scales saw on the best of them
};

/// What an operator may ask of the machine. The control socket calls it, the supervisor is it.
///
/// Stop() comes from one thread, Disable() from another, Status(), Attach() and Detach() from a third, and
/// all others, one at a time, from a fourth: a stop and the status do not wait for a request that waits. A
/// request returns once the cycle has accepted or refused it (not when the machine has got there: a client
/// watches the status for that), and with a refusal when the cycle does not take it within two seconds. What
/// was refused will not happen later either. Implementations do not throw; a program that cannot be read or
/// does not fit the machine is a refusal with the full message.
///
/// `unwanted`: nobody wants it any more, because whoever asked is gone or a stop came. What the cycle has not
/// been handed by then, it will not be.
class OperatorDesk {
 public:
  virtual ~OperatorDesk() = default;

  virtual Answer Enable(const std::stop_token& unwanted) = 0;
  virtual Answer Disable() = 0;
  virtual Answer Stop() = 0;
  virtual Answer Reset(const std::stop_token& unwanted) = 0;
  /// Tells axes without an absolute encoder where they stand now; the machine must be Idle.
  virtual Answer Reference(const std::map<std::string, double>& position_mm,
                           const std::stop_token& unwanted) = 0;
  /// Reads the machine file again and takes what may change while running; refused as a whole if anything
  /// else has changed. Answer::reason says in any case what came of it.
  virtual Answer Reload() = 0;
  /// Another model of an axis (the keys of `axes.<axis>.model`, as YAML; empty: the machine file's own): the
  /// daemon ends as it ends on a signal and begins anew with it, in the same process. The machine must be
  /// Idle, and is Idle again when that is done. Refused before anything ends where it could not begin.
  virtual Answer LoadModel(const std::string& axis, const std::string& yaml) = 0;
  /// Torque mode with these loops, one for each axis (the keys of `axes.<axis>.loop`, as YAML), and models of
  /// axes that they were found for, whatever the machine file says; with none, its own mode again. Begins
  /// anew as with a model. Where the drives do not come up so, in the machine file's own mode.
  virtual Answer ChangeMode(const std::map<std::string, std::string>& loops,
                            const std::map<std::string, std::string>& models) = 0;
  /// csp for all axes, whatever the machine file says, and back by ChangeMode() with none; as that otherwise.
  virtual Answer LeaveToDrives() = 0;
  /// Whoever attended the machine is gone, and its disabling is asked for: once it is Idle, its own mode is
  /// given back where it is in one for commissioning. Waits for that.
  virtual void Abandoned() = 0;
  virtual Answer Run(const ProgramUpload& program, const std::stop_token& unwanted) = 0;
  /// Programs count from where the machine stands from now on. As the next.
  virtual Answer Zero() = 0;
  /// Pause, resume and feed. Returns at once, and may be called from the thread of Status(): the status says
  /// when the machine has got there.
  virtual Answer Pace(const PaceRequest& request) = 0;
  virtual MachineStatus Status() = 0;
  /// The machine file as it was read, overrides and defaults in it: YAML that reads back as the same.
  virtual std::string MachineFile() = 0;

  /// From now on every cycle that the pump sees is pushed to this feed, until Detach().
  virtual void Attach(std::shared_ptr<RowFeed> feed) = 0;
  virtual void Detach(const std::shared_ptr<RowFeed>& feed) = 0;
};

}  // namespace contour
