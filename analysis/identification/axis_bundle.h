#pragma once

#include <array>
#include <vector>

#include "analysis/identification/linear_step.h"
#include "analysis/identification/own_force.h"
#include "analysis/identification/simd/axis_lanes.h"
#include "analysis/identification/simulation.h"

namespace contour::identify {

/// An axis with what its steps need, worked out once for all records.
class LaneAxis {
 public:
  LaneAxis(const Followed& followed, double period_s);

  [[nodiscard]] const TableAxis& axis() const { return axis_; }
  /// Whether one instruction stream serves both.
  [[nodiscard]] bool RunsWith(const LaneAxis& other) const;

 private:
  friend class AxisBundle;
  /// A mass on a spring on the table.
  struct Swinging {
    double mass_kg = 0.0, stiffness_N_m = 0.0, damping_Ns_m = 0.0;
  };
  TableAxis axis_;
  FollowGain gain_;
  double period_s_;
  int substeps_;
  Swinging side_;
  TableAxis stiff_;  ///< without what swings
  PeriodSteps steps_;
  double on_motor_ = 0.0;  ///< share of the friction
};

/// Up to kAxisLanes axes that run together. Lanes without one repeat the first.
class AxisBundle {
 public:
  explicit AxisBundle(const std::vector<const LaneAxis*>& axes);
  AxisBundle(const AxisBundle&) = delete;
  AxisBundle& operator=(const AxisBundle&) = delete;

  /// Where a lane's results go, each as long as the record; null: not asked for (the last two, in all lanes).
  struct Results {
    double* error_m = nullptr;
    double* table_m = nullptr;
    double* friction_N = nullptr;
  };
  void SetLane(std::size_t lane, const OwnForce* own, const Results& results);
  void Run(const Measured& data);
  /// As Run() has set them.
  [[nodiscard]] const AxisLanes& lanes() const { return lanes_; }

 private:
  void TakePieces();
  void TakeFriction();
  void TakeVariation();
  void TakeWaves();
  /// Of every lane.
  template <class Number>
  void Fill(PerLane& to, const Number& number) const {
    for (std::size_t lane = 0; lane < kAxisLanes; ++lane) to.of[lane] = number(*axes_[lane]);
  }

  std::size_t members_;
  std::array<const LaneAxis*, kAxisLanes> axes_;
  std::array<const OwnForce*, kAxisLanes> own_{};
  std::array<Results, kAxisLanes> results_{};
  std::vector<LanePiece> pieces_;
  std::vector<LaneWave> waves_;
  AxisLanes lanes_;
};

}  // namespace contour::identify
