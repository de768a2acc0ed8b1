#pragma once

#include <cstddef>
#include <vector>

namespace contour {

/// How the friction level of an axis varies along its stroke, learnt from what the estimator found on the
/// way.
///
/// Friction as a whole changes with load, temperature and time; what belongs to a place is only how its level
/// differs from that of the place beside it. So the stroke is divided, and what is learnt is the step (of the
/// logarithm) from one piece to the next, whenever the axis slides through both without a stop and at the
/// same speed. A level that follows with delay puts the step too late, in either direction of motion; the
/// mean of both directions is right.
class StrokeFriction {
 public:
  struct Stroke {
    double lowest_m = 0.0;
    double highest_m = 0.0;
    double lead_m = 0.0;  ///< a piece is two turns of the screw at least, over which ripples average out
  };
  /// From one piece to the next, by motion towards positive and negative positions.
  struct Step {
    double forward = 0.0, backward = 0.0;  ///< difference of the logarithm of the level
    double forward_passes = 0.0, backward_passes = 0.0;
  };
  struct Sample {
    double position_m = 0.0;
    double velocity_m_s = 0.0;  ///< of the reference
    double level_N = 0.0;  ///< friction as estimated, without its viscous part, positive against the motion
    bool sliding = false;  ///< the drive is on, a program runs, and the estimate is sound
  };

  /// More than this from one piece to the next is no friction along the stroke.
  static constexpr double kLargestStep = 0.3;

  explicit StrokeFriction(const Stroke& stroke);
  /// Goes on from what was learnt before. As many steps as steps().
  StrokeFriction(const Stroke& stroke, std::vector<Step> learnt);

  /// The next cycle.
  void Add(const Sample& sample);

  [[nodiscard]] const std::vector<Step>& steps() const { return steps_; }
  [[nodiscard]] std::size_t pieces() const { return steps_.size() + 1; }
  [[nodiscard]] double Centre_m(std::size_t piece) const;
  /// Friction in every piece beyond its mean over the stroke, relative. Where nothing is known there is no
  /// step.
  [[nodiscard]] std::vector<double> Relative() const;
  /// Goes up with every step that was learnt.
  [[nodiscard]] std::size_t passes() const { return passes_; }

 private:
  /// A stretch through one piece.
  struct Stretch {
    double log_level = 0.0, speed_m_s = 0.0;
    std::size_t samples = 0;
    std::size_t piece = 0;
  };
  void Leave(std::size_t next);
  void Learn(const Stretch& from, const Stretch& to, int direction);

  Stroke stroke_;
  std::vector<Step> steps_;
  Stretch now_, before_;
  bool whole_ = false;         // now_ began at an end of its piece
  bool before_whole_ = false;  // before_ went from end to end
  int direction_ = 0;
  std::size_t passes_ = 0;
};

}  // namespace contour
