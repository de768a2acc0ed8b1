#pragma once

#include <cstdint>

// Eight runs of the same model side by side: the runs differ in parameters only, so one instruction stream
// serves all of them and their latencies hide each other. Each lane's result is the same whatever runs next
// to it.
namespace contour::diagnosis {

inline constexpr int kLanes = 8;

/// A number per lane, as it lies in memory for every translation of the loops; what they calculate with is as
/// wide as their registers (native_vec.inc).
using LaneValues [[gnu::vector_size(64)]] = double;
using LaneIntegers [[gnu::vector_size(64)]] = std::int64_t;

}  // namespace contour::diagnosis
