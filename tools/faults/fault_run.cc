#include "tools/faults/fault_run.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "daemon/path_feeder.h"
#include "daemon/program_limits.h"
#include "tools/faults/expected_reasons.h"
#include "tools/faults/fault_bounds.h"
#include "tools/faults/injection.h"
#include "tools/faults/test_path.h"
#include "tools/faults/test_plan.h"
#include "tools/faults/truth_watch.h"
#include "tools/simulate/virtual_machine.h"

namespace contour::faults {
namespace {

/// The shape of a run, s.
constexpr double kSettle_s = 0.03;
constexpr double kStartPatience_s = 8.0;
constexpr double kGoesOn_s = 0.3;
/// A warning has so long to come.
constexpr double kWarning_s = 1.5;
constexpr double kBeyondBound_s = 0.1;
constexpr double kLongest_s = 8.0;
/// Truth is seen once a cycle.
constexpr double kResolution_cycles = 2.0;
/// From a set-point to what it makes of the drive.
constexpr int kUnderWay_cycles = 3;
/// One um, where a supervisor is shown on axes with a linear scale.
constexpr double kScale_counts_per_mm = 1000.0;

bool IsProof(const FaultCase& c, const Supervisor* s) {
  return s != nullptr && c.fault == s->fault && c.phase == s->phase && c.feed_mm_s == s->feed_mm_s;
}

class Run {
 public:
  Run(const FaultCase& c, const RunRequest& request)
      : c_(c),
        file_(Prepared(c, request)),
        random_(SeedOf(c, request.campaign_seed), 1),
        proof_(IsProof(c, request.supervisor)),
        expected_(proof_ ? ExpectedHere{Outcome::kStops, {request.supervisor->reason}}
                         : ExpectedIn(c.fault, c.phase, Crawls(file_.machine, c))),
        period_s_(file_.machine.machine.cycle_us * 1e-6),
        injection_(c, file_.machine, random_),
        machine_(file_, ControllerName::kFull, EmulatedClock::kWall, Around(request)),
        watch_(file_.machine.axes.size(), period_s_) {
    injection_.Attach(machine_);
    machine_.SetRecorder([this](const CycleEntry& e) { injection_.AfterCycle(e); });
    machine_.SetObserver([this](const CycleEntry& e, const TruthRow* truth) {
      if (!broken_ && truth != nullptr) watch_.Pair(e.output.record, *truth);
    });
    result_.c = c;
    if (!proof_ && (c.fault == Fault::kEncoderJump || c.fault == Fault::kEncoderJumpLarge) &&
        !JumpIsSeen(file_.machine, c) && expected_.outcome == Outcome::kStops)
      expected_.outcome = Outcome::kMayStop;
    const auto axis = std::next(file_.machine.axes.begin(), static_cast<std::ptrdiff_t>(c.axis));
    expected_.by_scale = !proof_ && EncoderLies(c.fault) && axis->second.drive.linear_scale.has_value();
    powerless_ = c.fault == Fault::kTorqueLost || c.fault == Fault::kTorqueLostSilently;
    if (powerless_) watch_.SetPowerless(c.axis);
    // What is seen later than usual, because others may not look, has no bound.
    bounded_ = !proof_ || request.supervisor->nearer == WatchesOff{};
    const RunBound bound = RunBoundOf(file_.machine, c);
    result_.departure_bound_m = bound.departure_m;
    result_.time_bound_s = bound.time_s;
  }

  RunResult Do() {
    if (Live()) {
      Observe();
      Judge();
      if (!Holding() || result_.stopped) Recover();
    }
    return std::move(result_);
  }

