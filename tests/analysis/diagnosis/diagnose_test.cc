#include "analysis/diagnosis/diagnose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

test::HiddenOptions Hidden(std::uint64_t seed, const std::vector<test::HiddenEffect>& effects) {
  test::HiddenOptions o;
  o.seed = seed;
  o.duration_s = 30.0;
  o.effects = effects;
  return o;
}

struct Clear {
  test::HiddenEffect effect;
  const char* parameter;
  double truth;      ///< of the parameter
  double tolerance;  ///< relative
};

// One of each family of causes, hidden by code that shares nothing with the engine.
class ClearCause : public testing::TestWithParam<Clear> {};

TEST_P(ClearCause, IsNamedFirstWithItsSize) {
  const Clear& c = GetParam();
  const test::HiddenAxis axis = test::MakeHiddenAxis(Hidden(7, {c.effect}));
  const Diagnosis d = Diagnose(axis.log, axis.stated);
  ASSERT_FALSE(d.causes.empty());
  EXPECT_EQ(d.causes[0].kind, c.effect.kind);
  const Interval& found = d.causes[0].parameters.at(c.parameter);
  EXPECT_NEAR(found.value, c.truth, c.tolerance * std::fabs(c.truth));
  EXPECT_LT(found.low, found.high);
}

INSTANTIATE_TEST_SUITE_P(
    Families, ClearCause,
    testing::Values(Clear{{"friction_ripple", 0.042, 2.0, 0.7, 0.0}, "amplitude_rel", 0.042, 0.1},
                    Clear{{"torque_saturation", 0.02, 0.0, 0.0, 0.0}, "loss_at_rated_rel", 0.02, 0.1},
                    Clear{{"payload_step", 0.07, 0.0, 0.0, 0.45}, "inertia_change_rel", 0.07, 0.1},
                    Clear{{"encoder_eccentricity", 0.7, 1.0, 0.7, 0.0}, "amplitude_rad", 0.0007, 0.1},
                    Clear{{"pitch_error", 0.7, 0.0, 0.7, 0.0}, "amplitude_um", 0.7, 0.2},
                    Clear{{"sample_jitter", 14.0, 0.0, 0.0, 0.0}, "rms_us", 14.0, 0.1}),
    [](const auto& which) { return which.param.effect.kind; });

TEST(Diagnose, FindsNothingOnACleanAxis) {
  // At 0.1 % nominal, a sound threshold fails this with a chance of a few in a thousand, and the seed is
  // fixed.
  const test::HiddenAxis axis = test::MakeHiddenAxis(Hidden(102, {}));
  DiagnoseOptions options;
  options.false_alarm_rate = 0.001;
  const Diagnosis d = Diagnose(axis.log, axis.stated, options);
  EXPECT_EQ(d.verdict, Verdict::kNothingFound);
  EXPECT_TRUE(d.causes.empty());
  EXPECT_FALSE(d.smallest_detectable.empty());
}

// Before: of a drive without a stated delay fits began at none, and a coupling was told that is not there.
TEST(Diagnose, NamesADelayOfManyRows) {
  test::HiddenOptions o = Hidden(7, {{"input_delay", 5.0, 0.0, 0.0, 0.0}});
  o.duration_s = 20.0;
  o.scale = o.temperature = o.axis2 = false;
  test::HiddenAxis axis = test::MakeHiddenAxis(o);
  axis.stated.delay_s = axis.stated.lag_s = 0.0;
  const Diagnosis d = Diagnose(axis.log, axis.stated);
  ASSERT_FALSE(d.causes.empty());
  EXPECT_EQ(d.causes[0].kind, "input_delay");
  // A millisecond of delay and 0.2 of lag, which nobody stated, are there, too.
  EXPECT_NEAR(d.causes[0].parameters.at("delay_us").value, 6200.0, 300.0);
}

// Before: "nothing was found"; the rows in which the axis did not follow counted less, and nothing looked
// for a limit in them.
TEST(Diagnose, NamesALimitOfTheTorque) {
  test::HiddenOptions o = Hidden(7, {{"torque_limit", 0.5, 0.0, 0.0, 0.0}});
  o.duration_s = 20.0;
  o.scale = o.temperature = o.axis2 = false;
  const test::HiddenAxis axis = test::MakeHiddenAxis(o);
  const Diagnosis d = Diagnose(axis.log, axis.stated);
  ASSERT_FALSE(d.causes.empty());
  EXPECT_EQ(d.causes[0].kind, "torque_saturation");
  ASSERT_TRUE(d.causes[0].parameters.contains("limit_Nm"));
  EXPECT_NEAR(d.causes[0].parameters.at("limit_Nm").value, 0.32, 0.01);
}

