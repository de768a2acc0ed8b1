#pragma once

#include <cstddef>
#include <cstdint>

#include "analysis/prediction_error/simd/lane_run.h"

// The linearised model's loops, eight columns at a time (twice eight where they are made white): what signals
// do to the innovation, and the time-varying Kalman filter with the autoregressive filter that make a
// residual white; inner products of columns.
namespace contour::diagnosis {

/// Seven of the model, and the slow torque of a noise filter.
inline constexpr int kMostStates = 8;
/// Motor force from, to; load force from, to; level from, to.
inline constexpr int kLinearInputs = 6;

/// Per transition from row k to k + 1, `stride` numbers: A (n x n, by rows), c (n), G (n), then for each
/// input d and B (n); x' = A x + B u + G r, innovation e = valid r - c x - d u.
struct LaneColumns {
  std::size_t rows = 0, stride = 0;
  int states = 0;
  int table_state = 0;
  const float* step = nullptr;
  const std::uint8_t* valid = nullptr;
  LaneSignal motor, load, level;
  const double* reading[kLanes] = {};
  bool has_motor = false, has_load = false, has_level = false, has_reading = false;
  double* innovation[kLanes] = {};
  double* table[kLanes] = {};  ///< all null: not asked for
};

inline constexpr std::size_t kMostGroups = 2;

struct LaneWhiten {
  std::size_t rows = 0, stride = 0;
  int states = 0;  ///< 0: no Kalman filter before the autoregressive one
  const float* step = nullptr;
  const float* gain = nullptr;   ///< per transition: kappa (n), 1 / sqrt(S)
  const double* taps = nullptr;  ///< kWhitenTaps of them
  const std::uint8_t* counted = nullptr;
  const double* weight = nullptr;
  std::size_t groups = 1;  ///< of lanes that have columns
  const double* in[kMostGroups][kLanes] = {};
  double* out[kMostGroups][kLanes] = {};
};
inline constexpr std::size_t kWhitenTaps = 49;

inline constexpr std::size_t kMostProducts = 32;
/// Inner products of every column of a with every column of b, at most kMostProducts each.
struct LaneProducts {
  std::size_t size = 0, a_count = 0, b_count = 0;
  const double* const* a = nullptr;
  const double* const* b = nullptr;
  double* out = nullptr;  ///< a_count x b_count, by rows
  bool alike = false;     ///< b is a: only what lies on and right of the diagonal is made
};

}  // namespace contour::diagnosis