 private:
  static EmulatedMachineFile Prepared(const FaultCase& c, const RunRequest& request) {
    EmulatedMachineFile file = request.In(c.mode);
    file.emulator.seed = SeedOf(c, request.campaign_seed) & 0x7FFFFFFF;
    for (auto& [name, axis] : file.machine.axes) {
      axis.drive.mode = c.mode;
      if (IsProof(c, request.supervisor) && request.supervisor->scale)
        axis.drive.linear_scale = LinearScaleConfig{kScale_counts_per_mm};
    }
    return file;
  }

  Surroundings Around(const RunRequest& request) {
    Surroundings s = injection_.surroundings();
    WatchesOff off;
    if (proof_) off.Add(request.supervisor->nearer);
    if (request.supervisor != nullptr && request.without) off.Add(request.supervisor->watch);
    s.configure = [off](CycleConfig& c) { c.off.Add(off); };
    return s;
  }

  [[nodiscard]] const CycleRecord& record() const { return machine_.record(); }
  [[nodiscard]] MachineState state() const { return record().state; }
  [[nodiscard]] bool Holding() const {
    return state() == MachineState::kReady || state() == MachineState::kRunning ||
           state() == MachineState::kStopping;
  }
  [[nodiscard]] int Cycles(double seconds) const { return static_cast<int>(std::ceil(seconds / period_s_)); }
  int Draw(int from, int to) {
    return std::min(to, from + static_cast<int>(random_.Uniform() * (to - from + 1)));
  }
  void Violated(const std::string& what) {
    if (std::find(result_.violations.begin(), result_.violations.end(), what) == result_.violations.end())
      result_.violations.push_back(what);
  }
  [[nodiscard]] std::string Now() const {
    return std::string(Name(state())) + " (" + std::string(Name(record().reason)) + ")";
  }

  void Tick() {
    if (feeder_) {
      feeder_->Feed();
    } else if (path_) {
      while (held_ && machine_.mailbox().PushPathPoint(point_)) held_ = path_->Next(point_);
      if (!held_) machine_.mailbox().SetPathSupply(false);
    }
    machine_.Tick();
    const TruthRow& truth = machine_.emulated().truth();
    if (!mended_) watch_.Follow(record(), truth, Holding());
    NothingEnablesItself(truth);
  }

  // Asked for: from the request to enable until the machine has fallen back to Idle or Faulted. A set-point
  // that was under way then still acts.
  void NothingEnablesItself(const TruthRow& truth) {
    if (state() == MachineState::kEnabling || Holding()) asked_taken_ = true;
    if (asked_taken_ && (state() == MachineState::kFaulted || state() == MachineState::kIdle))
      asked_ = asked_taken_ = false;
    under_way_ = asked_ ? kUnderWay_cycles : std::max(0, under_way_ - 1);
    if (!asked_ && (state() == MachineState::kEnabling || Holding()))
      Violated("the machine enabled itself: " + Now());
    was_enabled_.resize(truth.axes.size());
    for (std::size_t i = 0; i < truth.axes.size(); ++i) {
      const bool enabled = truth.axes[i].drive_state == DriveState::kOperationEnabled;
      if (enabled && was_enabled_[i] == 0 && under_way_ == 0 && !injection_.foreign_setpoints())
        Violated("drive " + machine_.axis_names()[i] + " was enabled without an operator: " + Now());
      was_enabled_[i] = enabled ? 1 : 0;
    }
  }

  template <class Reached>
  bool TickUntil(double seconds, Reached reached) {
    for (int n = Cycles(seconds); n > 0; --n) {
      Tick();
      if (reached()) return true;
    }
    return false;
  }
  void TickFor(double seconds) {
    for (int n = Cycles(seconds); n > 0; --n) Tick();
  }

  void Break() {
    injection_.Break();
    broken_ = true;
    watch_.Begin(machine_.emulated().truth());
  }

  void AskForEnable() {
    machine_.mailbox().Post(RequestKind::kEnable);
    asked_ = true;
    asked_taken_ = false;
  }

