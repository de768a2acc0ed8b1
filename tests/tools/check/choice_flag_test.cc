#include "tools/contour/choice_flag.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

namespace contour {
namespace {

std::optional<bool> Chosen(const std::string& arguments) {
  CLI::App app;
  std::optional<bool> choice;
  AddChoice(app, "--this,!--no-this", choice, "");
  app.parse(arguments);
  return choice;
}

// Whoever says nothing leaves it to the machine file.
TEST(ChoiceFlag, IsNothingUnlessGiven) {
  EXPECT_EQ(Chosen(""), std::nullopt);
  EXPECT_EQ(Chosen("--this"), true);
  EXPECT_EQ(Chosen("--no-this"), false);
}

}  // namespace
}  // namespace contour
