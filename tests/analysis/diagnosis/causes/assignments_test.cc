#include "analysis/diagnosis/causes/assignments.h"

#include <gtest/gtest.h>

#include "config/yaml_tree.h"

namespace contour::diagnosis {
namespace {

TEST(Assignments, AreWhatSetTakes) {
  YamlValue tree = ParseYamlText("lag_ms: 1\n", "test");
  ApplyOverride(tree, SetKey("lag_ms", 0.1));
  ApplyOverride(tree, SetEffect("some", {{"number", 1.0 / 3.0},
                                         {"axis", "y"},
                                         {"table", std::vector<double>{-1.5, 2.0}},
                                         {"further", std::vector<std::string>{MapText({{"a", 1.0}})}}}));
  EXPECT_EQ(tree.Find("lag_ms")->value.text, "0.1");
  ASSERT_NE(tree.Find("effects"), nullptr);
  const YamlValue& some = tree.Find("effects")->value.Find("some")->value;
  EXPECT_EQ(std::stod(some.Find("number")->value.text), 1.0 / 3.0) << "to the last bit";
  EXPECT_EQ(some.Find("axis")->value.text, "y");
  ASSERT_EQ(some.Find("table")->value.items.size(), 2u);
  EXPECT_EQ(some.Find("table")->value.items[0].text, "-1.5");
  ASSERT_EQ(some.Find("further")->value.items.size(), 1u);
  EXPECT_EQ(some.Find("further")->value.items[0].Find("a")->value.text, "1");
}

TEST(Assignments, ListsMayBeEmpty) {
  EXPECT_EQ(SetEffect("some", {{"further", std::vector<std::string>{}}}), "effects.some={further: []}");
}

}  // namespace
}  // namespace contour::diagnosis