  /// The machine's life up to the fault. False: it did not come that far, which is a failure of its own.
  bool Live() {
    if (c_.phase == Phase::kBringUp) {
      for (int n = Draw(1, 100); n > 0; --n) Tick();
      Break();
      return true;
    }
    if (!Reach("bring-up", MachineState::kIdle)) return false;
    if (c_.phase == Phase::kIdle) {
      TickFor(kSettle_s);
      Break();
      return true;
    }
    AskForEnable();
    if (c_.phase == Phase::kEnabling) {
      for (int n = Draw(1, 6); n > 0; --n) Tick();
      Break();
      return true;
    }
    if (!Reach("enabling", MachineState::kReady)) return false;
    TickFor(kSettle_s);
    if (c_.phase == Phase::kReset) return BreakDuringReset();
    if ((Moves(c_.phase) || Paced(c_.phase)) && !Move()) return false;
    Break();
    return true;
  }

  bool Reach(const char* what, MachineState wanted) {
    const bool there = TickUntil(kStartPatience_s, [&] {
      return state() == wanted || (state() == MachineState::kFaulted && wanted != MachineState::kFaulted);
    });
    if (there && state() == wanted) return true;
    Violated(std::string(what) + " failed before any fault: " + Now());
    return false;
  }

  bool BreakDuringReset() {
    FaultCase first = c_;
    first.fault = Fault::kDriveFault;
    Injection breaks(first, file_.machine, random_);
    breaks.Attach(machine_);
    breaks.Break();
    if (!Reach("a drive's fault", MachineState::kFaulted)) return false;
    for (int n = Draw(1, 60); n > 0; --n) Tick();
    machine_.mailbox().Post(RequestKind::kReset);
    for (int n = Draw(0, 60); n > 0; --n) Tick();
    Break();
    return true;
  }

  bool Move() {
    TestPath::Shape shape;
    shape.feed_m_s = 1e-3 * c_.feed_mm_s;
    shape.direction = Draw(0, 1) == 0 ? -1 : 1;
    // A slow axis needs time to leave presliding; a fast one has not the travel for it.
    const bool slow = c_.feed_mm_s < 0.02 * HighestFeed_mm_s();
    shape.constant_s = 0.08 + (slow ? 0.9 : 0.1) * random_.Uniform();
    shape.reverses = c_.phase == Phase::kReversal;
    shape.end_s = 2.0 + shape.constant_s + std::max(result_.time_bound_s, kWarning_s);
    if (c_.phase == Phase::kHalted) shape.end_s = shape.constant_s;
    PerAxis<bool> moves(file_.machine.axes.size());
    const bool all = Draw(0, 1) == 1;
    PerAxis<double> start_m;
    for (std::size_t i = 0; i < moves.size(); ++i) {
      moves[i] = all || i == c_.axis;
      start_m.push_back(record().axes[i].reference.position_m);
    }
    path_.emplace(shape, file_.machine, start_m, moves, 1);
    if (Paced(c_.phase)) {
      feeder_.emplace(machine_.mailbox());
      feeder_->Begin(std::make_unique<PathGenerator>(std::make_shared<TestPlan>(*path_, period_s_),
                                                     ProgramLimits(file_.machine), period_s_, 1U),
                     {1.0, false, c_.phase == Phase::kHalted});
    } else {
      held_ = path_->Next(point_);
    }
    WaitForTheMotionThatShowsIt();
    machine_.mailbox().SetPathSupply(true);
    machine_.mailbox().Post(RequestKind::kRun, 1);
    if (!Reach("a program's start", MachineState::kRunning)) return false;
    const double jitter_s = Draw(-3, 3) * period_s_;
    double at_s = path_->ramp_s() + shape.constant_s * random_.Uniform(0.3, 0.9);
    if (c_.phase == Phase::kAcceleration) at_s = path_->ramp_s() * random_.Uniform(0.15, 0.85);
    if (c_.phase == Phase::kReversal) at_s = path_->reversal_s() + jitter_s;
    const bool there = TickUntil(
        kStartPatience_s, [&] { return state() != MachineState::kRunning || record().path_time_s >= at_s; });
    if (!there || state() != MachineState::kRunning) {
      Violated("the program ended before any fault: " + Now());
      return false;
    }
    if (Paced(c_.phase)) return ChangePace();
    if (c_.phase != Phase::kStopping) return true;
    machine_.mailbox().PostStop();
    if (!Reach("a stop on the path", MachineState::kStopping)) return false;
    for (int n = Draw(0, 25); n > 0 && state() == MachineState::kStopping; --n) Tick();
    return true;
  }

