#pragma once

#include <cstddef>
#include <cstdint>

// Several axes side by side over one record: they differ in parameters only, so one instruction stream serves
// all of them and their latencies hide each other. Each lane's result is the same whatever runs next to it.
namespace contour::identify {

inline constexpr int kAxisLanes = 8;

/// A number of each axis.
struct alignas(64) PerLane {
  double of[kAxisLanes] = {};
};

/// One step of the linear part, and what else depends on its length.
struct LanePiece {
  PerLane flow[4][4];
  PerLane delayed[4], command[4];  ///< per N
  PerLane motor[4];                ///< per N that acts at once
  PerLane lag_left, half_step_s, inverse_step;
  PerLane own_ramp, own_bow;  ///< of the drive's own force: see PartOfPeriod_N
  bool older = false;         ///< the command is the older one
  bool ends_substep = true;   ///< the delay does not cut it
};

/// Share of all friction, and 1 over the mass that it holds.
struct LaneRubbing {
  PerLane share, per_mass;
};

struct LaneWave {
  PerLane per_m;  ///< turns of it over the motor's travel
  PerLane cosine_N, sine_N;
};

/// Of the levels: turns of the motor over its travel, polynomials of the place, harmonics.
struct LaneVariation {
  PerLane turns_per_m, middle_m, per_m;
  PerLane place[3], turn_plus[4], turn_minus[4];
};

/// One bundle of axes, as the loop takes it: plain numbers, nothing that the translations of the loop (by
/// instruction set) could share by accident.
struct AxisLanes {
  // The record.
  std::size_t rows = 0;
  std::size_t run_up = 0;  ///< of these, at the beginning: not compared
  double period_s = 0.0;
  double substep_s = 0.0;
  const double* sent_N = nullptr;      ///< command, or the offset where the drive leads
  const double* reported_N = nullptr;  ///< of a drive that leads; null elsewhere
  const double* position_m = nullptr;
  const std::uint8_t* present = nullptr;
  // Alike in all axes.
  std::size_t whole_delay = 0;
  std::size_t pieces = 0;
  const LanePiece* piece = nullptr;
  bool two_inertia = false, on_table = false;
  bool on_motor_too = false, swings = false;
  double exponent = 1.0;
  std::size_t waves = 0;
  const LaneWave* wave = nullptr;
  // The axes.
  PerLane gain[4];
  PerLane offset_N, stiffness_N_m;
  PerLane Fc_plus, Fc_minus, Fs_above_plus, Fs_above_minus, inverse_vs, s0, s1, inverse_vd, s2;
  PerLane most_bent_m;
  LaneRubbing rubbing[2];
  LaneVariation variation;
  PerLane side_stiffness, side_damping, side_per_mass, table_per_mass;  ///< 1 over the masses
  const double* own_at_N[kAxisLanes] = {};
  const double* own_mean_N[kAxisLanes] = {};
  const double* own_offset_N[kAxisLanes] = {};
  // Results, of `rows` numbers each, errors of those behind the run-up; what is null is not asked for.
  double* error_m[kAxisLanes] = {};
  double* table_m[kAxisLanes] = {};
  double* friction_N[kAxisLanes] = {};
};

/// Chooses the fastest translation that this machine has.
void RunAxisLanes(const AxisLanes& lanes);

}  // namespace contour::identify
