#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "daemon/halt_keeper.h"
#include "daemon/program/gcode_parser.h"
#include "tests/daemon/path_consumer.h"
#include "tests/daemon/program/keeps_limits.h"

namespace contour {
namespace {

using namespace test;

/// A program that halts, from its text to what the axes do, with an operator who may do anything.
class HaltingProgram {
 public:
  HaltingProgram(const std::string& text, const PerAxis<PlanLimits>& limits,
                 const PacedPath::Options& options = {}, ProgramOutputs* outputs = nullptr)
      : mailbox_(16, 4096), feeder_(mailbox_), consumer_(mailbox_, 75.0), watch_(limits, kPeriod_s) {
    if (outputs != nullptr) keeper_.SwitchBy(*outputs);
    GcodeMoves moves = ParseGcode(text, "part.ngc");
    EventUse use{true, {}};
    if (outputs != nullptr) use.switches = [outputs](const GcodeEvent& e) { return outputs->Listens(e); };
    UseEvents(moves, "part.ngc", use);
    keeper_.Begin(1, HaltsOf(moves));
    PacedPath::Options all = options;
    all.halts = true;
    feeder_.Begin(std::make_unique<PathGenerator>(Program{"part.ngc", std::move(moves)}, Origin(), limits,
                                                  kPeriod_s, 1),
                  all);
  }