  /// Not slower than what promises are made for.
  double LessFeed() {
    const double least = std::clamp(kLowestFeed_mm_s / c_.feed_mm_s, kLeastOfFeed, 0.95);
    return random_.Uniform(least, std::max(kMostOfFeed, least));
  }

  bool ChangePace() {
    const auto reaches = [&](auto pace_is) {
      const bool there = TickUntil(
          kStartPatience_s, [&] { return state() != MachineState::kRunning || pace_is(record().pace); });
      if (there && state() == MachineState::kRunning) return true;
      Violated("the program did not come to another pace: " + Now());
      return false;
    };
    if (c_.phase == Phase::kHalted) {
      if (!reaches([](double pace) { return pace == 0.0; })) return false;
      for (int n = Draw(0, 300); n > 0; --n) Tick();
      return true;
    }
    const double slower = c_.phase == Phase::kFeedChange ? LessFeed() : 0.0;
    feeder_->SetPace(slower);
    if (c_.phase == Phase::kFeedChange) {
      const double within = random_.Uniform(slower + 0.1 * (1.0 - slower), 0.99);
      return reaches([within](double pace) { return pace < within; });
    }
    if (!reaches([](double pace) { return pace == 0.0; })) return false;
    for (int n = Draw(0, 300); n > 0; --n) Tick();
    if (c_.phase == Phase::kPaused) return true;
    feeder_->SetPace(1.0);
    const double within = random_.Uniform(0.02, 0.9);
    return reaches([within](double pace) { return pace > within; });
  }

  /// What motion shows is promised from the motion on that shows it; an axis that turns has first to get
  /// there.
  void WaitForTheMotionThatShowsIt() {
    if (!ShownByMotion(c_.fault)) return;
    if (c_.phase == Phase::kAcceleration || c_.phase == Phase::kStopping) until_it_shows_s_ = path_->ramp_s();
    if (c_.phase == Phase::kReversal || (Paced(c_.phase) && Moves(c_.phase)))
      until_it_shows_s_ = 2.0 * path_->ramp_s();
    result_.time_bound_s += until_it_shows_s_;
  }

  [[nodiscard]] double HighestFeed_mm_s() const {
    return std::next(file_.machine.axes.begin(), static_cast<std::ptrdiff_t>(c_.axis))
        ->second.limits.velocity_mm_s;
  }

  [[nodiscard]] bool Quiet() {
    const TruthRow& truth = machine_.emulated().truth();
    for (std::size_t i = 0; i < truth.axes.size(); ++i) {
      const AxisTruth& a = truth.axes[i];
      if (powerless_ && i == c_.axis) continue;
      if (TruthWatch::UnderTorque(a) && !TruthWatch::AtRest(a)) return false;
    }
    return true;
  }

  [[nodiscard]] bool Still() {
    const TruthRow& truth = machine_.emulated().truth();
    return std::all_of(truth.axes.begin(), truth.axes.end(), TruthWatch::AtRest);
  }

