#include "daemon/recording_mode.h"

#include <gtest/gtest.h>

#include "config/config_error.h"

namespace contour {
namespace {

using List = std::vector<std::string>;

TEST(RecordingOverrides, PutsEveryAxisIntoTorqueModeWithItsLoop) {
  EXPECT_EQ(RecordingOverrides({{"x={a: 1}", "y={a: 2}"}, {"y={b: 3}"}}),
            (List{"axes.x.drive.mode=cst", "axes.x.loop={a: 1}", "axes.y.drive.mode=cst",
                  "axes.y.loop={a: 2}", "axes.y.model={b: 3}", "control.friction=linear"}));
  EXPECT_EQ(RecordingOverrides({{}, {"y={b: 3}"}}), List{}) << "the machine file's own mode";
}

TEST(RecordingOverrides, LeavesEveryAxisToItsDrive) {
  EXPECT_EQ(RecordingOverrides({{}, {}, {"x", "y"}}),
            (List{"axes.x.drive.mode=csp", "axes.y.drive.mode=csp", "control.friction=linear"}));
}

TEST(RecordingOverrides, RefusesWhatIsNotAnAxisAndItsLoop) {
  for (const char* wrong : {"x", "={a: 1}", "x="})
    EXPECT_THROW(RecordingOverrides({{wrong}, {}}), ConfigError) << wrong;
}

// Who asked for it may be killed before it is given back.
TEST(RecordingModeText, IsToldWhileItLasts) {
  EXPECT_FALSE(RecordingModeText({}).has_value());
  EXPECT_NE(RecordingModeText({{}, {}, {"x"}}).value_or("").find("csp"), std::string::npos);
  EXPECT_NE(RecordingModeText({{"x={a: 1}"}, {}}).value_or("").find("torque mode"), std::string::npos);
}

TEST(WithoutRecordingMode, TakesAwayWhatItMadeAndNothingElse) {
  List overrides{"machine.name=a", "axes.x.limits.torque_Nm=1"};
  const List own = overrides;
  const RecordingMode mode{{"x={a: 1}", "y={a: 2}"}, {"y={b: 3}"}};
  for (const std::string& o : RecordingOverrides(mode)) overrides.push_back(o);
  overrides.push_back("axes.x.model.extensions={}");  // learnt
  List left = own;
  left.push_back(overrides.back());
  EXPECT_EQ(WithoutRecordingMode(mode, overrides), left);
}

// Else the check of a machine that changes or goes back would be of another one.
TEST(WithoutRecordingMode, LeavesTheOperatorsOwn) {
  const List own{"axes.x.drive.mode=csp", "axes.y.drive.mode=csp", "control.friction=linear",
                 "axes.x.loop=x.yaml"};
  EXPECT_EQ(WithoutRecordingMode({}, own), own);
  for (const RecordingMode& mode :
       {RecordingMode{{}, {}, {"x", "y"}}, RecordingMode{{"x={a: 1}", "y={a: 2}"}, {}}}) {
    List overrides = own;
    for (const std::string& o : RecordingOverrides(mode)) overrides.push_back(o);
    EXPECT_EQ(WithoutRecordingMode(mode, overrides), own);
  }
}

}  // namespace
}  // namespace contour
