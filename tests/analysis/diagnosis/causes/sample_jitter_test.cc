#include <gtest/gtest.h>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "sample_jitter";

TEST(SampleJitter, HasNoMeanEffectThatCouldBeFitted) {
  const CauseDefinition& cause = CauseNamed(kKind);
  EXPECT_EQ(&cause, &CauseInScatter());
  EXPECT_EQ(*cause.grid, nullptr);
  EXPECT_EQ(*cause.wave, nullptr);
  EXPECT_EQ(*cause.extension, nullptr);
}

TEST(SampleJitter, IsDecidedByConstantSpeeds) {
  const test::KnownAxis axis;
  const auto creep = std::get<CreepShape>(test::DecidingProgram(axis, kKind).shape);
  // 2, 30 and 95 % of the highest speed of the log, 157 mm/s.
  EXPECT_EQ(creep.velocities_mm_s, (std::vector<double>{3.14, 47.1, 149.0}));
  EXPECT_EQ(creep.repeats, 1);
}

TEST(SampleJitter, ASpecimenIsJudgedByTheSecondDifferences) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  EXPECT_EQ(*s.strength_in, StrengthIn::kSecondDifference);
  const Drawn drawn = (*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({0.5}));
  const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.sample_jitter->rms_us, (*s.truth)(drawn, {}).at("rms_us"));
  EXPECT_TRUE(test::EmulatedWith((*s.effect)({.size = *s.largest_size}, {}, {})).errors.empty());
}

}  // namespace
}  // namespace contour::diagnosis
