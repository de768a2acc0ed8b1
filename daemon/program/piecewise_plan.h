#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "daemon/program/corner_blend.h"
#include "daemon/program/curve_piece.h"
#include "daemon/program/jerk_ramp.h"
#include "daemon/program/motion_plan.h"
#include "daemon/program/speed_profile.h"

namespace contour {

/// One piece of a path as a shape or a G-code move asks for it.
struct PieceRequest {
  CurvePiece curve;
  double speed_m_s = 0.0;                                    ///< 0: as fast as the axes allow
  double dwell_s = 0.0;                                      ///< at the end of the piece, at rest
  GcodeMove::Corner corner = GcodeMove::Corner::kExactStop;  ///< towards the next piece
  double tolerance_m = 0.0;                                  ///< of a blended corner
  double shortest_ramp_s = 0.0;
  std::string origin;       ///< "file" or "file:line", begins messages
  int line = 0;             ///< of the program; 0: none
  std::uint32_t halts = 0;  ///< places before it at which the program waits, at rest
};

/// What else is known of the whole path.
struct PathTraits {
  double turn_length_m = 0.0;      ///< 0: a shape without turns
  bool speed_in_one_turn = false;  ///< the full speed must be reached, and left, within one turn
  std::optional<CommandedCircle> circle;
};

/// A path of smooth pieces, each with its own speed; the speed changes along the path within the axes' limits
/// of acceleration and jerk. Where a corner is to be blended, all of the path's ramps are the fastest.
class PiecewisePlan : public MotionPlan {
 public:
  /// Throws ProgramError when a piece leaves the axes' limits.
  PiecewisePlan(std::vector<PieceRequest> requests, const PathTraits& traits,
                const PerAxis<PlanLimits>& limits);

  [[nodiscard]] std::size_t axis_count() const override { return axis_count_; }
  [[nodiscard]] double duration_s() const override { return duration_s_; }
  void At(double time_s, PerAxis<ReferencePoint>& axes) const override;
  [[nodiscard]] std::uint32_t Line(double time_s) const override;
  [[nodiscard]] double Distance_m(const PerAxis<double>& point_m) const override;
  [[nodiscard]] double Turns(double time_s) const override;
  [[nodiscard]] bool Scored(double time_s) const override;
  [[nodiscard]] std::optional<CommandedCircle> circle() const override { return traits_.circle; }
  [[nodiscard]] bool is_hold() const override;
  [[nodiscard]] bool Moves(std::size_t axis) const override;

 private:
  struct Piece {
    CurvePiece curve;
    double before_m = 0.0;  ///< way covered by the pieces before
    int line = 0;           ///< of the program's text
  };
  /// Pieces driven through without a stop at one speed: changes of speed reach across them. Or the blend of a
  /// corner.
  struct Run {
    std::variant<SpeedProfile, JerkProfile, CornerBlend> motion;
    double begin_s = 0.0;
    double before_m = 0.0;
    double length_m = 0.0;
    std::size_t first = 0;
    std::size_t end = 0;
  };
  /// Pieces next to each other with a box around them, so that the nearest one is found without trying all.
  struct Group {
    std::size_t first = 0;
    std::size_t end = 0;
    Extent box;
  };

  void AddRuns(const std::vector<PieceRequest>& requests, const std::vector<RampLimits>& ramps);
  void AddBlendedRuns(const std::vector<PieceRequest>& requests, const std::vector<RampLimits>& ramps,
                      const PerAxis<PlanLimits>& limits);
  void Add(Run run, double dwell_s);
  void CheckSpeedWithinTurn(const PieceRequest& first) const;
  void MakeGroups();
  [[nodiscard]] const Run& RunAt(double time_s) const;
  [[nodiscard]] static AlongCurve Along(const Run& run, double since_begin_s);
  [[nodiscard]] const Piece& PieceAt(const Run& run, double way_m) const;

  PathTraits traits_;
  std::size_t axis_count_;
  double duration_s_ = 0.0;
  std::vector<Piece> pieces_;
  std::vector<Run> runs_;
  std::vector<Group> groups_;
};

}  // namespace contour
