#include "analysis/diagnosis/causes/kind_words.h"

#include <gtest/gtest.h>

#include <string_view>

#include "analysis/diagnosis/causes/catalogue.h"

namespace contour::diagnosis {
namespace {

TEST(KindWords, TheNameComesFirstThenWhatItIs) {
  EXPECT_EQ(KindWords("backlash"), "backlash: free play between motor and table");
  EXPECT_EQ(KindWords("outside:force of time"), "outside:force of time") << "it has no words";
  EXPECT_EQ(KindWords("no_such_cause"), "no_such_cause");
}

TEST(KindWords, AdviceIsASentence) {
  EXPECT_EQ(KindAdvice("cogging"), "Feed the torque forward.");
  EXPECT_EQ(KindAdvice("no_such_cause"), "");
}

TEST(KindWords, AValueHasTheUnitOfItsName) {
  EXPECT_EQ(ValueWords("amplitude_Nm", 0.0191), "0.0191 Nm");
  EXPECT_EQ(ValueWords("gap_um", 3.0), "3 um");
  EXPECT_EQ(ValueWords("change_rel", -0.125), "-12.5 %");
  EXPECT_EQ(ValueWords("Fs_over_Fc", 1.5), "1.5");
  EXPECT_EQ(ValueWords("torque_per_acceleration_Nms2_m", 0.002), "0.002 Nm s^2/m");
}

TEST(KindWords, AParametersWordsHaveNoUnit) {
  EXPECT_EQ(ParameterWords("amplitude_Nm"), "amplitude");
  EXPECT_EQ(ParameterWords("change_rel"), "change");
  EXPECT_EQ(ParameterWords("time_constant_s"), "time constant");
  EXPECT_EQ(ParameterWords("torque_per_acceleration_Nms2_m"), "torque per acceleration");
  EXPECT_EQ(ParameterWords("friction_per_torque_rel"), "friction per torque");
  // Before: "amplitude once per", in "turn/um".
  EXPECT_EQ(ParameterWords("amplitude_once_per_turn_um"), "amplitude once per turn");
  EXPECT_EQ(ValueWords("amplitude_once_per_turn_um", 33.0), "33 um");
}

TEST(KindWords, EveryKindHasWords) {
  for (const CauseDefinition* cause : AllCauses()) {
    const std::string_view kind = cause->name;
    EXPECT_GT(KindWords(kind).size(), kind.size() + 5) << kind;
    EXPECT_FALSE(KindAdvice(kind).empty()) << kind;
  }
  EXPECT_EQ(ValueWords("amplitude_rel", 0.25), "25 %");
  EXPECT_EQ(ValueWords("stiffness_Nm_rad", 12.5), "12.5 Nm/rad");
  EXPECT_EQ(ParameterWords("torque_at_stroke_end_Nm"), "torque at stroke end");
}

}  // namespace
}  // namespace contour::diagnosis
