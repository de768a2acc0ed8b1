#pragma once

#include <cstdint>

#include "core/axis.h"
#include "core/can_frame.h"
#include "core/fixed_vector.h"

namespace contour {

inline constexpr std::size_t kMaxBuses = 4;
inline constexpr std::size_t kMaxFramesPerCycle = 64;
using ReceivedFrames = FixedVector<StampedFrame, kMaxFramesPerCycle>;  ///< in order of arrival
inline constexpr std::size_t kMaxPathPointsPerCycle = 8;

/// A sequenced request of an operator; acknowledged in CycleRecord by its sequence number.
enum class RequestKind : std::uint8_t {
  kNone = 0,
  kEnable = 1,     ///< Idle to Ready
  kDisable = 2,    ///< to Idle, by a stop on the path first when running
  kRun = 3,        ///< Ready to Running: the program whose points carry program_id
  kStop = 4,       ///< controlled stop on the path, then Ready. Latched: nothing overwrites it
  kReset = 5,      ///< Faulted to Idle, bringing drives up again as needed
  kTerminate = 6,  ///< as kDisable, then the loop ends
  kTune = 7,       ///< gains have been changed from this cycle on; program_id numbers the change
  kReference = 8,  ///< an axis is told where it is; program_id says which and where, see core/reference.h
};
/// Number of a change of gains that the cycle could not take: the request is refused.
inline constexpr std::uint32_t kNothingChanged = 0;

struct Request {
  RequestKind kind = RequestKind::kNone;
  std::uint32_t sequence = 0;
  std::uint32_t program_id = 0;  ///< of kRun; of kTune the number of the change
};

/// One grid point of the path of a program, all axes. What else there is to say of it stands in the log
/// beside its axes, see PathPointFields of drivers/lcm/cycle_messages.cc.
struct PathPoint {
  /// Of points that do not say where they belong: behind the one before.
  static constexpr std::uint64_t kNextIndex = ~std::uint64_t{0};
  /// Of points that do not say when they belong: the program runs at its own pace.
  static constexpr double kOwnPace = -1.0;

  std::uint32_t program_id = 0;
  bool last = false;  ///< the path ends here, at rest
  PerAxis<ReferencePoint> axes;
  std::uint64_t index = kNextIndex;  ///< number of the point, one a period from 0
  /// Number of the law of time by which the points follow one another; it begins at 0. The first point of
  /// another law takes the place of the one with its index and of all that follow.
  std::uint32_t law = 0;
  std::uint32_t line = 0;            ///< of the program's text; 0 unknown
  double program_time_s = kOwnPace;  ///< place on the program's own time axis
};

/// What the auxiliary I/O permits. Inputs can only take permission away; old data counts as open.
struct IoInput {
  bool configured = false;         ///< no I/O in the machine file: nothing below is looked at
  bool fresh = false;              ///< last poll is younger than the time-out
  bool emergency_stop_ok = false;  ///< true when the emergency-stop circuit is closed
  bool enable_chain_ok = false;
  double screw_temperature_degC = 0.0;  ///< NaN when there is no sensor
};

struct BusInput {
  bool up = true;  ///< interface is up and the last batch could be sent
  bool bus_off = false;
  std::uint32_t send_failures = 0;  ///< frames of the last batch that could not be sent
};

/// Everything the cycle takes in. The log holds exactly this, so that a run can be repeated bit for bit.
struct CycleInput {
  std::uint64_t cycle = 0;  ///< number of this grid point; skipped grid points leave a gap
  /// The grid point on the loop's clock; for records, and to tell by a frame's stamp an answer that came too
  /// late.
  std::int64_t grid_time_ns = 0;
  ReceivedFrames frames;
  FixedVector<BusInput, kMaxBuses> buses;
  FixedVector<PathPoint, kMaxPathPointsPerCycle> path;
  Request request;
  IoInput io;
};

}  // namespace contour
