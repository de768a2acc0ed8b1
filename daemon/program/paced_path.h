#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "daemon/program/pace_law.h"
#include "daemon/program/pace_ramp.h"
#include "daemon/program/path_generator.h"

namespace contour {

/// A program's points at a pace that may change while they are handed out: pauses, and feeds other than the
/// programmed one. At pace 1 from the start they are the generator's own, bit for bit.
///
/// With `single_block` it comes to rest at the end of every line of the program, and with `halts` where the
/// program itself asks for it (MotionPlan::Halts); it stays there until it is resumed.
///
/// A change is planned from a point on that the cycle has not looked at yet; until the cycle has taken the
/// first point of the new law, the one before is remembered.
class PacedPath {
 public:
  struct Options {
    double rate = 1.0;  ///< the pace that it begins with
    bool single_block = false;
    bool halts = false;
  };
  /// Where the program waits in the law as it is handed out.
  struct Halt {
    std::uint32_t number = 0;  ///< of the program's halts, from 1
    double time_s = 0.0;       ///< of the program
  };
  PacedPath(std::unique_ptr<PathGenerator> generator, const Options& options);

  /// The next point; false when the last one has been handed out. A pause has no last one.
  bool Next(PathPoint& point);

  enum class Change {
    kPlanned,  ///< the next points are of another law; Taken() or Refused() is to follow
    kNothing,  ///< it runs at that pace already, or has come to its end first
    kLater,    ///< no way from here within the limits: try again
  };
  /// From the point `earliest` on, or as soon after it as can be, the pace goes to `rate`. `end`: one past
  /// the newest point that the cycle has; what lies between is handed out again. At rest at the
  /// end of a line, or where the program halts, it goes on only when `resume` says so; it says of
  /// which rest.
  Change ChangePace(std::uint64_t earliest, std::uint64_t end, double rate, Held resume = Held::kNot);
  void Taken();
  /// It goes on by the law before, with the point `end`.
  void Refused(std::uint64_t end);

  /// The newest halt that points have been handed out for; number 0: there was none.
  [[nodiscard]] const Halt& halt() const { return halt_; }
  [[nodiscard]] bool pending() const { return pending_; }
  [[nodiscard]] std::uint32_t law_number() const { return issued_; }
  /// The pace that it has been told to go to.
  [[nodiscard]] double rate() const { return rate_; }
  [[nodiscard]] const PathGenerator& generator() const { return *generator_; }

 private:
  [[nodiscard]] bool IsLast(double time) const;
  [[nodiscard]] std::optional<PaceLaw> LawFrom(std::uint64_t begin, double rate) const;
  [[nodiscard]] std::optional<PaceLaw> ToEndOfLine(const PaceLaw& law) const;
  [[nodiscard]] double EndOfLine(double time) const;
  void Adopt(const PaceLaw& law, std::uint64_t begin, std::uint64_t end, double rate);
  void StandAtHalt();
  [[nodiscard]] std::uint32_t HaltsAt(double index) const;
  void Evaluate(const PaceState& state, PathPoint& point) const;

  std::unique_ptr<PathGenerator> generator_;
  PaceRamp ramp_;
  double rate_;
  double rate_before_ = 1.0;
  bool single_block_;
  bool halts_;
  Halt halt_;
  PaceLaw law_;
  PaceLaw before_;  ///< the law that the cycle knows, while another is pending
  bool pending_ = false;
  std::uint64_t pending_from_ = 0;  ///< first point of the pending law
  std::uint32_t issued_ = 0;        ///< number of the newest law; none is used twice
  std::uint32_t taken_ = 0;         ///< of the one that the cycle has
  std::uint64_t next_ = 0;
  bool ended_ = false;
};

}  // namespace contour
