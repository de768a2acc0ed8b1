// What the hidden cases themselves promise.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "tools/simulate/virtual_machine.h"
#include "tools/validation/hidden/draw_setting.h"
#include "tools/validation/hidden/hide_effect.h"
#include "tools/validation/hidden/judge.h"
#include "tools/validation/hidden/machine_text.h"
#include "tools/validation/hidden/outcome.h"
#include "tools/validation/hidden/record_case.h"
#include "tools/validation/hidden/recorded_case.h"
#include "tools/validation/hidden/residual.h"
#include "tools/validation/hidden/size_effect.h"
#include "tools/validation/hidden/specimens.h"

namespace contour::hidden {
namespace {

class HiddenCases : public ::testing::Test {
 protected:
  void SetUp() override {
    directory_ = std::filesystem::temp_directory_path() / ("hidden_cases_test." + std::to_string(getpid()));
    std::filesystem::create_directories(directory_);
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }
  std::filesystem::path directory_;
};

TEST(LowestCredible, IsTheBinomialBound) {
  // P(X <= 7 | 10, 0.99) = 1.1e-4, P(X <= 8) = 4.3e-3.
  EXPECT_EQ(LowestCredible(10, 0.99, 1e-3), 8);
  EXPECT_EQ(LowestCredible(10, 0.99, 5e-3), 9);
  EXPECT_EQ(LowestCredible(5, 0.999, 1e-3), 4);
  EXPECT_EQ(LowestCredible(0, 0.9, 1e-3), 0);
}

TEST(HiddenSettings, TheSameSeedIsTheSameMachineAndTheModelIsNotTheTruth) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Setting a = DrawSetting(seed, {"cogging"});
    EXPECT_EQ(MachineText(a), MachineText(DrawSetting(seed, {"cogging"})));
    EXPECT_EQ(a.program, DrawSetting(seed, {"cogging"}).program);
    EXPECT_NE(MachineText(a), MachineText(DrawSetting(seed + 1, {"cogging"})));
    EXPECT_NE(a.truth.Fc_N, a.stated.Fc_N);
    EXPECT_LE(std::abs(a.truth.Fc_N / a.stated.Fc_N - 1.0), 0.2) << "twice the stated uncertainty";
    EXPECT_LE(std::abs(a.truth.motor_inertia_kgm2 / a.stated.motor_inertia_kgm2 - 1.0), 0.1);
  }
}

TEST(HiddenSettings, EveryMachineFileIsAccepted) {
  const auto file = std::filesystem::temp_directory_path() / ("hidden_machine." + std::to_string(getpid()));
  for (const Misfit misfit : {Misfit::kNone, Misfit::kMaxwellSlip})
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      std::ofstream(file) << MachineText(DrawSetting(seed, {}, misfit));
      EXPECT_NO_THROW(VirtualMachine(LoadEmulatedMachine(file.string()), ControllerName::kPid))
          << Name(misfit) << " " << seed;
    }
  std::filesystem::remove(file);
}

TEST(HiddenSettings, NothingOfTheEffectStandsInTheFiles) {
  for (const std::string& kind : CatalogueKinds()) {
    const Setting s = DrawSetting(3, {kind});
    EXPECT_EQ(MachineText(s).find("effects"), std::string::npos);
    EXPECT_EQ(ModelText(s).find(kind + ":"), std::string::npos) << kind;
  }
}

/// A log without encoder steps, without noise and with the model that made it leaves no residual: emulator
/// and log share the timing of ../ARCHITECTURE.md, and the strengths are measured against noise alone.
TEST_F(HiddenCases, WithoutNoiseAndEffectTheResidualIsFarBelowTheNoise) {
  for (const std::uint64_t seed : {1ULL, 2ULL}) {
    Setting s = DrawSetting(seed, {}, Misfit::kNone, Length::kShort);
    const Residuals noisy = ResidualsOf(Simulate(s, {}, directory_), s);
    s.stated.encoder_counts_per_rev = s.truth.encoder_counts_per_rev = 4194304.0;
    s.truth.torque_noise_Nm = 0.0;
    const Residuals quiet = ResidualsOf(Simulate(s, {}, directory_), s);
    EXPECT_LT(std::sqrt(quiet.torque_Nm2), 0.2 * std::sqrt(noisy.torque_Nm2)) << "seed " << seed;
  }
}

