#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "daemon/program/path_walk.h"
#include "daemon/program/stretch_program.h"
#include "daemon/program/time_law.h"

namespace contour {

/// Along the stretches of a program, one leg after the other: a leg is a stretch, or what is left of one
/// after a stop on the way.
class StretchWalk : public PathWalk {
 public:
  explicit StretchWalk(std::shared_ptr<const StretchProgram> program);
  StretchWalk(const StretchWalk& other);
  StretchWalk& operator=(const StretchWalk&) = delete;

  void At(double time_s, PerAxis<ReferencePoint>& axes) override;
  [[nodiscard]] bool GoesOnAfter(double time_s) override;
  double ChangeFeed(double time_s, double scale) override;
  [[nodiscard]] double rests_from_s() const override { return rests_from_s_; }
  [[nodiscard]] int Line(double time_s) override;
  [[nodiscard]] std::uint32_t Halts(double time_s) override;
  [[nodiscard]] double ProgramTime_s(double time_s) override;
  [[nodiscard]] double duration_s() override;
  [[nodiscard]] Estimate ProgramDuration() override;
  [[nodiscard]] double TimeShare(double time_s) override;
  [[nodiscard]] double planned_s() override;
  void PlanStep() override;
  void ForgetBefore(double time_s) override;
  /// Legs that are kept, with and without a law.
  [[nodiscard]] std::size_t legs() const { return legs_.size(); }
  /// Of all of them: moves of which the path is kept, and nodes of the speed along it.
  struct Kept {
    std::size_t moves = 0;
    std::size_t nodes = 0;
  };
  [[nodiscard]] Kept kept() const;
  [[nodiscard]] std::unique_ptr<PathWalk> Clone() const override {
    return std::make_unique<StretchWalk>(*this);
  }

 private:
  struct Leg {
    std::size_t part = 0;
    StretchProgram::Part of{};
    double from_m = 0.0;
    double scale = 1.0;
    double begin_s = 0.0;
    bool changed = false;  ///< its law cannot be made again
    std::unique_ptr<TimeLaw> law;
  };
  void Append(std::size_t part, double from_m, double begin_s);
  void Extend(double time_s);
  [[nodiscard]] std::size_t LegAt(double time_s);
  /// The law of a leg, made again where it was given up; null: only a dwell.
  TimeLaw* LawOf(std::size_t leg);
  [[nodiscard]] Stretch StretchOf(const Leg& leg) const;
  void GiveUpLaws(std::size_t but);
  /// Of a walk whose feed never changes: when a part begins, and when it is at a way of that part.
  [[nodiscard]] double BeginOf_s(std::size_t part);
  [[nodiscard]] double TimeAt_s(std::size_t part, double way_m);
  [[nodiscard]] PerAxis<double> StartOf(const StretchProgram::Part& part) const;

  std::shared_ptr<const StretchProgram> program_;
  std::vector<Leg> legs_;
  std::size_t gone_ = 0;           ///< legs before the first that is kept
  bool forgets_ = false;           ///< ForgetBefore() says what is not needed; until then it is guessed
  std::vector<std::size_t> held_;  ///< legs with a law that can be made again, newest use last
  bool complete_ = false;          ///< the last leg ends the program
  double end_s_ = 0.0;             ///< of the program when complete
  double scale_ = 1.0;
  double not_before_s_ = 0.0;  ///< the next leg begins
  double rests_from_s_;
  double changed_from_s_;             ///< the feed was never changed before
  std::unique_ptr<StretchWalk> own_;  ///< at the programmed feed; null before the first change
};

}  // namespace contour
