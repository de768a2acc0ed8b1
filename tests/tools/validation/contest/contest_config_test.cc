#include "tools/validation/contest/contest_config.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "config/config_error.h"
#include "tools/validation/contest/contest_plan.h"

namespace contour {
namespace {

const std::string kContest = std::string(CONFIG_DIR) + "/contest.yaml";
const std::string kMachine = std::string(CONFIG_DIR) + "/xy_emulated.yaml";

std::string Replaced(const std::string& from, const std::string& to) {
  std::ifstream in(kContest);
  std::stringstream text;
  text << in.rdbuf();
  std::string all = text.str();
  const std::size_t at = all.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  all.replace(at, from.size(), to);
  const auto file =
      std::filesystem::temp_directory_path() /
      ("contest_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + ".yaml");
  std::ofstream(file) << all;
  return file.string();
}

TEST(ContestFile, EveryMachineOfTheContestIsAMachine) {
  const ContestConfig config = LoadContest(kContest);
  const std::vector<ContestCell> cells = PlanCells(config, DefaultChoice(config, false), kMachine, {});
  EXPECT_EQ(cells.size(), config.controllers.size() * config.programs.size() * config.machines.size() *
                              config.seeds.size());
  EXPECT_EQ(cells[1].controller, ControllerName::kCsp) << "controllers innermost";
  for (const ContestCell& c : cells) {
    if (c.machine_name != "encoder_10000") continue;
    EXPECT_EQ(c.machine->machine.axes.at("y").drive.encoder_counts_per_rev, 10000);
    break;
  }
}

TEST(ContestFile, EachControllerEntersInItsOwnWay) {
  const ContestConfig config = LoadContest(kContest);
  ContestChoice choice = DefaultChoice(config, false);
  choice.machines = {"nominal", "encoder_10000"};
  choice.controllers = {"csp", "full"};
  std::uint64_t csp = 0, full = 0;
  for (const ContestCell& c : PlanCells(config, choice, kMachine, {})) {
    const DriveMode mode = c.machine->machine.axes.at("x").drive.mode;
    const bool enters = c.controller == ControllerName::kFull && c.machine_name == "nominal";
    EXPECT_EQ(mode, enters ? DriveMode::kCsp : DriveMode::kCst);
    (c.controller == ControllerName::kFull ? full : csp) = c.source;
  }
  EXPECT_NE(csp, full) << "results of different machine files are kept apart";
}

TEST(ContestFile, MachinesDifferInWhatTheyAreNotInWhatIsBelieved) {
  const ContestConfig config = LoadContest(kContest);
  ContestChoice choice = DefaultChoice(config, false);
  choice.machines = {"nominal", "inertia_plus_30", "stiffness_20"};
  const std::vector<ContestCell> cells = PlanCells(config, choice, kMachine, {});
  for (const ContestCell& c : cells)
    EXPECT_EQ(c.machine->machine.axes.at("x").model.mechanics.table_mass_kg,
              cells.front().machine->machine.axes.at("x").model.mechanics.table_mass_kg);
}

TEST(ContestFile, AMistakeIsNamed) {
  const auto message = [](const std::string& file) -> std::string {
    try {
      LoadContest(file);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(message(Replaced("controllers: [pid,", "controllers: [bang_bang,")).find("bang_bang"),
            std::string::npos);
  EXPECT_NE(message(Replaced("shape: diamond", "shape: diamnod")).find("diamnod"), std::string::npos);
  EXPECT_NE(message(Replaced("  seeds: [101]", "  seeds: [2]")).find("scored by the contest"),
            std::string::npos);
}

TEST(ContestFile, UnknownNamesAreRefused) {
  const ContestConfig config = LoadContest(kContest);
  ContestChoice choice = DefaultChoice(config, true);
  CheckChoice(config, choice);
  choice.programs = {"spiral"};
  EXPECT_THROW(CheckChoice(config, choice), ConfigError);
}

}  // namespace
}  // namespace contour
