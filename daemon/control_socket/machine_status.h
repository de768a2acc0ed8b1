#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/cycle_record.h"
#include "daemon/program/motion_plan.h"
#include "daemon/telemetry/cycle_health.h"
#include "daemon/telemetry/emergency_history.h"
#include "daemon/telemetry/flight_recorder.h"
#include "daemon/telemetry/foreign_traffic.h"
#include "daemon/telemetry/log_stats.h"
#include "drivers/can/frame_bus.h"
#include "drivers/lcm/publisher_stats.h"
#include "drivers/modbus/io_stats.h"

namespace contour {

struct BusStatus {
  std::string name;
  std::string interface;
  BusState state;
};

/// What a client needs to know of an axis to plan and score a program as the daemon does.
struct AxisFacts {
  PlanLimits limits;
  double encoder_count_m = 0.0;  ///< way of the table per encoder count
};

/// What a program waits for, where it stands.
struct HaltStatus {
  int line = 0;               ///< of the word
  std::string word;           ///< M0, T5 M6, M3 ...
  bool for_operator = false;  ///< until it is resumed; otherwise for an output
  std::uint64_t number = 0;   ///< another one for every wait
};

/// What a machine does with programs that say nothing else.
struct ProgramDefaults {
  bool optional_stop = false;
  bool block_delete = true;
  std::string tool_table{};            ///< its file, by its whole path; empty: none
  std::vector<std::string> outputs{};  ///< words that switch something: M3, S ...
};

/// A program's pace as operators want it.
struct PaceStatus {
  double feed_percent = 100.0;  ///< of the programmed feed; of the programs to come, too
  bool feed_fixed = false;      ///< this program runs at 100 percent of it at most
  bool pause_wanted = false;
  bool paused = false;               ///< and it has come to rest
  std::optional<HaltStatus> halt{};  ///< what the program itself waits for
};

/// Everything `contour status` shows. Axes, buses and names are in the order of the machine file.
struct MachineStatus {
  std::string machine;
  std::string version;  ///< of the program that runs
  std::string controller;
  std::string clock;  ///< "wall", "lockstep" or "virtual"
  int cycle_us = 0;
  std::optional<std::uint64_t> emulator_seed;  ///< of an emulated machine in this process
  std::vector<std::string> axis_names;
  std::vector<AxisFacts> axis_facts;  ///< one per axis
  /// What the start complained of, such as refused real time, and what lasts.
  std::vector<std::string> warnings;

  CycleRecord record;               ///< of the newest cycle
  std::string bring_up;             ///< sentence on where bring-up stands or why it failed; may be empty
  std::string reason_text;          ///< sentence on record.reason; empty when there is none
  std::string program_name;         ///< of record.program_id; may be empty
  double program_duration_s = 0.0;  ///< 0 unknown
  double program_time_share = 1.0;  ///< of what is left, at a feed above 100 %
  bool program_duration_estimated = false;  ///< it is not planned to its end yet
  double program_ran_s = 0.0;               ///< so far, pauses among it
  double contour_error_peak_m = 0.0;        ///< of this program so far, at the encoders
  double contour_error_rms_m = 0.0;
  PaceStatus pace;
  ProgramDefaults program_defaults;
  std::optional<PerAxis<double>> zero_m;  ///< where programs count from; nothing: it is not set

  std::uint64_t cycles = 0;
  std::optional<std::uint64_t> late_cycles;  ///< nothing where time is not the wall's
  std::uint64_t skipped_grid_points = 0;
  CycleHealth::Summary health;            ///< stages, causes of late cycles, feedback
  std::vector<DriveErrors> drive_errors;  ///< one per axis

  std::uint64_t dropped_entries = 0;  ///< cycles that never reached telemetry, log and clients
  std::vector<BusStatus> buses;
  IoStats io;
  PublisherStats publisher;
  LogStats log;
  FlightRecordStats flight;
  std::vector<ForeignTraffic::OnBus> foreign;  ///< one per bus; empty when nobody watches
};

/// The status as the socket carries it and `contour status --json` prints it; docs/operating.md lists the
/// keys.
nlohmann::json ToJson(const MachineStatus& status);

}  // namespace contour