TEST_F(HiddenCases, AnEffectIsMadeAsStrongAsItsName) {
  const Setting s = DrawSetting(5, {"cogging"}, Misfit::kNone, Length::kShort);
  const Hidden drawn = DrawEffect(5, "cogging", s);
  const auto clear = SizeEffect(s, drawn, Strength::kClear, directory_);
  const auto barely = SizeEffect(s, drawn, Strength::kBarely, directory_);
  ASSERT_TRUE(clear && barely);
  const double clean = ResidualsOf(Simulate(s, {}, directory_), s).torque_Nm2;
  const double with = ResidualsOf(Simulate(s, {*clear}, directory_), s).torque_Nm2;
  EXPECT_NEAR(1.0 - clean / with, 0.55, 0.05);
  EXPECT_NEAR(barely->size / clear->size, std::sqrt((0.02 / 0.98) / (0.55 / 0.45)), 0.02);
}

TEST_F(HiddenCases, WhatIsReadIsWhatTheMachineDid) {
  Setting s = DrawSetting(7, {"temperature_viscosity"});
  s.truth.scale_counts_per_mm = s.stated.scale_counts_per_mm = 1000.0;
  Record(s, {}, directory_);
  const Recorded recorded = ReadRecorded(directory_);
  const diagnosis::AxisLog direct = Simulate(s, {}, directory_);
  ASSERT_GE(recorded.log.size(), direct.size());
  EXPECT_EQ(recorded.log.missing, 0u);
  for (std::size_t k = 0; k < direct.size(); k += 997) {
    EXPECT_EQ(recorded.log.command[k], direct.command[k]);
    EXPECT_EQ(recorded.log.position[k], direct.position[k]);
  }
  EXPECT_EQ(recorded.log.temperature_degC.size(), recorded.log.size());
  EXPECT_EQ(recorded.log.table_position_m.size(), recorded.log.size());
  const auto [coolest, warmest] =
      std::minmax_element(recorded.log.temperature_degC.begin(), recorded.log.temperature_degC.end());
  EXPECT_GT(*warmest - *coolest, 3.0) << "warm-up";
  EXPECT_LT(recorded.log.temperature_degC.back(), *warmest - 0.5) << "and cool-down";

  Compact(directory_);
  EXPECT_FALSE(std::filesystem::exists(directory_ / "log.lcm"));
  const diagnosis::AxisLog table = ReadRecorded(directory_).log;
  EXPECT_EQ(table.command, recorded.log.command);
  EXPECT_EQ(table.position, recorded.log.position);
  EXPECT_EQ(table.table_position_m, recorded.log.table_position_m);
  EXPECT_EQ(table.temperature_degC, recorded.log.temperature_degC);
  EXPECT_EQ(table.reference_position, recorded.log.reference_position);
  EXPECT_DOUBLE_EQ(table.period_s, recorded.log.period_s);
}