// Before: `friction_drift`, a dry friction that changes, with the wrong size.
TEST(Diagnose, TellsViscousFromDryFrictionThatFallsOverSeveralFiles) {
  for (const char* kind : {"viscous_drift", "friction_drift"}) {
    const double change = kind[0] == 'v' ? -0.6 : -0.3;
    test::HiddenOptions o = Hidden(7, {{kind, change, 0.0, 0.0, 10.0}});
    o.scale = o.temperature = o.axis2 = false;
    test::HiddenAxis axis = test::MakeHiddenAxis(o);
    const std::size_t rows = axis.log.size();
    for (const std::size_t gap : {rows / 3, 2 * rows / 3})
      for (std::size_t k = gap; k < gap + 500; ++k) {
        axis.log.present[k] = 0;
        axis.log.position[k] = std::numeric_limits<double>::quiet_NaN();
      }
    const Diagnosis d = Diagnose(axis.log, axis.stated);
    ASSERT_FALSE(d.causes.empty());
    EXPECT_EQ(d.causes[0].kind, kind);
    EXPECT_TRUE(d.causes[0].indistinguishable_from.empty());
    EXPECT_NEAR(d.causes[0].parameters.at("change_rel").value, change * (1.0 - std::exp(-3.0)),
                0.15 * std::fabs(change));
  }
}

// Before: a coupling of the axis, or a lag of its drive.
TEST(Diagnose, AVelocityThatIsADifferenceOverSomeRowsIsNoCoupling) {
  test::HiddenOptions o = Hidden(102, {});
  o.duration_s = 20.0;
  o.scale = o.temperature = o.axis2 = false;
  test::HiddenAxis axis = test::MakeHiddenAxis(o);
  std::vector<double>& q = axis.log.position;
  for (std::size_t k = q.size(); k-- > 4;) q[k] = 0.2 * (q[k] + q[k - 1] + q[k - 2] + q[k - 3] + q[k - 4]);
  axis.log.from_velocity = true;
  const Diagnosis d = Diagnose(axis.log, axis.stated);
  for (const char* kind : {"compliance", "current_lag", "input_delay"})
    EXPECT_TRUE(std::none_of(d.causes.begin(), d.causes.end(), [&](const Cause& c) {
      return c.kind == kind;
    })) << kind;
  const auto tells = [](const std::string& note) {
    return note.find("The velocity comes") != std::string::npos;
  };
  EXPECT_TRUE(std::any_of(d.notes.begin(), d.notes.end(), tells));
}

TEST(Diagnose, ATorqueConstantThatNobodyStatedIsNotOff) {
  test::HiddenOptions o = Hidden(7, {});
  o.duration_s = 10.0;
  test::HiddenAxis axis = test::MakeHiddenAxis(o);
  EXPECT_TRUE(Diagnose(axis.log, axis.stated).smallest_detectable.contains("torque_constant"));
  axis.stated.open.insert("ampere");
  EXPECT_FALSE(Diagnose(axis.log, axis.stated).smallest_detectable.contains("torque_constant"));
  // Of an inertia alone, nothing says whether it is the one that is off.
  axis.stated.open = {"Fc", "s2"};
  EXPECT_FALSE(Diagnose(axis.log, axis.stated).smallest_detectable.contains("torque_constant"));
}

// What one diagnosis found and the model then states is part of the base of the next.
TEST(Diagnose, DoesNotFindAgainWhatTheModelStates) {
  test::HiddenOptions o = Hidden(7, {{"cogging", 0.05, 12.0, 0.7, 0.0}});
  o.duration_s = 20.0;
  o.scale = o.temperature = o.axis2 = false;
  test::HiddenAxis axis = test::MakeHiddenAxis(o);
  const Diagnosis first = Diagnose(axis.log, axis.stated);
  ASSERT_FALSE(first.causes.empty());
  ASSERT_EQ(first.causes[0].kind, "cogging");
  const auto value = [&](const char* name) { return first.causes[0].parameters.at(name).value; };
  const StatedWave found{value("amplitude_Nm"), value("order_per_rev"), value("phase_rad")};
  axis.stated.extras.cogging = {found};
  const Diagnosis second = Diagnose(axis.log, axis.stated);
  for (const Cause& c : second.causes) EXPECT_NE(c.kind, "cogging");
  EXPECT_LT(second.causes.size(), first.causes.size());

  o.effects.push_back({"friction_ripple", 0.1, 3.0, 0.2, 0.0});
  axis = test::MakeHiddenAxis(o);
  axis.stated.extras.cogging = {found};
  const Diagnosis third = Diagnose(axis.log, axis.stated);
  ASSERT_FALSE(third.causes.empty());
  EXPECT_EQ(third.causes[0].kind, "friction_ripple");
  EXPECT_NEAR(third.causes[0].parameters.at("amplitude_rel").value, 0.1, 0.01);
}

