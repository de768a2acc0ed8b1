// `contour tune --from-model` and what `contour check` says of loops, as their users meet them.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/config/test_files.h"

namespace contour {
namespace {

struct Outcome {
  int status = -1;
  std::string out;
};

/// Output and errors together.
Outcome Contour(const std::string& arguments) {
  std::FILE* pipe = popen((std::string(CONTOUR_PROGRAM) + " " + arguments + " 2>&1").c_str(), "r");
  Outcome outcome;
  std::array<char, 4096> block{};
  for (std::size_t n = 0; (n = std::fread(block.data(), 1, block.size(), pipe)) > 0;)
    outcome.out.append(block.data(), n);
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

void ExpectHas(const Outcome& o, const std::string& part) {
  EXPECT_NE(o.out.find(part), std::string::npos) << part << " in\n" << o.out;
}

TEST(TuneFromModel, WritesALoopThatCheckAccepts) {
  const std::string machine = WriteTestFile("one.yaml", ReadText(ExampleMachine("single_axis.yaml")));
  const std::string tuned = machine + ".tuned.yaml";
  const Outcome tune = Contour("tune --from-model " + machine + " --evaluations 100 --out " + tuned);
  ASSERT_EQ(tune.status, 0) << tune.out;
  for (const char* part : {"gain margin", "phase margin", "modulus margin", "bandwidth",
                           "binding: ", "expected error", "regulator_Hz: "})
    ExpectHas(tune, part);
  const Outcome check = Contour("check " + tuned);
  EXPECT_EQ(check.status, 0) << check.out;
  ExpectHas(check, "Loops in torque mode\n");
  ExpectHas(check, "binding: ");
  // As if an operator had made it faster by hand.
  const std::string faster = "check " + tuned + " --set axes.x.loop.regulator_Hz=90";
  const Outcome unused = Contour(faster + " --set control.friction=srukf");
  EXPECT_EQ(unused.status, 0) << unused.out;
  ExpectHas(unused, "NOT within its limits (unstable: ");
  const Outcome fast = Contour(faster);
  EXPECT_EQ(fast.status, 2) << fast.out;
  ExpectHas(fast, "axes.x.loop: found a loop that does not keep its limits (unstable: ");
  ExpectHas(fast, "another tuning: contour tune --from-model finds one");
}

/// Into a folder of its own: tests run side by side.
std::string SimulateCommand(const std::string& program) {
  return "simulate --config " + ExampleMachine("single_axis.yaml") + " --program " + program + " --out " +
         program + ".out";
}

TEST(Simulate, RefusesALoopThatIsUnstableAndWarnsOfOneThatBreaksALimit) {
  const std::string program = WriteTestFile("hold.yaml", "shape: hold\nseconds: 0.2\n");
  const std::string simulate = SimulateCommand(program) + " --set axes.x.loop.regulator_Hz=";
  const Outcome unstable = Contour(simulate + "150");
  EXPECT_EQ(unstable.status, 2) << unstable.out;
  ExpectHas(unstable, ": axes.x.loop: found a loop that does not keep its limits (unstable: ");
  const Outcome rival = Contour(simulate + "150 --controller pid");
  EXPECT_EQ(rival.status, 0) << rival.out;
  const Outcome experiment = Contour(simulate + "35");
  EXPECT_EQ(experiment.status, 0) << experiment.out;
  ExpectHas(experiment, "warning: axes.x.loop: found a loop that does not keep its limits (peak ");
}

// 0.2 s at a billionth of a percent would end in 600 years.
TEST(Simulate, RefusesAFeedAtWhichTheProgramHardlyEnds) {
  const std::string program = WriteTestFile("hold.yaml", "shape: hold\nseconds: 0.2\n");
  const Outcome o = Contour(SimulateCommand(program) + " --controller pid --feed 1e-9");
  EXPECT_EQ(o.status, 2) << o.out;
  ExpectHas(o, "at 1e-09 percent of its feed the program would take more than three years");
  const Outcome slow = Contour(SimulateCommand(program) + " --controller pid --feed 1e-9@0.1 --feed 100@0.2");
  EXPECT_EQ(slow.status, 0) << slow.out;
}

// No loop is looked for where none is used.
TEST(Simulate, NeedsNoLoopForARivalThatHasNone) {
  const std::string program = WriteTestFile("hold.yaml", "shape: hold\nseconds: 0.2\n");
  const std::string belt = "simulate --config " + ExampleMachine("family/belt.yaml") + " --program " +
                           program + " --out " + program +
                           ".out --set machine.controller=full --set control.friction=linear" +
                           " --set axes.x.drive.mode=cst";
  const Outcome full = Contour(belt);
  EXPECT_EQ(full.status, 2) << full.out;
  ExpectHas(full, "axes.x.loop: missing, and none of the loops");
  const Outcome rival = Contour(belt + " --controller pid");
  // It may swing on a belt; but nobody asks for a loop.
  EXPECT_NE(rival.status, 2) << rival.out;
  EXPECT_EQ(rival.out.find("loop"), rival.out.find("loop oscillates")) << rival.out;
}

// Each column of cycles.csv, without the axis's name before it.
TEST(Simulate, WritesNoColumnThatTheManualDoesNotName) {
  const std::string program = WriteTestFile("hold.yaml", "shape: hold\nseconds: 0.2\n");
  const Outcome o = Contour(SimulateCommand(program) + " --controller pid");
  ASSERT_EQ(o.status, 0) << o.out;
  std::ifstream cycles(program + ".out/cycles.csv");
  std::string header, column;
  ASSERT_TRUE(std::getline(cycles, header));
  const std::string manual = ReadText(std::string(SOURCE_DIR) + "/docs/telemetry.md");
  std::istringstream columns(header);
  int found = 0;
  for (; std::getline(columns, column, ','); ++found) {
    const std::string name = column.starts_with("x_") ? column.substr(2) : column;
    EXPECT_NE(manual.find('`' + name + '`'), std::string::npos) << column;
  }
  EXPECT_GT(found, 40);
}

TEST(Simulate, TakesAnEmptyFileForTheProgramThatItIs) {
  const Outcome o = Contour(SimulateCommand(WriteTestFile("empty.ngc", "")));
  EXPECT_EQ(o.status, 2) << o.out;
  ExpectHas(o, "empty.ngc: the program does not move");
}

// Before, after the search for every axis.
TEST(TuneFromModel, TellsOfAnAxisWithoutALoopBeforeItSearchesTheOthers) {
  std::string text = ReadText(ExampleMachine("family/belt.yaml"));
  // The model of x, which comes first, is no belt's.
  for (const std::string key : {"screw_stiffness_N_um: 30", "motor_inertia_kgm2: 1.8e-4"}) {
    const std::size_t at = text.find(key.substr(0, key.find(' ') + 1));
    text.replace(at, text.find('\n', at) - at, key);
  }
  const std::string machine = WriteTestFile("soft_y.yaml", text);
  const Outcome tune =
      Contour("tune --from-model " + machine + " --evaluations 20 --out " + machine + ".tuned.yaml");
  EXPECT_EQ(tune.status, 1) << tune.out;
  ExpectHas(tune, "nothing was written: axis y has no loop that keeps its limits");
  EXPECT_EQ(tune.out.find("axis x: "), std::string::npos) << tune.out;
}

// Wherever the table stands, an incremental encoder calls that 0.
TEST(Simulate, TellsTheTableFromWhereAnIncrementalEncoderBeganToCount) {
  const std::string program =
      WriteTestFile("small.yaml", "shape: circle\nradius_mm: 2\nfeed_mm_min: 600\nturns: 2\n");
  std::string simulate = "simulate --config " + ExampleMachine("xy_emulated.yaml") + " --program " + program +
                         " --out " + program + ".out --set emulator.axes.x.start_position_mm=1.5";
  for (const std::string axis : {"x", "y"}) {
    simulate += " --set emulator.axes." + axis + ".incremental_encoder=true --set axes." + axis +
                ".drive.absolute_encoder=false --set axes." + axis + ".limits.unreferenced_travel_mm=20";
  }
  const Outcome o = Contour(simulate);
  ASSERT_EQ(o.status, 0) << o.out;
  const std::size_t table = o.out.find("(table ");
  ASSERT_NE(table, std::string::npos) << o.out;
  EXPECT_LT(std::stod(o.out.substr(table + 7)), 20.0) << o.out;
}

TEST(Contour, NamesWhatIsNoCommandAndRefusesASeedBelowZero) {
  const Outcome home = Contour("home --axis x");
  EXPECT_EQ(home.status, 2);
  ExpectHas(home, "'home' is no command; contour --help lists them");
  const std::string program = WriteTestFile("seeded.yaml", "shape: hold\nseconds: 0.2\n");
  const Outcome seed = Contour(SimulateCommand(program) + " --seed -1");
  EXPECT_EQ(seed.status, 2) << seed.out;
  ExpectHas(seed, "--seed");
  EXPECT_EQ(Contour("emulate --seed -1").status, 2);
}

TEST(TuneFromModel, RefusesABeltAndSaysWhatWouldHelp) {
  const std::string machine = WriteTestFile("belt.yaml", ReadText(ExampleMachine("family/belt.yaml")));
  const std::string tuned = machine + ".tuned.yaml";
  const Outcome o = Contour("tune --from-model " + machine + " --axis x --evaluations 60 --out " + tuned);
  EXPECT_EQ(o.status, 1) << o.out;
  ExpectHas(o, "NO stable loop in torque mode");
  ExpectHas(o, "on the Stribeck slope at ");
  ExpectHas(o, "; and of those whose table may stick and slip where it creeps, ");
  ExpectHas(o, "what would help: drive.mode: csp");
  ExpectHas(o, "nothing was written");
  EXPECT_FALSE(std::filesystem::exists(tuned));
}

TEST(TuneFromModel, NamesAnAxisThatThereIsNot) {
  const Outcome o = Contour("tune --from-model " + ExampleMachine("single_axis.yaml") + " --axis q");
  EXPECT_EQ(o.status, 2);
  ExpectHas(o, "axes.q: missing");
}

TEST(TuneFromModel, IsNotMeantByTuneWithoutOut) {
  const Outcome o = Contour("tune");
  EXPECT_EQ(o.status, 2);
  ExpectHas(o, "--out: missing");
}

std::string LineWith(const std::string& text, const std::string& what) {
  const std::size_t at = text.find(what);
  return at == std::string::npos ? "" : text.substr(at, text.find('\n', at) - at);
}

/// The example without its `loop:`.
std::string WithoutLoop(const std::string& name) {
  std::string text = ReadText(ExampleMachine("single_axis.yaml"));
  const std::size_t at = text.find("    loop:\n");
  text.erase(at, text.find("\n\n", at) - at);
  return WriteTestFile(name, text);
}

// How stiff `full` would be with another law of friction says nothing of the loop that is chosen.
TEST(CheckLoops, BoundsAreThoseOfTheLoopThatIsChosen) {
  const std::string check = "check " + WithoutLoop("none.yaml");
  const Outcome o = Contour(check);
  ASSERT_EQ(o.status, 0) << o.out;
  ExpectHas(o, "no loop: in the file, so this one is chosen at start");
  const std::string frozen = LineWith(o.out, "encoder frozen");
  EXPECT_NE(frozen, "");
  const Outcome other =
      Contour(check + " --set control.full.contour_bandwidth_Hz=60 --set control.full.lag_bandwidth_Hz=45");
  EXPECT_EQ(LineWith(other.out, "encoder frozen"), frozen);
}

// The limit is wide enough as long as nobody knows the loop, which a table of three times the mass makes
// slow.
TEST(TuneFromModel, SaysSoWhereTheFileIsRefusedWithItsLoop) {
  const std::string machine = WithoutLoop("narrow.yaml");
  std::string text = ReadText(machine);
  for (const auto& [from, to] :
       {std::pair{"table_mass_kg: 10.6", "table_mass_kg: 31.5"},
        {"velocity_mm_s: 250", "velocity_mm_s: 100"},
        {"acceleration_mm_s2: 5000", "acceleration_mm_s2: 2000"},
        {"quick_stop_deceleration_rad_s2: 22600", "quick_stop_deceleration_rad_s2: 16000"},
        {"safe_travel_mm: 2", "safe_travel_mm: 1.5"}})
    text = Replaced(text, from, to);
  const std::string tuned = machine + ".tuned.yaml";
  const Outcome o = Contour("tune --from-model " + WriteTestFile("narrow.yaml", text) +
                            " --evaluations 100 --out " + tuned);
  ASSERT_EQ(o.status, 0) << o.out;
  ExpectHas(o, "warning: with what was found contourd refuses the machine file until this is put right:\n");
  ExpectHas(o, "axes.x.limits.safe_travel_mm: found 1.5, but with the fault 'encoder frozen'");
  EXPECT_EQ(Contour("check " + tuned).status, 2);
}

// Nothing enables itself: who is refused is told, and not after a minute of the machine's time.
TEST(Simulate, SaysWhyAnAxisThatFallsIsNotEnabled) {
  const std::string program = WriteTestFile("hold.yaml", "shape: hold\nseconds: 1\n");
  const Outcome o = Contour(SimulateCommand(program) +
                            " --controller pid --set emulator.axes.x.effects.constant_torque.torque_Nm=0.3");
  EXPECT_EQ(o.status, 1) << o.out;
  ExpectHas(o, "enabling: the machine is Idle in cycle ");
  ExpectHas(o, ": axis x is not at rest; it was not enabled");
}

}  // namespace
}  // namespace contour
