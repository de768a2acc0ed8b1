#pragma once

#include <cstddef>
#include <cstdint>

#include "analysis/prediction_error/simd/lanes.h"

namespace contour::diagnosis {

/// A number per row (or sub-step) and lane.
struct LaneRow {
  const double* at[kLanes] = {};
  bool alike = false;  ///< all lanes read the same, which need be read only once
};

/// What acts over a row, taken as linear inside it: value at its beginning and at its end.
struct LaneSignal {
  LaneRow from, to;
};

/// How the coupling carries the wind-up d and its speed r over a sub-step under a constant difference a of
/// the two accelerations: d' = dd d + dr r + da a, r' = rd d + rr r + ra a. The common motion takes the
/// shares of the two inertias.
/// `Where`: nothing, or a type of one translation's own, so that none shares code with another's.
template <class V, class Where = void>
struct LaneFlowOf {
  V dd, dr, da, rd, rr, ra;
  V half_rd, half_rr, half_ra;  ///< of r, over half the sub-step
  V stiff, damp;                ///< over the reduced inertia
  V motor_share, load_share;
};
using LaneFlow = LaneFlowOf<LaneValues>;

/// For linearisation: what each lane is moved by, at every row anew. Lane 0 is not moved.
template <class V, class Where = void>
struct LanePushOf {
  V start{}, w{}, drag{}, z{}, soft{}, thl{}, wl{};
  V reading{}, motor_from{}, motor_to{}, load_from{}, load_to{}, level_from{}, level_to{};
  V inverse{};  ///< of the push, for the quotient
};
using LanePush = LanePushOf<LaneValues>;
/// Numbers kept per row and direction: innovation, then the states in the order of LanePush.
inline constexpr std::size_t kTangentStates = 8;

/// What is a number per lane.
template <class V, class Where = void>
struct LaneNumbersOf {
  V inv_motor, inv_load, inv_payload, half_gap;
  LaneFlowOf<V, Where> flow{}, flow_payload{};
  V Fc_plus, Fc_minus, dF_plus, dF_minus, inv_vs, s0, s1, inv_vd, s2, smallest, offset, gain, saturation,
      start_z;
  V soft_level, soft_s0, rough;
  V elsewhere;  ///< share of the friction on the load that acts on the motor
  LanePushOf<V, Where> push;
};

/// One bundle of runs, as the loops take it: plain arrays, nothing that the translations of the loops
/// (by instruction set) could share by accident.
struct Lanes : LaneNumbersOf<LaneValues> {
  std::size_t rows = 0;
  int substeps = 0;
  double period_s = 0.0;
  LaneRow torque;  ///< per sub-step
  LaneRow late;    ///< per sub-step, see Delivered
  LaneSignal motor, load, level;
  LaneRow viscous, reading;
  const double* measured = nullptr;
  const std::uint8_t* valid = nullptr;
  LaneIntegers payload_row;
  double l[4] = {};
  double start_q = 0.0, start_w = 0.0;
  double linear = 1.0, square = 0.0;  ///< exponent of the Stribeck curve: 1, 0 is 1; 0, 1 is 2
  bool full = false, trace = false;
  bool two = false, on_load = false, soft = false, fading = false;  ///< which of the loops
  bool gap = false;                                                 ///< between the two inertias
  bool payload = false;                                             ///< whether any lane has one
  double* innovation[kLanes] = {};
  double* table[kLanes] = {};
  double* velocity[kLanes] = {};
  double* friction[kLanes] = {};
  float* tangent = nullptr;  ///< not null: linearise; (rows - 1) x (kLanes - 1) x kTangentStates
};

inline constexpr int kMostSubsteps = 32;

}  // namespace contour::diagnosis