// Several orders of one kind are several causes.
TEST(Diagnose, FindsASecondOrderOfTheSameKind) {
  test::HiddenOptions o = Hidden(9, {{"cogging", 0.05, 12.0, 0.7, 0.0}, {"cogging", 0.05, 4.0, 0.2, 0.0}});
  o.duration_s = 20.0;
  o.scale = o.temperature = o.axis2 = false;
  const test::HiddenAxis axis = test::MakeHiddenAxis(o);
  const Diagnosis d = Diagnose(axis.log, axis.stated);
  std::vector<double> orders;
  for (const Cause& c : d.causes)
    if (c.kind == "cogging") orders.push_back(c.parameters.at("order_per_rev").value);
  std::sort(orders.begin(), orders.end());
  EXPECT_EQ(orders, (std::vector{4.0, 12.0}));
}

TEST(Diagnose, GivesNoNameToWhatNoCauseFits) {
  // A friction that jumps; a drift comes near and leaves a fifth of it.
  const test::HiddenAxis axis = test::MakeHiddenAxis(Hidden(9, {{"friction_step", 0.3, 0.0, 0.0, 0.0}}));
  const Diagnosis d = Diagnose(axis.log, axis.stated);
  EXPECT_EQ(d.verdict, Verdict::kUnexplained);
  for (const Cause& c : d.causes) EXPECT_TRUE(c.part_of_it) << c.kind;
  ASSERT_FALSE(d.notes.empty());
  const auto tells = [](const std::string& note) {
    return note.find("friction of time") != std::string::npos;
  };
  EXPECT_TRUE(std::any_of(d.notes.begin(), d.notes.end(), tells)) << d.notes[0];
  EXPECT_NE(d.notes.back().find("friction_drift"), std::string::npos) << d.notes.back();
}

TEST(Diagnose, SaysWhatTheLogCannotShow) {
  test::HiddenOptions o = Hidden(102, {});
  o.scale = o.temperature = o.axis2 = false;
  const test::HiddenAxis axis = test::MakeHiddenAxis(o);
  const Diagnosis d = Diagnose(axis.log, axis.stated);
  for (const char* kind : {"pitch_error", "temperature_viscosity", "cross_coupling"})
    EXPECT_NE(std::find(d.not_excited.begin(), d.not_excited.end(), kind), d.not_excited.end()) << kind;
  EXPECT_EQ(std::find(d.not_excited.begin(), d.not_excited.end(), "cogging"), d.not_excited.end());
}

TEST(Diagnose, GivesTheSameAnswerOnAnyNumberOfThreads) {
  test::HiddenOptions o = Hidden(11, {{"constant_torque", 0.05, 0.0, 0.0, 0.0}});
  o.duration_s = 20.0;
  const test::HiddenAxis axis = test::MakeHiddenAxis(o);
  DiagnoseOptions one, three;
  three.threads = 3;
  const Diagnosis a = Diagnose(axis.log, axis.stated, one), b = Diagnose(axis.log, axis.stated, three);
  ASSERT_EQ(a.causes.size(), b.causes.size());
  ASSERT_FALSE(a.causes.empty());
  EXPECT_EQ(a.threshold, b.threshold);
  EXPECT_EQ(a.causes[0].kind, "constant_torque");
  EXPECT_EQ(a.causes[0].kind, b.causes[0].kind);
  EXPECT_EQ(a.causes[0].log_evidence_gain, b.causes[0].log_evidence_gain);
  EXPECT_GT(a.causes[0].heldout_gain_low, 0.0);
}

TEST(Diagnose, RefusesColumnsOfDifferentLength) {
  test::HiddenOptions o;
  o.duration_s = 5.0;
  test::HiddenAxis axis = test::MakeHiddenAxis(o);
  axis.log.position.pop_back();
  EXPECT_THROW(Diagnose(axis.log, axis.stated), std::invalid_argument);
}

// At a rate at which some candidates exceed chance, but not the threshold.
TEST(Diagnose, IsTheSameWhereItsEvidenceIsWatched) {
  test::HiddenOptions o = Hidden(103, {});
  o.duration_s = 20.0;
  o.scale = o.temperature = o.axis2 = false;
  const test::HiddenAxis axis = test::MakeHiddenAxis(o);
  DiagnoseOptions options;
  options.false_alarm_rate = 0.5;
  const Diagnosis alone = Diagnose(axis.log, axis.stated, options);
  int told = 0;
  options.evidence = [&](const Evidence&) { ++told; };
  const Diagnosis watched = Diagnose(axis.log, axis.stated, options);
  EXPECT_GT(told, 0);
  EXPECT_EQ(alone.verdict, watched.verdict);
  EXPECT_EQ(alone.causes.size(), watched.causes.size());
  ASSERT_EQ(alone.base.size(), watched.base.size());
  for (std::size_t i = 0; i < alone.base.size(); ++i)
    EXPECT_EQ(alone.base[i].fitted, watched.base[i].fitted) << alone.base[i].name;
}

}  // namespace
}  // namespace contour::diagnosis
