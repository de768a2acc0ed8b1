#include "daemon/torque_mode.h"

#include <gtest/gtest.h>

#include "config/config_error.h"

namespace contour {
namespace {

using List = std::vector<std::string>;

TEST(TorqueModeOverrides, PutsEveryAxisIntoTorqueModeWithItsLoop) {
  EXPECT_EQ(TorqueModeOverrides({{"x={a: 1}", "y={a: 2}"}, {"y={b: 3}"}}),
            (List{"axes.x.drive.mode=cst", "axes.x.loop={a: 1}", "axes.y.drive.mode=cst",
                  "axes.y.loop={a: 2}", "axes.y.model={b: 3}", "control.friction=linear"}));
  EXPECT_EQ(TorqueModeOverrides({{}, {"y={b: 3}"}}), List{}) << "the machine file's own mode";
}

TEST(TorqueModeOverrides, RefusesWhatIsNotAnAxisAndItsLoop) {
  for (const char* wrong : {"x", "={a: 1}", "x="})
    EXPECT_THROW(TorqueModeOverrides({{wrong}, {}}), ConfigError) << wrong;
}

TEST(WithoutTorqueMode, TakesAwayModeAndLoopsAndNothingElse) {
  List overrides{"machine.name=a", "axes.x.limits.torque_Nm=1"};
  const List own = overrides;
  for (const std::string& o : TorqueModeOverrides({{"x={a: 1}", "y={a: 2}"}, {}})) overrides.push_back(o);
  EXPECT_EQ(WithoutTorqueMode({"x", "y"}, overrides), own);
}

}  // namespace
}  // namespace contour
