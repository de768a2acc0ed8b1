#include "analysis/diagnosis/tuning/model_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string_view>

namespace contour::diagnosis {
namespace {

constexpr std::string_view kNoneOfItsOwn = "a kind that no table has";

TEST(ModelError, AnAllowanceGrowsWithTheLogarithmOfTheRate) {
  for (const std::string_view kind :
       {kNoneOfItsOwn, kUnexplainedAll, kUnexplainedTorque, kUnexplainedFriction}) {
    const double at_1e_3 = AllowancePerRow(kind, 1e-3), at_1e_4 = AllowancePerRow(kind, 1e-4),
                 at_1e_5 = AllowancePerRow(kind, 1e-5);
    EXPECT_GT(at_1e_3, 0.0) << kind;
    EXPECT_GT(at_1e_4, at_1e_3) << kind;
    EXPECT_NEAR(at_1e_5 - at_1e_4, at_1e_4 - at_1e_3, 1e-12) << kind;
  }
}

constexpr ErrorScore kTable[] = {
#include "analysis/diagnosis/tuning/model_error_table.inc"
};

TEST(ModelError, AllKindsTogetherAlarmAsOftenAsAsked) {
  for (const double rate : {1e-3, 1e-5}) {
    double exceed = 0.0;
    for (const ErrorScore& e : kTable)
      if (!IsStructureClass(e.kind))
        exceed += e.share * std::exp(-1e5 * AllowancePerRow(e.kind, rate) / e.scale);
    EXPECT_NEAR(exceed / rate, 1.0, 1e-9);
  }
}

TEST(ModelError, WhatNoCauseExplainsHasARateForEachOfItsClasses) {
  for (const ErrorScore& e : kTable)
    if (IsStructureClass(e.kind)) {
      EXPECT_NEAR(e.share * std::exp(-1e5 * AllowancePerRow(e.kind, 1e-4) / e.scale), 1e-4, 1e-12) << e.kind;
    }
}

TEST(ModelError, WhereEveryLogMayAlarmNothingIsAllowed) {
  for (const std::string_view kind : {kNoneOfItsOwn, kUnexplainedAll})
    EXPECT_EQ(AllowancePerRow(kind, 1.0), 0.0);
}

TEST(ModelError, LeakageIsASmallShareOfAScore) {
  for (const std::string_view kind :
       {kNoneOfItsOwn, std::string_view("backlash"), std::string_view("compliance")}) {
    EXPECT_GE(LeakageShare(kind), 0.0) << kind;
    EXPECT_LT(LeakageShare(kind), 0.1) << kind;
    EXPECT_GE(LeakageShareOfItsKind(kind), 0.0) << kind;
  }
}

TEST(ModelError, KindsOfTheirOwnHaveNumbersOfTheirOwn) {
  EXPECT_EQ(LeakageShare(kNoneOfItsOwn), LeakageShare("another kind that no table has"));
  EXPECT_NE(LeakageShare("compliance"), LeakageShare(kNoneOfItsOwn)) << "a coupling leaves more than others";
  EXPECT_NE(AllowancePerRow(kUnexplainedFriction, 1e-3), AllowancePerRow(kUnexplainedTorque, 1e-3));
  EXPECT_TRUE(IsStructureClass(kUnexplainedTorque));
  EXPECT_FALSE(IsStructureClass("cogging"));
}

}  // namespace
}  // namespace contour::diagnosis