  /// From the fault until what comes of it is over.
  void Observe() {
    const Reason warning = ExpectationOf(c_.fault).warning;
    double window_s = kGoesOn_s;
    if (Moves(c_.phase) && warning != Reason::kNone) window_s = kWarning_s;
    if (expected_.outcome == Outcome::kStops)
      window_s = std::max(window_s, result_.time_bound_s + kBeyondBound_s);
    if (!Holds(c_.phase)) window_s = c_.phase == Phase::kIdle ? kGoesOn_s : 1.0;
    window_s = std::min(window_s, kLongest_s);
    double quiet_s = 0.0;
    for (double t = 0.0; t < (result_.stopped ? kLongest_s : window_s); t += period_s_) {
      Tick();
      for (const AxisRecord& a : record().axes)
        result_.warned = result_.warned || (warning != Reason::kNone && a.limit == warning);
      if (!ended_s_ && state() == MachineState::kReady && record().reason == Reason::kProgramEnd)
        ended_s_ = t;
      if (state() != MachineState::kFaulted) continue;
      if (!result_.stopped && !(c_.phase == Phase::kReset && record().reason == Reason::kDriveFault)) {
        result_.stopped = true;
        result_.reason = record().reason;
        result_.where = record().reason_axis;
        faulted_s_ = watch_.since_fault_s();
      }
      SeeExplained();
      quiet_s = Quiet() ? quiet_s + period_s_ : 0.0;
      if (result_.stopped && quiet_s > kSettle_s + Explaining_s()) break;
    }
    if (result_.stopped && !Quiet()) Violated("still under torque and moving at the end");
  }

  /// A drive that gets no set-points says so itself, after what is seen of it; no other reason may change.
  void SeeExplained() {
    if (!result_.stopped || record().reason == result_.reason) return;
    if (record().reason != Reason::kDriveLostMaster)
      Violated("reason " + std::string(Name(result_.reason)) + " became " +
               std::string(Name(record().reason)));
    result_.reason = record().reason;
  }
  [[nodiscard]] double Explaining_s() const {
    if (expected_.Allows(result_.reason) || !expected_.Allows(Reason::kDriveLostMaster)) return 0.0;
    const DriveConfig& drive =
        std::next(file_.machine.axes.begin(), static_cast<std::ptrdiff_t>(c_.axis))->second.drive;
    constexpr double kMessages = 3.0;  // a fault's, that of its end, and the one that tells of the master
    return 1e-3 * (drive.notice_ms + kMessages * drive.emergency_inhibit_ms);
  }

  void Judge() {
    const double slack_s = kResolution_cycles * period_s_;
    for (std::size_t i = 0; i < file_.machine.axes.size(); ++i) {
      RunBound bound{result_.departure_bound_m, result_.time_bound_s};
      if (i != c_.axis) {
        // They stop when the broken one is seen to be.
        bound = BoundOfOthers(file_.machine, c_, i);
        bound.time_s += until_it_shows_s_;
      }
      const double departure_m = watch_.departure_m(i);
      double time_s = watch_.moving_until_s(i);
      if (Holds(c_.phase)) time_s = std::max(time_s, faulted_s_);
      const std::string axis = machine_.axis_names()[i];
      if (bounded_ && departure_m > bound.departure_m)
        Violated("departure of " + axis + " " + Number(1e3 * departure_m) + " mm, at most " +
                 Number(1e3 * bound.departure_m));
      // At rest what nothing but motion shows has no time of its own.
      const bool timed =
          Holds(c_.phase) && (Moves(c_.phase) || !ShownByMotion(c_.fault)) && !(powerless_ && i == c_.axis);
      if (bounded_ && result_.stopped && timed && time_s > bound.time_s + slack_s)
        Violated("torque on and moving for " + Number(1e3 * time_s) + " ms on " + axis + ", at most " +
                 Number(1e3 * bound.time_s));
      if (i == c_.axis) {
        result_.departure_m = departure_m;
        if (result_.stopped) result_.time_s = time_s;
      }
    }
    if (result_.stopped && expected_.outcome == Outcome::kGoesOn)
      Violated("stopped, " + std::string(Name(result_.reason)) + ", where nothing may stop");
    else if (result_.stopped && !expected_.Allows(result_.reason))
      Violated("reason " + std::string(Name(result_.reason)) + ", expected " + Expected());
    if (!result_.stopped && expected_.outcome == Outcome::kStops && !EndedBefore())
      Violated("did not stop: " + Now());
    if (WarningIsDue() && !result_.warned && !result_.stopped)
      Violated("no warning " + std::string(Name(ExpectationOf(c_.fault).warning)));
  }

