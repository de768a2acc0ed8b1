#pragma once

#include <cstddef>
#include <cstdint>

#include "tools/diagnosis/lanes.h"

namespace contour::diagnosis {

/// One bundle of runs, as the loops take it: plain arrays, nothing that the two translations of the loops
/// (baseline and AVX2; the same operations in the same order, so the same bits) could share by accident.
struct Lanes {
  std::size_t rows = 0;
  int substeps = 0;
  double period_s = 0.0;
  const double* torque[kLanes] = {};  ///< per sub-step
  const double* late[kLanes] = {};    ///< per row, see DeliveredMeans
  const double* motor[kLanes] = {};
  const double* load[kLanes] = {};
  const double* level[kLanes] = {};
  const double* viscous[kLanes] = {};
  const double* reading[kLanes] = {};
  const double* measured = nullptr;
  const std::uint8_t* valid = nullptr;
  Vec inv_motor, inv_load, inv_payload, stiffness, damping, half_gap;
  VecBits payload_row;
  Vec Fc_plus, Fc_minus, dF_plus, dF_minus, inv_vs, s0, s1, inv_vd, s2, smallest, offset, gain, saturation,
      start_z;
  Vec soft_level, soft_s0;
  double l[4] = {};
  double start_q = 0.0, start_w = 0.0;
  bool square = false, full = false, trace = false;
  bool two = false, on_load = false, soft = false, fading = false;  ///< which of the loops
  double* innovation[kLanes] = {};
  double* table[kLanes] = {};
  double* velocity[kLanes] = {};
  double* friction[kLanes] = {};
};

inline constexpr int kMostSubsteps = 32;

void RunLanesBaseline(const Lanes& m);
void RunLanesAvx2(const Lanes& m);

}  // namespace contour::diagnosis
