#include "config/screw_advice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "config/config_error.h"
#include "config/load_machine.h"
#include "tests/config/test_files.h"

namespace contour {
namespace {

// A bar of 20 mm and 0.4 m of steel: 0.99 kg, 4.9e-5 kg m^2, and 4 E A / length.
TEST(StiffestScrew, IsTheBarThatHasThatInertia) {
  const StiffestScrew screw = StiffestScrewOf(7850.0 * 3.14159265 * 0.4 * std::pow(0.02, 4) / 32.0, 0.4);
  EXPECT_NEAR(screw.diameter_m, 0.02, 1e-7);
  EXPECT_NEAR(screw.stiffness_N_m, 4.0 * 2.1e11 * 3.14159265 * 1e-4 / 0.4, 1e3);
}

TEST(ScrewAdvice, HasNothingToSayOfTheExamples) {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(ExampleMachine(""))) {
    if (entry.path().extension() != ".yaml") continue;
    MachineConfig machine;
    try {
      machine = LoadMachine(entry.path().string());
    } catch (const ConfigError&) {
      continue;  // a program or a model
    }
    ++files;
    for (const std::string& line : ScrewAdvice(machine)) ADD_FAILURE() << entry.path() << ": " << line;
  }
  EXPECT_GT(files, 5u);
}

TEST(ScrewAdvice, KnowsAStiffnessInNewtonsPerMetre) {
  MachineConfig machine = LoadMachine(ExampleMachine("xy_emulated.yaml"));
  machine.axes.at("y").model.mechanics.screw_stiffness_N_um *= 1e6;
  const std::vector<std::string> lines = ScrewAdvice(machine);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(lines.front().starts_with("axes.y.model.screw_stiffness_N_um: found ")) << lines.front();
  EXPECT_NE(lines.front().find("mm thick: 4 E A / length). Is it in N/um"), std::string::npos);
}

}  // namespace
}  // namespace contour