  /// What motion shows within a promised time need not have been seen where a short travel ends the program
  /// before; how far the axis was from its path is judged all the same.
  [[nodiscard]] bool EndedBefore() const {
    return Moves(c_.phase) && ShownByMotion(c_.fault) && ended_s_ && *ended_s_ < result_.time_bound_s;
  }

  /// Only where there is motion enough for it.
  [[nodiscard]] bool WarningIsDue() const {
    return ExpectationOf(c_.fault).warning != Reason::kNone &&
           (c_.phase == Phase::kConstant || c_.phase == Phase::kReversal);
  }

  [[nodiscard]] std::string Expected() const {
    std::string text(Name(expected_.reasons[0]));
    if (expected_.reasons[1] != Reason::kNone) text += " or " + std::string(Name(expected_.reasons[1]));
    return text;
  }
  static std::string Number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
  }

  /// Mended, reset, enabled; and nothing of that by itself.
  void Recover() {
    if (Holding() || state() == MachineState::kEnabling) return;
    injection_.Mend();
    mended_ = true;
    path_.reset();
    TickFor(kSettle_s);
    // Whatever the phase, bring-up comes to its end first.
    TickUntil(kStartPatience_s,
              [&] { return state() == MachineState::kIdle || state() == MachineState::kFaulted; });
    // An axis whose drive has let go coasts; an operator waits for that.
    TickUntil(kStartPatience_s, [&] { return Still(); });
    const std::uint32_t sequence = machine_.mailbox().Post(RequestKind::kReset);
    const bool idle = TickUntil(kStartPatience_s, [&] {
      return record().acknowledged >= sequence &&
             (state() == MachineState::kIdle || state() == MachineState::kFaulted);
    });
    if (!idle || state() != MachineState::kIdle) return Violated("reset does not help: " + Now());
    TickFor(kSettle_s);
    if (state() != MachineState::kIdle) return Violated("after reset: " + Now());
    AskForEnable();
    TickUntil(kStartPatience_s, [&] {
      // A reading that has come back from far away is fast for a while; who is told so asks once more.
      if (state() == MachineState::kIdle && record().reason == Reason::kAxisMoves) AskForEnable();
      return state() == MachineState::kReady || state() == MachineState::kFaulted;
    });
    TickFor(kSettle_s);
    if (state() != MachineState::kReady) Violated("enable after reset: " + Now());
  }

  FaultCase c_;
  EmulatedMachineFile file_;
  plant::Random random_;
  bool proof_;
  bool bounded_ = true;
  ExpectedHere expected_;
  double period_s_;
  Injection injection_;
  VirtualMachine machine_;
  TruthWatch watch_;
  RunResult result_;
  std::optional<TestPath> path_;
  std::optional<PathFeeder> feeder_;  ///< of a path whose pace changes, instead
  PathPoint point_;
  bool held_ = false;
  bool broken_ = false;
  bool mended_ = false;
  bool powerless_ = false;
  bool asked_ = false;
  bool asked_taken_ = false;
  int under_way_ = 0;
  std::vector<char> was_enabled_;
  double faulted_s_ = 0.0;
  std::optional<double> ended_s_;  ///< the program, at its own end, since the fault
  double until_it_shows_s_ = 0.0;
};

}  // namespace

RunResult RunFault(const FaultCase& c, const RunRequest& request) { return Run(c, request).Do(); }

}  // namespace contour::faults
