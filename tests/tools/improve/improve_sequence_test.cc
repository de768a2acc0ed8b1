#include "tools/improve/improve_sequence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "analysis/axis_model/read_stated_axis.h"
#include "config/config_error.h"
#include "config/load_machine.h"
#include "config/yaml_writer.h"
#include "daemon/program_limits.h"
#include "tools/improve/default_programs.h"

namespace contour::improve {
namespace {

/// A machine that follows with an error of its own with each model, and an operator who says no when told to.
class FakeMachine final : public ImproveMachine {
 public:
  explicit FakeMachine(MachineConfig machine) : machine_(std::move(machine)), file_(machine_) {}

  MachineConfig Machine() override { return machine_; }
  PerAxis<double> Position_m() override {
    PerAxis<double> zero(2);
    zero[0] = zero[1] = 0.0;
    return zero;
  }
  void Ask(const std::string& what) override {
    asked.push_back(what);
    if (asked.size() == refuse_at) throw Refused("refused by the operator");
  }
  void Enable() override { enabled = true; }
  void Disable() override { enabled = false; }
  Drawing Run(const ProgramText& program) override {
    EXPECT_TRUE(enabled);
    ran.push_back(program.name);
    if (ran.size() == fail_at) {
      faulted = true;
      throw std::runtime_error("stopped: a fault");
    }
    Drawing d;
    d.start_m = Position_m();
    d.log.axis = "x";
    d.log.period_s = 1e-3;
    const auto plan = PlanMotion(ParseProgram(program.text, program.name, program.format), d.start_m,
                                 ProgramLimits(machine_));
    PerAxis<ReferencePoint> at(2);
    for (double t = 0.0; t < plan->duration_s(); t += 0.05) {
      plan->At(t, at);
      DrawnCycle& c = d.cycles.emplace_back();
      c.path_time_s = t;
      const double error_m =
          1e-6 * (new_model ? error_after_um : 1.0) + 1e-9 * static_cast<double>(ran.size() % 3);
      for (const ReferencePoint& p : at)
        c.axes.push_back({p.position_m, 0.0, p.position_m + error_m, kNoTruth, 0.0, 0.0});
      d.log.command.push_back(0.0);
      d.log.position.push_back(0.0);
      d.log.present.push_back(1);
    }
    d.log.rows = d.log.command.size();
    if (ran.size() == lose_at || lose_all) d.lost = d.cycles.size();
    return d;
  }
  void LoadModel(const std::string& yaml) override {
    EXPECT_FALSE(enabled) << "nothing is loaded while there is torque";
    if (!refuse_text.empty() && yaml.find(refuse_text) != std::string::npos)
      throw ModelRefused("contourd does not take it: no");
    if (faulted) throw NotIdle("the new model was not loaded: the machine is Faulted");
    loaded.push_back(yaml);
    new_model = !yaml.empty();
    for (const auto& [text, um] : error_with_um)
      if (yaml.find(text) != std::string::npos) error_after_um = um;
    if (!new_model) machine_ = file_;
  }
  bool AwaitIdle(const std::string& what_for) override {
    EXPECT_FALSE(enabled);
    if (!faulted) return false;
    if (nobody_resets) throw Refused("interrupted, and the machine is Faulted");
    EXPECT_NE(what_for.find("old model"), std::string::npos);
    faulted = false;
    ++waited;
    return true;
  }
  void Say(const std::string& line) override {
    if (line == "the old model is loaded again") {
      EXPECT_FALSE(new_model) << "not before it is";
    }
  }

  std::vector<std::string> asked, ran, loaded;
  std::size_t refuse_at = 0, fail_at = 0, lose_at = 0;
  bool lose_all = false, faulted = false, nobody_resets = false;
  int waited = 0;
  double error_after_um = 0.5;
  std::string refuse_text;                      ///< of a model
  std::map<std::string, double> error_with_um;  ///< by a text of the model
  bool enabled = false, new_model = false;

