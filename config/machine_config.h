#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/learning_config.h"
#include "config/logging_config.h"
#include "config/memory_config.h"
#include "config/model_config.h"
#include "config/realtime_config.h"
#include "control/control_config.h"
#include "core/controller_name.h"
#include "core/loop_limits.h"
#include "core/loop_tuning.h"
#include "core/visit.h"
#include "drivers/cia402/drive_config.h"
#include "drivers/lcm/telemetry_config.h"
#include "drivers/modbus/io_config.h"
#include "estimator/estimator_config.h"

namespace contour {

/// What machine.path_tolerance_mm is at least where the file states none.
constexpr double kUsualPathTolerance_mm = 0.01;
/// The most that machine.path_following_mm may be.
constexpr double kMostPathFollowing_mm = 10.0;

/// `machine:` of a machine file.
struct MachineSection {
  std::string name;
  std::int32_t cycle_us = 1000;
  ControllerName controller = ControllerName::kFull;
  std::optional<double> path_tolerance_mm;
  std::optional<double> path_following_mm;
  bool slow_for_tolerance = true;
  bool optional_stop = false;
  bool block_delete = true;
  std::string tool_table;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("name", name, "name of the machine, in telemetry and logs");
    v.Optional("cycle_us", cycle_us, Range{250, 20000}, "period of the cycle");
    v.Optional("controller", controller, "controller used unless another is asked for");
    v.Optional("path_tolerance_mm", path_tolerance_mm, kPositive,
               "how far the table may leave the path of a program that does not say so itself: corners of "
               "G-code with G0 and with G64 without P, of squares without corners; none: 0.01, or twice "
               "path_following_mm where that is more");
    v.Optional(
        "path_following_mm", path_following_mm, Range{0.0, kMostPathFollowing_mm},
        "how far the table may be from the path that it is to follow, in corners and while friction is "
        "still being learnt: planned paths keep so much of the tolerance free, but half of it at most; "
        "none: what is expected of the axes' loops and screws, which `contour check` prints");
    v.Optional("slow_for_tolerance", slow_for_tolerance,
               "G-code whose tolerance leaves less for the machine than its screws are expected to be off by "
               "under the axes' full acceleration has so much less of acceleration and jerk");
    v.Optional("optional_stop", optional_stop, "M1 of a program waits for the operator, as M0 does");
    v.Optional("block_delete", block_delete, "lines of G-code that begin with a slash are left out");
    v.Optional(
        "tool_table", tool_table,
        "file with the tools that G43 takes lengths from, as LinuxCNC writes it (T1 P1 Z42.5 a line, mm), "
        "beside this file; read anew for every program");
  }
};

/// `axes.<name>` of a machine file.
struct AxisConfig {
  DriveConfig drive;
  AxisLimits limits;
  ModelConfig model;
  std::optional<LoopTuning> loop;
  std::optional<LoopTuning> scale_loop;
  LoopLimits loop_limits;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("drive", drive, "the CiA 402 drive of this axis");
    v.Required("limits", limits, "what the axis may do");
    v.Required("model", model, "what is believed of the axis; or the name of a file that holds it");
    v.Optional(
        "loop", loop,
        "tuning of the two-inertia loop, as `contour tune --from-model` finds it; or the name of a file that "
        "holds it");
    v.Optional("scale_loop", scale_loop,
               "the same with the linear scale in the loop, which then controls the table; `loop` holds the "
               "axis when the scale fails");
    v.Optional("loop_limits", loop_limits, "what the two-inertia loop must bear");
  }
};

/// A whole machine file but for `emulator:`, which the daemon does not read. Axes and buses are numbered in
/// the order of their names.
struct MachineConfig {
  MachineSection machine;
  RealtimeConfig realtime;
  std::map<std::string, BusConfig> buses;
  IoConfig io;
  TelemetryConfig telemetry;
  LoggingConfig logging;
  MemoryConfig memory;
  LearningConfig learning;
  ControllerConfig control;
  EstimatorConfig estimator;
  std::map<std::string, AxisConfig> axes;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("machine", machine, "name, cycle and controller");
    v.Optional("realtime", realtime, "what the cycle's thread asks of the kernel");
    v.Required("buses", buses, "CAN buses by name");
    v.Optional("io", io, "auxiliary inputs and outputs");
    v.Optional("telemetry", telemetry, "LCM telemetry");
    v.Optional("logging", logging, "messages for people");
    v.Optional("memory", memory, "what is learnt of the machine and kept for the next start");
    v.Optional("learning", learning, "what a program's next pass learns from the last one");
    v.Optional("control", control, "tuning of the controllers");
    v.Optional("estimator", estimator, "tuning of the estimators, the same for all axes");
    v.Required("axes", axes, "axes by name");
  }
};

/// Names in the order of their numbers.
std::vector<std::string> AxisNames(const MachineConfig& config);
std::vector<std::string> BusNames(const MachineConfig& config);

/// Number of a bus; buses.size() when there is none of that name.
std::size_t BusIndex(const MachineConfig& config, const std::string& bus);

/// send_deadline_us of the file, or 20 % of the period.
std::int64_t SendDeadline_ns(const MachineConfig& config);

}  // namespace contour
