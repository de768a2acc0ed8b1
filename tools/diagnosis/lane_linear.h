#pragma once

#include <cstddef>
#include <cstdint>

#include "tools/diagnosis/lane_run.h"

// The linearised model's loops, eight columns at a time: what signals do to the innovation, and the
// time-varying Kalman filter with the autoregressive filter that make a residual white.
namespace contour::diagnosis {

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

struct LaneWhiten {
  std::size_t rows = 0, stride = 0;
  int states = 0;  ///< 0: no Kalman filter before the autoregressive one
  const float* step = nullptr;
  const float* gain = nullptr;   ///< per transition: kappa (n), 1 / sqrt(S)
  const double* taps = nullptr;  ///< kWhitenTaps of them
  const std::uint8_t* counted = nullptr;
  const double* weight = nullptr;
  const double* in[kLanes] = {};
  double* out[kLanes] = {};
};
inline constexpr std::size_t kWhitenTaps = 49;

void RunColumnsBaseline(const LaneColumns& m);
void RunColumnsAvx2(const LaneColumns& m);
void RunColumnsAvx512(const LaneColumns& m);
void RunWhitenBaseline(const LaneWhiten& m);
void RunWhitenAvx2(const LaneWhiten& m);
void RunWhitenAvx512(const LaneWhiten& m);

}  // namespace contour::diagnosis
