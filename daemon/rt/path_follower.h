#pragma once

#include <array>
#include <cstdint>

#include "core/cycle_input.h"
#include "core/horizon.h"
#include "core/state_keeper.h"
#include "daemon/rt/path_points.h"
#include "daemon/rt/path_progress.h"
#include "daemon/rt/stop_search.h"

namespace contour {

/// A place in a program.
struct ProgramPlace {
  double time_s = 0.0;     ///< on the program's own time axis
  double pace = 0.0;       ///< program time per time
  std::uint32_t line = 0;  ///< of its text; 0 unknown
};

/// Turns the prefetched points of a program into the reference of every cycle, with a horizon ahead of it,
/// and can leave the program's own pace for a stop on the path: the pace falls from 1 to 0, the geometry is
/// kept.
///
/// Time on the path is counted in periods. At pace 1 the references are the points themselves, bit for bit;
/// off the grid they are quintic Hermite interpolations, whose velocity and acceleration follow from the pace
/// by the chain rule.
///
/// While the program runs, what is yet to come may be replaced: the first point of another law of time takes
/// the place of the point with its index, if that lies far enough ahead that neither the horizon nor a stop
/// that begins now would notice. Pauses and other feeds come this way; here they are points like any others.
class PathFollower {
 public:
  enum class StopKind : std::uint8_t {
    kShortest,     ///< by the fixed ramp at once, whatever the path asks of the axes meanwhile
    kWithinLimits  ///< within the axes' limits of acceleration and jerk, see StopSearch
  };
  /// stop_periods: length of the stop ramp. horizon: points wanted ahead of the present one, at least 3.
  PathFollower(const PerAxis<StopLimits>& limits, double period_s, double stop_periods, std::size_t horizon);

  /// Stand still here; forgets any program.
  void Hold(const PerAxis<double>& position_m) noexcept;

  /// Expect the points of this program; others are ignored.
  void Expect(std::uint32_t program_id) noexcept;
  /// Whether a law that came too late was refused shows in progress().
  void Accept(const PathPoint& point) noexcept;
  /// How many more points may come this cycle.
  [[nodiscard]] std::size_t Room() const noexcept;
  /// Enough points are here to start: the whole path, or a full horizon and a stop beyond it.
  [[nodiscard]] bool Prefetched() const noexcept;
  /// Where the expected program begins; valid when Prefetched().
  [[nodiscard]] PathPoint First() const noexcept;
  /// Begin: from the next Advance() on, the reference moves along the points.
  void Start() noexcept;
  /// Begin a stop (no effect when not moving). One that is under way ends sooner, where the shortest can.
  void BeginStop(StopKind kind) noexcept;
  /// To be called once in every cycle, at its end: looks for the stop that has been begun.
  void SearchStop() noexcept;

  /// One period further: element 1 of the horizon becomes element 0.
  void Advance() noexcept;
  /// Reference of one axis, this many points of it at most, indices as core/horizon.h.
  void Horizon(std::size_t axis, std::size_t points, AxisHorizon& out) const noexcept;
  /// Reference shortly before and after the feedback's instant, all axes, for the geometry of the contour
  /// error: offset in periods, -3..horizon.
  [[nodiscard]] ReferencePoint Near(std::size_t axis, int offset) const noexcept;
  /// Near from -reach to reach.
  void Around(std::size_t axis, int reach, AxisHorizon& out) const noexcept;

  [[nodiscard]] bool moving() const noexcept { return mode_ == Mode::kRunning || mode_ == Mode::kStopping; }
  [[nodiscard]] bool stopping() const noexcept { return mode_ == Mode::kStopping; }
  /// The program's last point has been reached.
  [[nodiscard]] bool at_end() const noexcept { return mode_ == Mode::kEnded; }
  /// A stop has come to rest.
  [[nodiscard]] bool at_rest() const noexcept { return mode_ == Mode::kHolding || mode_ == Mode::kEnded; }
  /// The supply is too short to go on and still stop on the path: begin the stop now.
  [[nodiscard]] bool running_dry() const noexcept;
  /// Time on the path of horizon element 0, in periods.
  [[nodiscard]] double path_time() const noexcept { return pace_[0].time; }
  /// Where that is in the program; all 0 while nothing is under way.
  [[nodiscard]] ProgramPlace program_place() const noexcept;
  [[nodiscard]] PathProgress progress() const noexcept;
  [[nodiscard]] std::size_t waiting() const noexcept { return static_cast<std::size_t>(end_ - first_); }

