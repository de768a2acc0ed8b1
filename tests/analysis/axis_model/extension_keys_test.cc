#include "analysis/axis_model/extension_keys.h"

#include <gtest/gtest.h>

namespace contour::diagnosis {
namespace {

TEST(ExtensionKeys, ToTheFileAndBack) {
  const std::string ours =
      "cogging:\n  amplitude_Nm: 1\ncable_spring:\n  position_mm: [0]\n  torque_Nm: [2]\n";
  EXPECT_EQ(RenamedToFile(ExtensionUnits::kOfScrew, ours), ours);
  const std::string linear = RenamedToFile(ExtensionUnits::kOfLinearAxis, ours);
  EXPECT_NE(linear.find("amplitude_N: 1"), std::string::npos);
  EXPECT_NE(linear.find("  force_N: [2]"), std::string::npos);
  YamlValue tree = ParseYamlText(linear, "x");
  RenameFromFile(ExtensionUnits::kOfLinearAxis, tree);
  EXPECT_NE(tree.Find("cogging")->value.Find("amplitude_Nm"), nullptr);
  EXPECT_NE(tree.Find("cable_spring")->value.Find("torque_Nm"), nullptr);
}

TEST(ExtensionKeys, WordsThatOnlyBeginAlikeStay) {
  const std::string text = "constant_torque_Nm: 1\ntorque_Nm_x: 2\n";
  EXPECT_EQ(RenamedToFile(ExtensionUnits::kOfLinearAxis, text), text);
}

}  // namespace
}  // namespace contour::diagnosis
