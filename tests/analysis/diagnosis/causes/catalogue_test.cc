// What the causes must have in common, whoever adds one.

#include "analysis/diagnosis/causes/catalogue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <string>

#include "analysis/diagnosis/causes/waves.h"
#include "config/yaml_writer.h"
#include "tests/analysis/support/hidden_axis.h"
#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

TEST(Catalogue, NamesAreUniqueAndFindTheirCause) {
  std::set<std::string_view> names;
  for (const CauseDefinition* c : AllCandidates()) {
    EXPECT_TRUE(names.insert(*c->name).second) << *c->name;
    EXPECT_EQ(FindCause(*c->name), c);
    EXPECT_EQ(&CauseNamed(*c->name), c);
  }
  EXPECT_EQ(FindCause("no_such_cause"), nullptr);
  EXPECT_THROW(CauseNamed("no_such_cause"), std::out_of_range);
}

TEST(Catalogue, WhatIsOutsideComesAfterTheCausesAndSaysSo) {
  const auto all = AllCauses(), candidates = AllCandidates();
  ASSERT_LT(all.size(), candidates.size());
  for (std::size_t i = 0; i < candidates.size(); ++i)
    EXPECT_EQ((*candidates[i]->name).starts_with(kOutside), i >= all.size()) << *candidates[i]->name;
}

TEST(Catalogue, EveryCauseHasWordsAnExperimentAndASpecimen) {
  for (const CauseDefinition* c : AllCauses()) {
    EXPECT_GT((*c->words).size(), 10u) << *c->name;
    EXPECT_TRUE((*c->advice).ends_with('.')) << *c->name;
    EXPECT_FALSE((*c->main_parameter).empty()) << *c->name;
    EXPECT_NE(*c->experiment, nullptr) << *c->name;
    // The emulated machine has no effect of this one; diagnose_test and tests/strangers hide it.
    EXPECT_EQ(*c->specimen == nullptr, *c->name == "viscous_drift") << *c->name;
  }
}

TEST(Catalogue, OneCauseShowsInTheScatterOnlyAndEveryOtherHasHypotheses) {
  EXPECT_TRUE(CauseInScatter().in_scatter_only);
  for (const CauseDefinition* c : AllCandidates()) {
    const bool hypotheses = *c->grid != nullptr || *c->wave != nullptr;
    EXPECT_NE(hypotheses, *c->in_scatter_only) << *c->name;
    EXPECT_EQ(hypotheses, *c->parameters != nullptr) << *c->name;
  }
}

TEST(Catalogue, EveryQuantityHasOneCauseWhoseExperimentShowsMoreOfIt) {
  std::map<Quantity, int> count;
  for (const CauseDefinition* c : AllCauses())
    if (*c->shows_more_of) ++count[**c->shows_more_of];
  for (const Quantity q : {Quantity::kPosition, Quantity::kSpeed, Quantity::kTravelSinceReversal,
                           Quantity::kAngle, Quantity::kTemperature, Quantity::kTime})
    EXPECT_EQ(count[q], 1) << static_cast<int>(q);
}

TEST(Catalogue, EveryOrderOfAWaveBelongsToOneCause) {
  for (const Wave wave : {Wave::kFrictionOfAngle, Wave::kTorqueOfAngle, Wave::kReadingOfAngle,
                          Wave::kForceOfTime, Wave::kGainOfAngle})
    for (const double order : {0.4, 1.0, 2.0, 2.35, 512.0}) {
      const auto candidates = AllCandidates();
      EXPECT_EQ(std::count_if(candidates.begin(), candidates.end(),
                              [&](const CauseDefinition* c) {
                                const WaveSource* source = c->wave;
                                return source != nullptr && *source->wave == wave &&
                                       (*source->has_order)(order);
                              }),
                1)
          << static_cast<int>(wave) << " at " << order;
    }
}

TEST(Catalogue, TheErrorsOfAModelAreOfParametersThatASpecimenOrACauseHas) {
  for (const CauseDefinition* c : AllCauses())
    for (const ModelError& e : *c->model_errors) {
      EXPECT_GT(e.sigma_rel, 0.0) << *c->name;
      EXPECT_LT(e.sigma_rel, 0.5) << *c->name;
    }
}