  /// So many cycles, of which the supply and who keeps the halts see one in `every`.
  void Run(int cycles, int every = 1) {
    for (int i = 0; i < cycles && !over(); ++i) {
      if (i % every == 0) {
        keeper_.Work();
        if (keeper_.TakeRelease()) feeder_.Release();
        feeder_.Feed();
      }
      consumer_.Tick();
      watch_.Add(consumer_.Now());
      keeper_.Consume(Record(), feeder_.halt());
    }
  }
  /// Until it waits for the operator.
  void RunToHalt() {
    for (int i = 0; i < 20'000 && !over() && !(keeper_.status() && keeper_.status()->for_operator); ++i)
      Run(1);
  }
  /// As the pump does it.
  void SetPace(double rate, bool resume = false) {
    const bool ends_wait = resume && keeper_.holding();
    feeder_.SetPace(rate, resume && !keeper_.waiting());
    if (ends_wait) keeper_.Resume();
  }
  [[nodiscard]] std::string At() const {
    const std::optional<HaltStatus> status = keeper_.status();
    return status ? std::to_string(status->line) + " " + status->word : "";
  }
  [[nodiscard]] double x_mm() const { return 1e3 * consumer_.Now()[0].position_m; }
  [[nodiscard]] bool over() { return consumer_.follower().at_end(); }
  [[nodiscard]] const PathFollower& follower() { return consumer_.follower(); }
  void ExpectKept() {
    watch_.ExpectKept();
    EXPECT_EQ(consumer_.dry(), 0);
  }

 private:
  [[nodiscard]] CycleRecord Record() {
    const ProgramPlace place = consumer_.follower().program_place();
    CycleRecord record;
    record.state = consumer_.follower().moving() ? MachineState::kRunning : MachineState::kReady;
    record.program_id = 1;
    record.path_time_s = place.time_s;
    record.pace = place.pace;
    return record;
  }

  CommandMailbox mailbox_;
  PathFeeder feeder_;
  Consumer consumer_;
  LimitWatch watch_;
  HaltKeeper keeper_;
};

TEST(ProgramHaltTest, WaitsAtRestUntilItIsResumedWhateverElseIsDoneMeanwhile) {
  HaltingProgram program("G21 F6000\nG1 X5\nG1 X10\nM0\nX20\n", Limits(0.25, 5.0, 200.0));
  program.RunToHalt();
  EXPECT_EQ(program.At(), "4 M0");
  EXPECT_NEAR(program.x_mm(), 10.0, 1e-9);
  const auto stays = [&](const char* what) {
    program.Run(3000);
    EXPECT_NEAR(program.x_mm(), 10.0, 1e-9) << what;
    EXPECT_EQ(program.follower().program_place().pace, 0.0) << what;
  };
  stays("as it is");
  program.SetPace(0.5);
  stays("another feed");
  program.SetPace(0.0);
  stays("feed 0, or a pause");
  program.SetPace(1.0);
  stays("feed again");
  program.SetPace(0.0);
  stays("feed 0");
  program.SetPace(0.0, true);
  stays("resumed at feed 0");
  EXPECT_EQ(program.At(), "") << "it is not the program that waits";
  program.SetPace(1.0);
  program.Run(3000);
  EXPECT_TRUE(program.over());
  EXPECT_NEAR(program.x_mm(), 20.0, 1e-9);
  program.ExpectKept();
}

TEST(ProgramHaltTest, AtTheStartTwiceInOnePlaceAfterTheShortestMoveAndAtTheEnd) {
  HaltingProgram program("M0\nG21 F6000\nG1 X5\nM0\nM1\nX5.0001\nM0\nG4 P0.1\nM0\nX5.2\nM0\nM2\n",
                         Limits(0.25, 5.0, 200.0));
  const std::vector<std::pair<std::string, double>> expected{
      {"1 M0", 0.0}, {"4 M0", 5.0}, {"5 M1", 5.0}, {"7 M0", 5.0001}, {"9 M0", 5.0001}, {"11 M0", 5.2}};
  for (const auto& [what, x_mm] : expected) {
    program.RunToHalt();
    EXPECT_EQ(program.At(), what);
    EXPECT_NEAR(program.x_mm(), x_mm, 1e-9);
    program.Run(500);
    EXPECT_EQ(program.At(), what);
    EXPECT_NEAR(program.x_mm(), x_mm, 1e-9);
    program.SetPace(1.0, true);
  }
  program.Run(2000);
  EXPECT_TRUE(program.over());
  program.ExpectKept();
}

TEST(ProgramHaltTest, SingleBlockAndAHaltAtTheSamePlaceAreOneRest) {
  HaltingProgram program("G21 G61.1 F6000\nG1 X5\nM0\nX10\nX15\n", Limits(0.25, 5.0, 200.0),
                         {1.0, true, false});
  for (const double x_mm : {5.0, 10.0}) {
    program.Run(2000);
    EXPECT_NEAR(program.x_mm(), x_mm, 1e-9);
    EXPECT_EQ(program.At(), x_mm == 5.0 ? "3 M0" : "");
    program.SetPace(1.0, true);
  }
  program.Run(2000);
  EXPECT_TRUE(program.over());
  program.ExpectKept();
}

// The operator does anything at any time, and the supply looks seldom: no halt is passed or made twice, every
// limit is kept.
TEST(ProgramHaltTest, AnythingAtAnyTimePassesNoHalt) {
  std::mt19937 random(11);
  const auto below = [&](unsigned n) { return static_cast<int>(random() % n); };
  for (int round = 0; round < 8; ++round) {
    SCOPED_TRACE(round);
    const double scale = std::pow(4.0, -(round % 3));
    HaltingProgram program("G21 F9000 G64 P0.05\nG1 X10\nY5\nM0\nX0\nY0\nM0\nG2 X0 Y0 I5\nM0\nG1 X3\n",
                           Limits(0.4, 8.0 * scale, 400.0 * scale * scale),
                           {round % 2 == 0 ? 1.0 : 0.3, false, false});
    std::vector<std::string> seen;
    bool paused = false;
    double rate = 1.0;
    for (int i = 0; i < 4000 && !program.over(); ++i) {
      program.Run(1 + below(60), 1 + below(40));
      if (!program.At().empty() && (seen.empty() || seen.back() != program.At()))
        seen.push_back(program.At());
      if (below(4) == 0) {
        const double rates[] = {0.0, 1.0, 0.2, 0.7, 1.0};
        rate = rates[below(5)];
        program.SetPace(paused ? 0.0 : rate);
      }
      if (below(6) == 0) {
        paused = !paused;
        program.SetPace(paused ? 0.0 : rate, !paused);
      }
    }
    program.SetPace(1.0);
    for (int i = 0; i < 40 && !program.over(); ++i) {
      program.Run(2000, 7);
      if (!program.At().empty() && (seen.empty() || seen.back() != program.At()))
        seen.push_back(program.At());
      program.SetPace(1.0, true);
    }
    EXPECT_TRUE(program.over());
    EXPECT_EQ(seen, (std::vector<std::string>{"4 M0", "7 M0", "9 M0"}));
    program.ExpectKept();
  }
}

/// Switches what it is told after so many looks.
class SlowOutputs final : public ProgramOutputs {
 public:
  [[nodiscard]] bool Listens(const GcodeEvent& event) const override {
    return event.letter == 'M' && event.code == 3;
  }
  void Do(const GcodeEvent& event) override {
    done += WordOf(event) + " ";
    looks_ = 0;
  }
  [[nodiscard]] bool Done() override { return ++looks_ > 300; }
  void Over(const GcodeEvent&) override {}
  void Off() override { done += "off "; }
  void Confirm() override {}
  [[nodiscard]] bool TakeLoss() override { return false; }
  std::string done;

 private:
  int looks_ = 0;
};

TEST(ProgramHaltTest, MotionWaitsUntilAnOutputIsSwitched) {
  SlowOutputs outputs;
  HaltingProgram program("G21 F6000\nG1 X5\nM3 G1 X10\n", Limits(0.25, 5.0, 200.0), {}, &outputs);
  for (int i = 0; i < 5000 && program.At().empty(); ++i) program.Run(1);
  EXPECT_EQ(program.At(), "3 M3");
  program.Run(200);
  EXPECT_NEAR(program.x_mm(), 5.0, 1e-9);
  program.SetPace(1.0, true);
  program.Run(50);
  EXPECT_NEAR(program.x_mm(), 5.0, 1e-9) << "an operator does not pass it by";
  program.Run(3000);
  EXPECT_TRUE(program.over());
  EXPECT_EQ(outputs.done, "M3 off ");
  program.ExpectKept();
}

}  // namespace
}  // namespace contour
