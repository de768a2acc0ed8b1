#pragma once

#include <vector>

#include "daemon/program/piecewise_plan.h"

namespace contour {

/// Pieces first..end of the requests as one, with what the strictest of them allows.
struct RunRequest {
  std::size_t first = 0;
  std::size_t end = 0;
  double length_m = 0.0;
  double speed_m_s = 0.0;
  RampLimits ramp;
};

/// Speed from one piece to the next, as the corner of the first asks for it; 0 is a stop.
double CornerSpeed_m_s(const PieceRequest& before, const PieceRequest& after);

/// Neighbours at the same speed without a stop between them, taken together.
std::vector<RunRequest> Runs(const std::vector<PieceRequest>& requests, const std::vector<RampLimits>& ramps);

/// Speeds between the runs (element i lies before run i), lowered until every run is long enough for its
/// change of speed.
std::vector<double> Junctions(const std::vector<RunRequest>& runs, const std::vector<PieceRequest>& requests);

}  // namespace contour
