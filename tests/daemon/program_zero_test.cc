#include "daemon/program_zero.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

CycleRecord StandsAt(double x_m, ReferenceState state = ReferenceState::kNeverTold) {
  CycleRecord record;
  record.axes.resize(1);
  record.axes[0].reference.position_m = x_m;
  record.axes[0].reference_state = state;
  return record;
}

TEST(ProgramZeroTest, TheFirstProgramSetsItAndItStays) {
  ProgramZero zero;
  EXPECT_FALSE(zero.zero_m().has_value());
  const ProgramZero::Found first = zero.ForProgram(StandsAt(0.1), false);
  ASSERT_TRUE(first.place.has_value());
  EXPECT_TRUE(first.set_now);
  EXPECT_FALSE(zero.zero_m().has_value()) << "the program may yet be refused";
  zero.Set(StandsAt(0.1));
  const ProgramZero::Found second = zero.ForProgram(StandsAt(0.3), false);
  ASSERT_TRUE(second.place.has_value());
  EXPECT_FALSE(second.set_now);
  EXPECT_EQ(second.place->zero_m[0], 0.1);
  EXPECT_EQ(second.place->start_m[0], 0.3);
  const ProgramZero::Found here = zero.ForProgram(StandsAt(0.3), true);
  EXPECT_EQ(here.place->zero_m[0], 0.3);
  EXPECT_EQ((*zero.zero_m())[0], 0.1) << "for that program alone";
}

TEST(ProgramZeroTest, IsLostWithThePlaceOfAnAxisAndSaysSoUntilItIsSetAnew) {
  ProgramZero zero;
  zero.Set(StandsAt(0.1));
  for (const CycleRecord& now : {StandsAt(0.0, ReferenceState::kLost), StandsAt(0.0)}) {
    const ProgramZero::Found lost = zero.ForProgram(now, false);
    EXPECT_FALSE(lost.place.has_value());
    EXPECT_NE(lost.refused.find("contour zero"), std::string::npos) << lost.refused;
    EXPECT_TRUE(zero.ForProgram(now, true).place.has_value()) << "from here it goes";
  }
  zero.Set(StandsAt(0.2, ReferenceState::kTold));
  EXPECT_EQ(zero.ForProgram(StandsAt(0.4, ReferenceState::kTold), false).place->zero_m[0], 0.2);
  zero.Lose("an axis was told where it is");
  EXPECT_FALSE(zero.ForProgram(StandsAt(0.4, ReferenceState::kTold), false).place.has_value());
}

}  // namespace
}  // namespace contour