  /// Of the many points only the axes there are: a copy of the rest would hold up the drives' answers.
  void Keep(StateKeeper& keep) noexcept {
    keep(mode_, hold_m_, program_id_, expecting_, have_last_, first_, end_, begins_with_axes_, clock_, stop_,
         stop_clock_, ramp_, ramp_periods_, search_, pace_, law_, refused_law_, marks_);
    for (std::size_t i = 0; i < axes_; ++i) keep(points_[i]);
  }

 private:
  enum class Mode : std::uint8_t { kHolding, kRunning, kStopping, kEnded };
  /// What becomes of a stop: its law is looked for while the motion goes on, it is the fixed ramp, or what
  /// was found.
  enum class Stop : std::uint8_t { kSearched, kRamp, kLaw };
  static constexpr std::size_t kCapacity = kPathCapacity;
  /// What is left in front of a splice besides the reserve for a stop. The cycle that takes the first point
  /// of another law may have no place for more; those behind it wait in the queue already (PathFeeder), and
  /// each of the next cycles takes a share of them. One share covers that first cycle, and some in which none
  /// come.
  static constexpr std::uint64_t kSpliceMargin = kMaxPathPointsPerCycle;
  /// Points kept behind the present one, for the geometry of the contour error.
  static constexpr std::uint64_t kBehind = 8;

  [[nodiscard]] const ReferencePoint& At(std::size_t axis, std::uint64_t index) const noexcept {
    return points_[axis][index % kCapacity];
  }
  /// What a point says besides its axes.
  struct Mark {
    double program_time_s = PathPoint::kOwnPace;
    std::uint32_t line = 0;
  };

  [[nodiscard]] const Mark& MarkAt(std::uint64_t index) const noexcept { return marks_[index % kCapacity]; }
  [[nodiscard]] double ProgramTime_s(std::uint64_t index) const noexcept;
  [[nodiscard]] std::uint64_t IndexNow() const noexcept;
  [[nodiscard]] double Reserve() const noexcept;
  [[nodiscard]] std::uint64_t EarliestSplice() const noexcept;
  [[nodiscard]] bool TakesLaw(const PathPoint& point) noexcept;
  [[nodiscard]] ReferencePoint Evaluate(std::size_t axis, const PathPace& pace) const noexcept;
  /// Points as they are.
  void Copy(std::size_t axis, std::uint64_t first, std::size_t count, ReferencePoint* to) const noexcept;
  [[nodiscard]] PathPoints Points() const noexcept {
    return {&points_, axes_, first_, end_, have_last_, period_s_};
  }
  [[nodiscard]] std::uint64_t Point(std::int64_t element) const noexcept;
  void TakeRamp(std::int64_t element) noexcept;
  [[nodiscard]] bool short_of_points() const noexcept;
  [[nodiscard]] static PathPace OwnPace(std::int64_t clock) noexcept;
  [[nodiscard]] PathPace PaceAfter(const PathPace& before, std::int64_t clock) noexcept;
  void FillPaces() noexcept;
  [[nodiscard]] PathPace PaceAt(std::size_t j) const noexcept;
  void UpdatePaces() noexcept;
  void DropPassed() noexcept;

  std::size_t axes_;
  double period_s_;
  double stop_periods_;
  std::size_t horizon_;
  Mode mode_ = Mode::kHolding;
  PerAxis<double> hold_m_;
  std::uint32_t program_id_ = 0;
  bool expecting_ = false;
  bool have_last_ = false;
  std::uint64_t first_ = 0;  ///< oldest point kept
  std::uint64_t end_ = 0;    ///< one past the newest
  std::int64_t clock_ = 0;   ///< periods since Start() of horizon element 0
  Stop stop_ = Stop::kRamp;
  std::int64_t stop_clock_ = 0;  ///< clock of the horizon element at which the stop began
  PathPace ramp_;                ///< that it begins with
  double ramp_periods_ = 1.0;
  StopSearch search_;
  std::array<PathPace, kMaxHorizonPoints>
      pace_{};                        ///< at the program's own pace the first one only, see PaceAt
  std::size_t begins_with_axes_ = 0;  ///< of the first point
  std::uint32_t law_ = 0;             ///< of the points here
  std::uint32_t refused_law_ = 0;     ///< the last whose first point came too late; 0 none
  std::array<Mark, kCapacity> marks_{};
  PathRings points_{};
};

}  // namespace contour
