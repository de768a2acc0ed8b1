#pragma once

#include <array>
#include <cstdint>

#include "daemon/rt/path_points.h"

namespace contour {

/// What an axis may do while it comes to rest on the path. 0: not limited.
struct StopLimits {
  double acceleration_m_s2 = 0.0;
  double jerk_m_s3 = 0.0;
};

/// The fixed ramp of a stop: the rate falls from 1 as 1 - (3 s^2 - 2 s^3), s the time since it began over its
/// length, both in periods. From another pace it is the cubic that begins with that rate and its change.
PathPace StopRamp(const PathPace& from, double since, double length) noexcept;

/// Looks for a law of time that brings a path to rest and keeps every axis's limits of acceleration and jerk
/// at each grid point, whatever the path does meanwhile: at the rate r an axis has the acceleration
/// r^2 a + r' v, and its jerk r^3 j + 3 r r' a + r'' v leaves r'' only so much room.
///
/// The fixed ramp is taken where it fits. Else r'' is chosen from period to period: as the shape of the ramp
/// wants it, within what the axes leave. Where they leave nothing the rate has been falling too steeply
/// there: it is looked for again, less steep at that place of the path, then with a gentler shape, then from
/// a later point on. What a cycle spends on this is counted, so that it is bounded and the same in a replay.
class StopSearch {
 public:
  /// Differences of acceleration from one grid point to the next are kept to this factor of the limit.
  static constexpr double kWithin = 1.01;

  StopSearch(const PerAxis<StopLimits>& limits, double period_s, double ramp_periods);

  enum class Found : std::uint8_t { kNotYet, kRamp, kLaw, kNothing };
  void Begin(std::uint64_t earliest) noexcept;
  /// One cycle's share of the search. A law that is found begins at the point begin(), not before `earliest`.
  [[nodiscard]] Found Work(const PathPoints& path, std::uint64_t earliest) noexcept;
  [[nodiscard]] std::uint64_t begin() const noexcept { return begin_; }
  /// The law that was found, a period further; its end has the rate 0.
  [[nodiscard]] PathPace After(const PathPoints& path, const PathPace& pace) noexcept;
  /// Periods from begin() to rest.
  [[nodiscard]] std::uint32_t length() const noexcept { return steps_; }

 private:
  static constexpr std::size_t kPlaces = 8;
  /// A place of the path at which the rate may fall no faster than this.
  struct Place {
    double time = 0.0;
    double fall = 0.0;
  };
  struct Motion {
    double velocity = 0.0, acceleration = 0.0, jerk = 0.0;  ///< of the path, per period
  };
  enum class Step : std::uint8_t { kGoesOn, kAtRest, kFails };

  [[nodiscard]] bool Try(const PathPoints& path, std::uint64_t earliest) noexcept;
  [[nodiscard]] bool Gentler() noexcept;
  [[nodiscard]] Step TryRamp(const PathPoints& path) noexcept;
  [[nodiscard]] Step TryLaw(const PathPoints& path) noexcept;
  bool Look(const PathPoints& path, double time) noexcept;
  void TakeAccelerations(const PathPace& pace) noexcept;
  [[nodiscard]] bool Rests(const PathPace& pace) const noexcept;
  [[nodiscard]] double Wanted(const PathPace& pace) const noexcept;
  [[nodiscard]] double Allowed(const PathPace& next, double bend, double wanted) const noexcept;
  [[nodiscard]] PathPace Onward(const PathPoints& path, const PathPace& pace) noexcept;
  [[nodiscard]] bool Keeps(const PathPoints& path, const PathPace& from, const PathPace& to) noexcept;
  [[nodiscard]] bool Own(const PathPoints& path, std::size_t axis, double from, double to) noexcept;

  std::size_t axes_;
  double ramp_periods_;
  PerAxis<double> acceleration_m_;  ///< limits per period^2 and ^3
  PerAxis<double> jerk_m_;
  std::uint64_t since_ = 0;  ///< the search began
  std::uint64_t begin_ = 0;  ///< of what is being tried
  bool trying_ = false;
  bool ramp_ = false;  ///< it is the fixed ramp
  std::uint32_t gentler_ = 0;
  std::uint32_t tries_ = 0;  ///< of this shape
  std::uint32_t steps_ = 0;
  std::uint32_t work_ = 0;  ///< axes looked at in this cycle
  PathPace pace_;
  std::array<Place, kPlaces> places_{};
  std::size_t place_count_ = 0;
  std::array<Motion, kMaxAxes> motion_{};        ///< at the place looked at last
  std::array<double, kMaxAxes> acceleration_{};  ///< of the axes, at the pace reached
};

}  // namespace contour
