#pragma once

#include <span>
#include <vector>

#include "analysis/prediction_error/problem.h"

namespace contour::diagnosis {

/// Length of free runs, as reports state them: some strokes and reversals. In much longer ones the smallest
/// error of force adds up.
inline constexpr double kFreeRun_s = 1.0;

/// Of a log, cut as for fitted halves.
enum class Parts { kAll, kEven, kOdd };

/// Of a window's length from where one begins to where the next does, so that little depends on where they
/// do.
inline constexpr double kFreeRunsApart = 0.5;

/// Windows in these parts that hold no gap; free runs begin there at the smoothed measurement.
std::vector<Segment> FreeRunWindows(const Problem& problem, Parts parts);

/// How far each model is off in the windows, back to back, on the recorded command alone.
std::vector<std::vector<double>> FreeRuns(const Problem& problem, std::span<const AxisModel> models,
                                          const std::vector<Segment>& windows);

/// Root mean square of free runs of `seconds` over the rows [from, to) of the log, window after window.
double FreeRunError(const Problem& problem, const AxisModel& model, double seconds, std::size_t from,
                    std::size_t to);

}  // namespace contour::diagnosis