 private:
  MachineConfig machine_, file_;
};

class ImproveSequenceTest : public ::testing::Test {
 protected:
  ImproveSequenceTest() {
    PerAxis<double> zero = machine_.Position_m();
    request_.axis = "x";
    request_.space = SpaceFor(config_, "x", {20.0, 60.0, 0.9}, zero);
    request_.limits = ProgramLimits(config_);
    request_.path = Place(UsualPath(config_, request_.space), request_.space, request_.limits, zero);
    request_.check = Place(UsualCheck(config_, request_.space), request_.space, request_.limits, zero);
    request_.experiments = {
        {"a stroke", "shape: creep\naxis: x\nstroke_mm: 5\nvelocities_mm_s: [5]\n", ProgramFormat::kYaml}};
    request_.shaking = {
        {"a chirp", "shape: creep\naxis: x\nstroke_mm: 5\nvelocities_mm_s: [6]\n", ProgramFormat::kYaml}};
    request_.machine_time_s = 900.0;
  }
  ImproveResult Run() {
    return ImproveSequence(machine_, request_,
                           [this](const auto& log, const auto& stated) {
                             lengths_.push_back(log.rows);
                             EXPECT_GT(stated.motor_inertia, 0.0);
                             machine_.faulted = machine_.faulted || fault_in_diagnosis_;
                             return lengths_.size() <= opens_ ? first_ : last_;
                           })
        .Run();
  }
  [[nodiscard]] double Drawings_s() const {
    return 2.0 * static_cast<double>(request_.passes + 1) *
           (request_.path.duration_s + request_.check.duration_s);
  }
  static diagnosis::Diagnosis Cogging(double amplitude_Nm = 0.02) {
    static const diagnosis::StatedAxis stated =
        diagnosis::ToStatedAxis(LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml"), "x");
    diagnosis::Diagnosis d;
    d.verdict = diagnosis::Verdict::kCauseFound;
    diagnosis::Cause c;
    c.kind = "cogging";
    c.parameters["amplitude_Nm"] = {amplitude_Nm, 0.95 * amplitude_Nm, 1.05 * amplitude_Nm};
    c.parameters["order_per_rev"] = {12, 12, 12};
    c.parameters["phase_rad"] = {0.7, 0.6, 0.8};
    c.heldout_gain_low = 0.2;
    d.causes.push_back(c);
    d.in_model = d.causes;
    d.fitted = stated;
    return d;
  }
  static diagnosis::Diagnosis Open(diagnosis::Diagnosis d) {
    d.verdict = diagnosis::Verdict::kUnexplained;
    return d;
  }
  static diagnosis::Diagnosis Nothing() {
    diagnosis::Diagnosis d;
    d.verdict = diagnosis::Verdict::kNothingFound;
    return d;
  }
  [[nodiscard]] bool Ran(const std::string& name) const {
    return std::find(machine_.ran.begin(), machine_.ran.end(), name) != machine_.ran.end();
  }

  const MachineConfig config_ = LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml");
  FakeMachine machine_{config_};
  ImproveRequest request_;
  diagnosis::Diagnosis first_ = Cogging(), last_ = Cogging();
  std::size_t opens_ = 1;  ///< diagnoses that are first_
  bool fault_in_diagnosis_ = false;
  std::vector<std::size_t> lengths_;
};

TEST_F(ImproveSequenceTest, ADecidedCauseNeedsTheChirpAloneAndTheBetterModelStays) {
  const ImproveResult result = Run();
  EXPECT_TRUE(result.judgement.keep) << result.judgement.why;
  EXPECT_FALSE(Ran("a stroke"));
  EXPECT_TRUE(Ran("a chirp"));
  ASSERT_EQ(machine_.loaded.size(), 1u);
  EXPECT_NE(machine_.loaded[0].find("order_per_rev: 12"), std::string::npos);
  EXPECT_FALSE(machine_.enabled);
  EXPECT_EQ(result.before.path.size(), request_.passes + 1);
  ASSERT_NE(result.chosen(), nullptr);
  EXPECT_EQ(result.chosen()->drawn.check.size(), request_.passes + 1);
}

TEST_F(ImproveSequenceTest, WhatThePathLeavesOpenIsDecidedByExperimentsAndTheCheckIsNeverFittedOn) {
  first_ = Nothing();
  opens_ = 2;
  const ImproveResult result = Run();
  EXPECT_TRUE(Ran("a chirp"));
  EXPECT_TRUE(Ran("a stroke"));
  EXPECT_EQ(std::count(machine_.ran.begin(), machine_.ran.end(), "a chirp"), 1);
  ASSERT_EQ(result.diagnosed.size(), 3u);
  ASSERT_EQ(lengths_.size(), 3u);
  std::size_t path_rows = 0;
  for (std::size_t i = 0; i < 2; ++i) path_rows += result.before.path[i].log.rows;
  EXPECT_EQ(lengths_[0], path_rows);
  EXPECT_GT(lengths_[1], lengths_[0]);
  EXPECT_GT(lengths_[2], lengths_[1]);
  EXPECT_TRUE(result.judgement.keep);
}

TEST_F(ImproveSequenceTest, AModelThatIsNoBetterGivesWayToTheOldOne) {
  machine_.error_after_um = 1.0;
  const ImproveResult result = Run();
  EXPECT_FALSE(result.judgement.keep);
  ASSERT_EQ(machine_.loaded.size(), 2u);
  EXPECT_EQ(machine_.loaded[1], "");
  EXPECT_FALSE(machine_.enabled);
}

TEST_F(ImproveSequenceTest, WhereExperimentsMisleadThePathsOwnModelIsDrawnToo) {
  first_ = Open(Cogging(0.02));
  opens_ = 2;
  last_ = Open(Cogging(0.07));
  machine_.error_with_um = {{"0.07", 1.2}, {"0.02", 0.4}};
  const ImproveResult result = Run();
  ASSERT_EQ(result.tried.size(), 2u);
  EXPECT_FALSE(result.tried[0].judgement.keep);
  EXPECT_TRUE(result.judgement.keep);
  ASSERT_EQ(machine_.loaded.size(), 2u);
  EXPECT_NE(machine_.loaded.back().find("0.02"), std::string::npos);
}

TEST_F(ImproveSequenceTest, AModelThatTheDaemonRefusesIsPassedOver) {
  first_ = Open(Cogging(0.02));
  opens_ = 2;
  last_ = Open(Cogging(0.07));
  machine_.refuse_text = "0.07";
  const ImproveResult result = Run();
  EXPECT_TRUE(result.judgement.keep);
  EXPECT_EQ(result.tried.size(), 1u);
  ASSERT_EQ(result.left_out.size(), 1u);
  EXPECT_NE(result.left_out[0].find("does not take it"), std::string::npos);
  machine_ = FakeMachine(config_);
  machine_.refuse_text = "cogging";
  lengths_.clear();
  const ImproveResult none = Run();
  EXPECT_FALSE(none.judgement.keep);
  EXPECT_TRUE(machine_.loaded.empty());
}

TEST_F(ImproveSequenceTest, TheBestOfSeveralIsLoadedInTheEnd) {
  first_ = Open(Cogging(0.02));
  opens_ = 2;
  last_ = Open(Cogging(0.07));
  machine_.error_with_um = {{"0.07", 0.3}, {"0.02", 0.6}};
  const ImproveResult result = Run();
  ASSERT_EQ(machine_.loaded.size(), 3u);
  EXPECT_EQ(machine_.loaded.back(), machine_.loaded.front());
  EXPECT_EQ(*result.best, 0u);
}

TEST_F(ImproveSequenceTest, ModelsKeepToTheMachineTime) {
  first_ = Open(Cogging(0.02));
  opens_ = 2;
  last_ = Open(Cogging(0.07));
  machine_.error_with_um = {{"0.07", 1.2}, {"0.02", 0.4}};
  const double all_s = Run().machine_time_s;
  machine_ = FakeMachine(config_);
  machine_.error_with_um = {{"0.07", 1.2}, {"0.02", 0.4}};
  lengths_.clear();
  request_.machine_time_s = all_s - 1.0;
  const ImproveResult result = Run();
  EXPECT_EQ(result.tried.size(), 1u);
  EXPECT_FALSE(result.judgement.keep);
  EXPECT_EQ(result.left_out.size(), 1u);
  EXPECT_LE(result.machine_time_s, request_.machine_time_s);
}

TEST_F(ImproveSequenceTest, NothingFoundChangesNothing) {
  first_ = last_ = Nothing();
  const ImproveResult result = Run();
  EXPECT_FALSE(result.judgement.keep);
  EXPECT_TRUE(machine_.loaded.empty());
  EXPECT_FALSE(machine_.enabled);
}

TEST_F(ImproveSequenceTest, EveryStepCanBeRefusedAndLeavesTheOldModelWithoutTorque) {
  first_ = Nothing();
  opens_ = 2;
  Run();
  const std::size_t questions = machine_.asked.size();
  ASSERT_EQ(questions, 4u);
  for (std::size_t at = 1; at <= questions; ++at) {
    machine_ = FakeMachine(config_);
    machine_.refuse_at = at;
    lengths_.clear();
    EXPECT_THROW(Run(), Refused);
    EXPECT_FALSE(machine_.enabled);
    EXPECT_FALSE(machine_.new_model);
    if (at == 1) {
      EXPECT_TRUE(machine_.ran.empty());
    }
  }
}

TEST_F(ImproveSequenceTest, AFaultInAnyProgramLeavesTheOldModelWithoutTorque) {
  first_ = Nothing();
  Run();
  const std::size_t programs = machine_.ran.size();
  ASSERT_GT(programs, 10u);
  for (std::size_t at = 1; at <= programs; ++at) {
    machine_ = FakeMachine(config_);
    machine_.fail_at = at;
    lengths_.clear();
    EXPECT_THROW(Run(), std::runtime_error);
    EXPECT_FALSE(machine_.enabled);
    EXPECT_FALSE(machine_.new_model);
  }
}

// A fault waits for its reset, and contourd takes a model in Idle alone.
// Before: every model was "left out", and improve ended well.
TEST_F(ImproveSequenceTest, AFaultWhileItDiagnosesEndsIt) {
  fault_in_diagnosis_ = true;
  try {
    Run();
    ADD_FAILURE() << "a fault is no refused model";
  } catch (const ModelRefused& e) {
    ADD_FAILURE() << e.what();
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(), "the new model was not loaded: the machine is Faulted");
  }
  EXPECT_TRUE(machine_.loaded.empty());
  EXPECT_FALSE(machine_.enabled);
}

TEST_F(ImproveSequenceTest, AFaultWithTheNewModelLoadedWaitsForTheResetAndThenLoadsTheOldOne) {
  Run();
  const std::size_t last = machine_.ran.size();
  machine_ = FakeMachine(config_);
  machine_.fail_at = last;
  lengths_.clear();
  EXPECT_THROW(Run(), std::runtime_error);
  EXPECT_EQ(machine_.waited, 1);
  EXPECT_FALSE(machine_.new_model);
  machine_ = FakeMachine(config_);
  machine_.fail_at = last;
  machine_.nobody_resets = true;
  lengths_.clear();
  try {
    Run();
    FAIL();
  } catch (const std::exception& e) {
    EXPECT_NE(std::string(e.what()).find("the old model is not back"), std::string::npos) << e.what();
  }
  EXPECT_TRUE(machine_.new_model);
}

TEST_F(ImproveSequenceTest, ARecordWithHolesIsDrawnOnceMoreAndNotForEver) {
  machine_.lose_at = 2;  // the path, after the way to its start
  Run();
  const std::size_t with_holes = machine_.ran.size();
  machine_ = FakeMachine(config_);
  lengths_.clear();
  Run();
  EXPECT_GT(with_holes, machine_.ran.size());
  machine_ = FakeMachine(config_);
  machine_.lose_all = true;
  EXPECT_THROW(Run(), std::runtime_error);
  EXPECT_FALSE(machine_.enabled);
}

TEST_F(ImproveSequenceTest, ExperimentsKeepToTheMachineTime) {
  first_ = last_ = Nothing();
  request_.machine_time_s = Drawings_s() + 0.5;
  const ImproveResult result = Run();
  EXPECT_FALSE(Ran("a stroke"));
  ASSERT_EQ(result.left_out.size(), 2u);
  EXPECT_LE(result.machine_time_s, request_.machine_time_s);
}

TEST_F(ImproveSequenceTest, TooLittleTimeForTheDrawingsIsRefusedBeforeAnythingMoves) {
  request_.machine_time_s = Drawings_s() - 0.5;
  EXPECT_THROW(Run(), ConfigError);
  EXPECT_TRUE(machine_.asked.empty());
  EXPECT_TRUE(machine_.ran.empty());
}

// Before: what had lost cycles was run up to four times, whatever the time.
TEST_F(ImproveSequenceTest, NothingIsRunOnceMoreBeyondTheMachineTime) {
  request_.machine_time_s = Run().machine_time_s + 0.5;
  const std::vector<std::string> all = machine_.ran;
  const auto chirp = std::find(all.begin(), all.end(), "a chirp");
  ASSERT_NE(chirp, all.end());
  const auto lose = [&](std::size_t at) {
    machine_ = FakeMachine(config_);
    machine_.lose_at = at;
    lengths_.clear();
    return Run();
  };
  const ImproveResult without_chirp = lose(static_cast<std::size_t>(chirp - all.begin()) + 1);
  EXPECT_EQ(machine_.ran, all) << "each once";
  ASSERT_EQ(without_chirp.left_out.size(), 1u);
  EXPECT_TRUE(without_chirp.left_out[0].starts_with("a chirp: cycles never arrived"));
  EXPECT_LE(without_chirp.machine_time_s, request_.machine_time_s);
  EXPECT_TRUE(without_chirp.judgement.keep);
  const ImproveResult undecided = lose(all.size());
  EXPECT_EQ(machine_.ran, all);
  EXPECT_FALSE(undecided.judgement.keep);
  EXPECT_FALSE(machine_.new_model) << "nothing says that it is better";
  request_.machine_time_s = Drawings_s() + 0.5;
  EXPECT_THROW(lose(2), std::runtime_error) << "the drawing before";
  EXPECT_FALSE(machine_.enabled);
}

}  // namespace
}  // namespace contour::improve