/// A short case from the drawing to the line of the table; the diagnoser is the test's.
TEST_F(HiddenCases, AreRecordedWithTheirTruthAndJudgedLater) {
  const Question q{Question::Type::kEffect, {"friction_drift"}, Strength::kClear, 4,
                   Misfit::kNone,           Length::kShort};
  EXPECT_EQ(CaseName(q), "clear_friction_drift_short_0004");
  EXPECT_FALSE(IsRecorded(directory_));
  const KnownCase known = RecordCase(q, directory_, true);
  ASSERT_TRUE(known.usable) << known.why_not;
  ASSERT_TRUE(IsRecorded(directory_));
  const KnownCase read = ReadTruth(directory_);
  EXPECT_EQ(CaseName(read.question), CaseName(q));
  ASSERT_EQ(read.hidden.size(), 1u);
  EXPECT_EQ(read.hidden[0].truth, known.hidden[0].truth);
  const double change = known.hidden[0].truth.at("change_rel");
  // Most of the drift lies within the log, the rest before it.
  EXPECT_GT(change / known.hidden[0].size, 0.7);
  EXPECT_LT(change / known.hidden[0].size, 1.0);

  const auto answers = [](const std::string& kind, double value, double half_width) {
    return [=](const diagnosis::AxisLog& log, const diagnosis::StatedAxis&, double rate) {
      EXPECT_GT(log.size(), 30000u);
      EXPECT_EQ(rate, 0.01);
      diagnosis::Diagnosis d;
      d.verdict = diagnosis::Verdict::kCauseFound;
      d.causes.resize(2);
      d.causes[0].kind = kind;
      d.causes[0].heldout_gain = 0.25;
      d.causes[0].parameters["change_rel"] = {value, value - half_width, value + half_width};
      d.causes[1].kind = "cogging";
      return d;
    };
  };
  const Outcome good = AskCase(directory_, answers("friction_drift", change + 0.01, 0.02), 0.01);
  EXPECT_TRUE(good.judged.right && good.judged.itself && good.judged.inside);
  EXPECT_EQ(good.judged.extra, 1);
  const Outcome off = AskCase(directory_, answers("friction_drift", change + 0.01, 0.005), 0.01);
  EXPECT_TRUE(off.judged.right && !off.judged.inside);
  const Outcome wrong = AskCase(directory_, answers("payload_step", change, 0.02), 0.01);
  EXPECT_FALSE(wrong.judged.right || wrong.judged.itself);

  const auto csv = directory_ / "results.csv";
  for (const Outcome& o : {good, off, wrong}) AppendCsv(csv, o);
  const std::vector<Outcome> back = ReadCsv(csv);
  ASSERT_EQ(back.size(), 3u);
  EXPECT_EQ(CaseName(back[0].known.question), CaseName(q));
  EXPECT_TRUE(back[0].judged.inside);
  EXPECT_EQ(back[1].judged.outside.find("change_rel"), 0u);
  EXPECT_EQ(back[2].judged.answer, "payload_step + cogging");
  EXPECT_DOUBLE_EQ(back[2].false_alarm_rate, 0.01);
}

TEST(Judging, LeavesOutWhatOnlyNamesTheMisfit) {
  diagnosis::Diagnosis d;
  d.verdict = diagnosis::Verdict::kCauseFound;
  d.causes.resize(1);
  d.causes[0].kind = "input_delay";
  EXPECT_FALSE(Judge(d, {}, Misfit::kNone).right) << "a false alarm";
  EXPECT_TRUE(Judge(d, {}, Misfit::kTimingError).right) << "the timing is off indeed";
  EXPECT_FALSE(Judge(d, {}, Misfit::kNoiseLevel).right);
  d.causes.resize(2);
  d.causes[1].kind = "cogging";
  Hidden cogging;
  cogging.kind = "cogging";
  EXPECT_TRUE(Judge(d, {cogging}, Misfit::kTimingError).right);
  EXPECT_FALSE(Judge(d, {cogging}, Misfit::kNone).right) << "the second one only";
}

TEST(Judging, APairIsFoundWhenBothAreNamedInSetsOfTwoAtMost) {
  diagnosis::Diagnosis d;
  d.verdict = diagnosis::Verdict::kCauseFound;
  d.causes.resize(2);
  d.causes[0].kind = "cogging";
  d.causes[1].kind = "input_delay";
  d.causes[1].indistinguishable_from = {"current_lag"};
  std::vector<Hidden> hidden(2);
  hidden[0].kind = "current_lag";
  hidden[1].kind = "cogging";
  EXPECT_TRUE(Judge(d, hidden, Misfit::kNone).both);
  d.causes[1].indistinguishable_from = {"current_lag", "compliance"};
  EXPECT_FALSE(Judge(d, hidden, Misfit::kNone).both);
}

}  // namespace
}  // namespace contour::hidden