TEST(Catalogue, ASpecimenKnowsTheTruthOfTheMainParameter) {
  const SpecimenMachine machine = {.friction_Nm = 0.05,
                                   .vs_rad_s = 2.0,
                                   .speed_limit_rad_s = 300.0,
                                   .emulated_stroke_mm = 260.0,
                                   .travel_mm = 240.0,
                                   .other_axis = "y"};
  const LogSpan span = {1.0, 100.0, 100.0, 250.0, 300.0};
  for (const CauseDefinition* c : AllCauses()) {
    if (*c->specimen == nullptr) continue;
    const Specimen& s = **c->specimen;
    const Drawn drawn = (*s.draw)(machine, 1.0, [] { return 0.25; });
    EXPECT_TRUE((*s.truth)(drawn, span).contains(std::string(*c->main_parameter))) << *c->name;
    EXPECT_GE(*s.largest_size, std::abs(drawn.size) * (*s.sizes ? (**s.sizes)[0] : 1.0)) << *c->name;
    EXPECT_FALSE((*s.effect)(drawn, machine, {1.0, 99.0}).empty()) << *c->name;
  }
}

TEST(Catalogue, WhatAnExtensionAddsItRemoves) {
  for (const CauseDefinition* c : AllCauses()) {
    if (*c->extension == nullptr) continue;
    Cause cause;
    cause.kind = *c->name;
    for (const char* parameter : {"Fs_over_Fc", "vs_rad_s", "stiffness_Nm_rad", "ratio", "order_per_rev"})
      cause.parameters[parameter] = {1.5, 1.0, 2.0};
    cause.parameters[std::string(*c->main_parameter)] = {0.1, 0.05, 0.15};
    cause.shapes.push_back({"position_mm", "y", {-1.0, 1.0}, {0.1, 0.2}, {0.0, 0.0}});
    ExtensionsConfig extensions;
    (*c->extension->add)(cause, 20.0, extensions);
    const std::string written = WriteYaml(extensions);
    EXPECT_TRUE(written.starts_with(std::string(*c->name) + ":")) << *c->name << "\n" << written;
    (*c->extension->remove)(extensions);
    EXPECT_EQ(WriteYaml(extensions), "") << *c->name;
  }
}

TEST(Catalogue, EveryHypothesisIsOfItsCauseAndHasTheMainParameter) {
  test::HiddenOptions o;
  o.seed = 3;
  o.duration_s = 10.0;
  const test::LearntProblem learnt(test::MakeHiddenAxis(o));
  for (const CauseDefinition* c : AllCandidates()) {
    if (*c->grid == nullptr) continue;
    std::vector<SharedEffect> effects;
    (*c->grid)(learnt.problem, effects);
    for (const SharedEffect& e : effects) {
      EXPECT_EQ(e->kind, *c->name);
      EXPECT_EQ(e->common_factor, *c->common_factor) << e->kind;
      Point point = learnt.point;
      point.effects = {e};
      point.amplitudes = {e->start.empty() ? e->steps : e->start};
      // A limit of the torque is told by its level: none is lost below it.
      const std::string main = e->label == "limit" ? "limit_Nm" : std::string(*c->main_parameter);
      EXPECT_TRUE((*c->parameters)({learnt.problem, point, 0}).contains(main)) << e->kind << " " << e->label;
    }
  }
}

TEST(Catalogue, SlidingTellsAllKindsApartButThoseThatSaySo) {
  EXPECT_TRUE(SameInSliding("constant_torque", "asymmetric_coulomb"));
  EXPECT_TRUE(SameInSliding("asymmetric_coulomb", "constant_torque"));
  EXPECT_FALSE(SameInSliding("constant_torque", "constant_torque"));
  EXPECT_FALSE(SameInSliding("constant_torque", "cable_spring"));
  EXPECT_FALSE(SameInSliding("cable_spring", "stribeck")) << "neither says so";
  EXPECT_THROW((void)SameInSliding("none", "constant_torque"), std::out_of_range);
}

}  // namespace
}  // namespace contour::diagnosis
