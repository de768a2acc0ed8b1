#pragma once

#include <string>
#include <vector>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/recording/axis_log.h"
#include "analysis/rough_fit/lacking.h"
#include "analysis/rough_fit/rough_fit.h"

namespace contour::diagnosis {

/// [ratio] Two estimates of one inertia that are further apart are of no use.
inline constexpr double kFarApart = 1.5;
/// [relative] Of least squares, from where they say nothing of it.
inline constexpr double kLeastSure = 0.2;

/// A number by prediction errors and by least squares.
struct Pair {
  const char* name;
  const char* text;
  double fitted, by_least_squares, by_parts;
};

/// Prediction errors follow what is quick, least squares what is slow and slides: a model that lacks nothing
/// has the same numbers in both. Friction that falls with the speed is taken out as it was fitted.
std::vector<Pair> TwoEstimates(const StatedAxis& axis, const RoughFit& rough);

/// Beyond their deviations.
bool Disagree(const Pair& p, const StatedAxis& axis);

void WidenAndSay(const std::vector<Pair>& pairs, StatedAxis& axis, std::vector<std::string>& notes);

/// Deviations that hold what the numbers would be with what a model lacks, and a note of each that is there
/// for certain.
void WidenByLacking(const std::vector<Lacking>& lacking, const AxisLog& log, StatedAxis& axis,
                    std::vector<std::string>& notes);

/// Why numbers are of no use where the inertia would be another one with what the model lacks; else empty.
std::string FarApart(const StatedAxis& axis, const std::vector<Lacking>& lacking, const AxisLog& log);

/// What explains the log where the model does not, as the end of a sentence; else empty.
std::string WhatSaysMore(const std::vector<Lacking>& lacking, const AxisLog& log);

}  // namespace contour::diagnosis
