#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "daemon/program/pace_law.h"
#include "daemon/program/pace_ramp.h"
#include "daemon/program/path_generator.h"
#include "daemon/program/path_walk.h"

namespace contour {

/// A program's points at a feed that may change while they are handed out, and pauses. At feed 1 from the
/// start they are the generator's own, bit for bit.
///
/// Up to the programmed feed it is the program's time that goes by more slowly, so that all of it is slowed
/// down alike. Beyond, the way along the path is timed anew, because its axes would be asked for more than
/// they may where they are at their limits already; between the two the pace is 1 or 0 for a moment. Where
/// the plan's feed is fixed (YAML shapes, and what is shifted by what was learnt) it stays at 1.
///
/// With `single_block` it comes to rest at the end of every line of the program, and with `halts` where the
/// program itself asks for it (MotionPlan::Halts); it stays there until it is resumed.
///
/// A change is planned from a point on that the cycle has not looked at yet; until the cycle has taken the
/// first point of the new law, the one before is remembered.
class PacedPath {
 public:
  struct Options {
    double feed = 1.0;  ///< that it begins with
    bool single_block = false;
    bool halts = false;
    /// Who plans how far: nobody but the path itself when it is asked; or somebody else, by TakePlan() and
    /// GivePlan(). Then Ready() says whether there is a point, and with kAheadOrSlower it comes to rest on
    /// the path, within the limits, before what is planned ends, and goes on when there is more.
    enum class Planning : std::uint8_t { kItself, kAhead, kAheadOrSlower };
    Planning planning = Planning::kItself;
  };
  /// Where the program waits in the law as it is handed out.
  struct Halt {
    std::uint32_t number = 0;  ///< of the program's halts, from 1
    double time_s = 0.0;       ///< of the program
  };
  PacedPath(std::unique_ptr<PathGenerator> generator, const Options& options);

  /// Can the next point be had without planning? Always, when the path plans itself. Points before `needed`
  /// are wanted at once; whether later ones shall bring it to rest is decided when they are.
  bool Ready(std::uint64_t needed);
  /// The next point; false when the last one has been handed out. A pause has no last one.
  bool Next(PathPoint& point);

  enum class Change {
    kPlanned,  ///< the next points are of another law; Taken() or Refused() is to follow
    kNothing,  ///< it runs at that pace already, or has come to its end first
    kLater,    ///< no way from here within the limits: try again
  };
  /// From the point `earliest` on, or as soon after it as can be, the feed goes to `feed`, or a step towards
  /// it: until feed() is that, it is to be asked again. `end`: one past the newest point that the cycle has;
  /// what lies between is handed out again. At rest at the end of a line, or where the program halts, it goes
  /// on only when `resume` says so; it says of which rest.
  Change ChangeFeed(std::uint64_t earliest, std::uint64_t end, double feed, Held resume = Held::kNot);
  void Taken();
  /// It goes on by the law before, with the point `end`.
  void Refused(std::uint64_t end);

  /// What is to be planned further, away from here; null: nothing at present. The plan that is given back
  /// counts unless the feed has been changed meanwhile.
  struct Plan {
    std::unique_ptr<PathWalk> walk;
    std::uint64_t version = 0;
  };
  [[nodiscard]] Plan TakePlan();
  void GivePlan(Plan plan);
  /// No change will begin before this point, and none before it will be handed out again.
  void ForgetBefore(std::uint64_t index);
  /// It is slow, or at rest, because there is no plan for more yet.
  [[nodiscard]] bool waits_for_plan() const { return waits_for_plan_; }
  [[nodiscard]] PathWalk::Estimate ProgramDuration() { return walk_->ProgramDuration(); }

  /// What is left takes this share of its time at the programmed feed, at the largest pace of the feed that
  /// it has been told to go to.
  [[nodiscard]] double TimeShare() const;

  /// The newest halt that points have been handed out for; number 0: there was none.
  [[nodiscard]] const Halt& halt() const { return halt_; }
  [[nodiscard]] bool pending() const { return pending_; }
  [[nodiscard]] std::uint32_t law_number() const { return issued_; }
  /// The feed that it has been told to go to.
  [[nodiscard]] double feed() const { return feed_; }
  /// Can it be more than the programmed one?
  [[nodiscard]] bool feed_may_exceed() const { return generator_->feed_may_exceed(); }
  [[nodiscard]] const PathGenerator& generator() const { return *generator_; }

 private:
  /// One step towards a feed.
  struct Step {
    double rate = 1.0;     ///< of the walk's own time
    double scale = 1.0;    ///< of the walk's feed
    bool rescale = false;  ///< to that scale, now
    bool last = true;      ///< it leads to the feed
  };
  [[nodiscard]] Step StepTowards(double feed, double from, double from_rate) const;
  [[nodiscard]] bool IsLast(double time) const;
  [[nodiscard]] PaceRamp Ramp() const { return {*walk_, generator_->limits(), generator_->period_s()}; }
  [[nodiscard]] std::optional<PaceLaw> LawFrom(std::uint64_t begin, double rate) const;
  [[nodiscard]] std::optional<PaceLaw> ToEndOfLine(const PaceLaw& law) const;
  [[nodiscard]] double EndOfLine(double time) const;
  void Rescale(std::uint64_t begin, double scale);
  void ScaleBack();
  [[nodiscard]] std::optional<PaceLaw> Take(const Step& step, std::uint64_t begin);
  void Adopt(const PaceLaw& law, std::uint64_t begin, std::uint64_t end, double feed);
  void StandAtHalt();
  [[nodiscard]] double Planned() const;
  [[nodiscard]] bool MayGoOn();
  void GoOnWithPlan();
  [[nodiscard]] std::uint32_t HaltsAt(double index) const;
  void Evaluate(const PaceState& state, PathPoint& point) const;

  std::unique_ptr<PathGenerator> generator_;
  std::unique_ptr<PathWalk> walk_;  ///< by the time of the law
  double feed_;
  double scale_ = 1.0;  ///< of the walk's feed
  bool single_block_;
  bool halts_;
  Options::Planning planning_;
  double enough_;              ///< periods of plan ahead that no stop needs
  std::uint64_t version_ = 0;  ///< of the walk
  std::uint64_t forgotten_ = 0;
  bool waits_for_plan_ = false;
  /// A way to rest within what is planned, from a point that has not been handed out yet.
  struct Stop {
    std::uint64_t begin = 0;
    PaceLaw law;
  };
  std::optional<Stop> stop_;
  Halt halt_;
  PaceLaw law_;
  /// What the cycle knows, while another law is pending.
  struct Known {
    std::unique_ptr<PathWalk> walk;  ///< null: the same
    double feed = 1.0;
    double scale = 1.0;
    PaceLaw law;
    std::optional<Stop> stop;
  };
  Known before_;
  bool pending_ = false;
  std::uint64_t pending_from_ = 0;  ///< first point of the pending law
  std::uint32_t issued_ = 0;        ///< number of the newest law; none is used twice
  std::uint32_t taken_ = 0;         ///< of the one that the cycle has
  std::uint64_t next_ = 0;
  bool ended_ = false;
};

}  // namespace contour
