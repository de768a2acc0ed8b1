#pragma once

#include <memory>

#include "daemon/program/motion_plan.h"
#include "daemon/program/programmed_path.h"
#include "daemon/program/rest_map.h"
#include "daemon/program/smooth_path.h"

namespace contour {

/// A stretch of a program from one stop to the next: what is programmed, the smooth path through it, and what
/// the axes allow (jerk above 0).
struct Stretch {
  Stretch(ProgrammedPath path, const PerAxis<PlanLimits>& axes)
      : programmed(std::move(path)), smooth(SmoothPathThrough(programmed)), limits(axes) {}

  ProgrammedPath programmed;
  SmoothPath smooth;
  PerAxis<PlanLimits> limits;
};

/// The path's derivatives by the parameter of a RestMap.
struct ParameterDerivatives {
  PerAxis<double> first, second, third;
  double way_m = 0.0;
};

/// Within the interval of u in which `within` lies, its borders included.
inline ParameterDerivatives AtParameter(const Stretch& stretch, const RestMap& map, double u, double within) {
  const RestMap::Derivatives s = map.At(u, within);
  const std::size_t piece = stretch.smooth.PieceAt(map.At(within).way_m);
  const PathDerivatives q = stretch.smooth.At(s.way_m, piece);
  const std::size_t n = q.first.size();
  ParameterDerivatives x{PerAxis<double>(n), PerAxis<double>(n), PerAxis<double>(n), s.way_m};
  for (std::size_t i = 0; i < n; ++i) {
    x.first[i] = q.first[i] * s.first;
    x.second[i] = q.second[i] * s.first * s.first + q.first[i] * s.second;
    x.third[i] = q.third[i] * s.first * s.first * s.first + 3.0 * q.second[i] * s.first * s.second +
                 q.first[i] * s.third;
  }
  return x;
}

}  // namespace contour
