#pragma once

#include "daemon/program/motion_plan.h"
#include "daemon/program/piecewise_plan.h"

namespace contour {

/// Checks a piece against the limits of the axes it moves: position range, speed, and the acceleration and
/// jerk of a curve followed at this speed. Throws ProgramError naming axis, value and limit.
void CheckPiece(const PieceRequest& request, const PerAxis<PlanLimits>& limits);

/// Its part about the position range; returns where the piece is. A straight piece that begins beyond a limit
/// may only lead back: pieces join, so that is where the axis stands when the program begins.
Extent CheckRange(const PieceRequest& request, const PerAxis<PlanLimits>& limits);

/// Largest speed along the piece that the axes' velocity limits allow.
double LargestSpeed_m_s(const CurvePiece& curve, const PerAxis<PlanLimits>& limits);

/// What is left for changes of speed along the piece, up to `speed`. On a curve, tangential and centripetal
/// acceleration add at right angles; the curve's share is taken off first.
RampLimits RampLimitsOf(const PieceRequest& request, const PerAxis<PlanLimits>& limits);

}  // namespace contour
