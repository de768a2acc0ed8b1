// `contour check` as its users meet it: exit status and messages of the real program.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>
#include <utility>

#include "tests/config/test_files.h"

namespace contour {
namespace {

struct Outcome {
  int status = -1;
  std::string out;
  std::string errors;
};

Outcome Check(const std::string& arguments) {
  const std::string errors = WriteTestFile("stderr.txt", "");
  std::FILE* pipe =
      popen((std::string(CONTOUR_PROGRAM) + " check " + arguments + " 2>" + errors).c_str(), "r");
  Outcome outcome;
  std::array<char, 4096> block{};
  for (std::size_t n = 0; (n = std::fread(block.data(), 1, block.size(), pipe)) > 0;)
    outcome.out.append(block.data(), n);
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  outcome.errors = ReadText(errors);
  return outcome;
}

std::string LineOf(const std::string& text, const std::string& what) {
  const std::string before = text.substr(0, text.find(what));
  return std::to_string(std::count(before.begin(), before.end(), '\n') + 1);
}

// Writes the example with `from` replaced by `to`, checks it, and expects one message that begins with file,
// line of `to` and `message`.
void ExpectRefused(const std::string& from, const std::string& to, const std::string& at,
                   const std::string& message) {
  const std::string text = Replaced(ReadText(ExampleMachine("xy_emulated.yaml")), from, to);
  const std::string path = WriteTestFile("m.yaml", text);
  const Outcome o = Check(path);
  EXPECT_EQ(o.status, 2);
  EXPECT_EQ(o.out, "");
  EXPECT_EQ(o.errors, path + ":" + LineOf(text, at) + ": " + message + "\n");
}

TEST(CheckCommand, ExamplesAreSound) {
  for (const char* name : {"xy_emulated.yaml", "xy_vcan.yaml", "single_axis.yaml"}) {
    const Outcome o = Check(ExampleMachine(name));
    EXPECT_EQ(o.status, 0) << o.errors;
    for (const char* part : {"Axes\n", "effective mass", "acceleration reserve", "operator stop",
                             "master silent", "Safe travel", "Bus main", "Timing\n"})
      EXPECT_NE(o.out.find(part), std::string::npos) << name << ": " << part;
  }
}

// Friction downwards is 41.5 N at rest and 40.5 N in motion, 33 and 32 mNm at the motor.
TEST(CheckCommand, SaysWhetherAStatedWeightFallsWithoutVoltage) {
  const auto printed = [](const std::string& torque_Nm) {
    const Outcome o =
        Check(ExampleMachine("xy_emulated.yaml") +
              " --set 'axes.x.model.extensions.constant_torque={torque_Nm: " + torque_Nm + "}'");
    EXPECT_EQ(o.status, 0) << o.errors;
    return o.out;
  };
  EXPECT_NE(
      printed("-0.02").find(" by friction alone against the 25 N that the model states besides friction"),
      std::string::npos);
  EXPECT_NE(printed("-0.0326").find("THE AXIS FALLS ONCE IT MOVES: the 41 N "), std::string::npos);
  const std::string falls = printed("-0.18");
  EXPECT_NE(falls.find("THE AXIS FALLS, from rest as well: the 226 N "), std::string::npos);
  EXPECT_NE(falls.find("weight, spring as stated"), std::string::npos);
  EXPECT_NE(falls.find("axes.x.limits.external_force_N: missing"), std::string::npos) << "advice";
}

// A path needs room for the machine to follow it; what it takes is said, and when there is not enough.
TEST(CheckCommand, SaysWhatIsLeftOfATolerance) {
  const std::string machine = ExampleMachine("xy_emulated.yaml");
  const Outcome fits =
      Check(machine + " --set machine.path_tolerance_mm=0.01 --set machine.path_following_mm=0.004");
  EXPECT_EQ(fits.status, 0) << fits.errors;
  EXPECT_NE(fits.out.find("0.006 mm for the smooth path, 0.004 mm for the machine"), std::string::npos)
      << fits.out;
  EXPECT_EQ(fits.out.find("programs may be off by"), std::string::npos) << fits.out;

  const Outcome does_not =
      Check(machine + " --set machine.path_tolerance_mm=0.01 --set machine.path_following_mm=0.012");
  EXPECT_EQ(does_not.status, 0) << does_not.errors;
  EXPECT_NE(does_not.out.find("0.005 mm for the smooth path, 0.005 mm for the machine"), std::string::npos);
  EXPECT_NE(does_not.out.find("programs may be off by 0.017 mm"), std::string::npos) << does_not.out;

  const Outcome unstated = Check(machine);
  EXPECT_NE(unstated.out.find("expected of loops and screws: "), std::string::npos) << unstated.out;
}

// A controller without a loop whose margins could be judged is tried in virtual time: on a heavy gantry these
// are lost when they are enabled. Loops with margins and drives with loops of their own are not tried.
TEST(CheckCommand, RefusesAControllerThatIsLostOnTheMachine) {
  const std::string heavy = ExampleMachine("family/slow40.yaml");
  for (const auto& [set, key] :
       {std::pair{"machine.controller=mpc_observer", "machine.controller: found mpc_observer"},
        std::pair{"control.friction=srukf", "control.friction: found srukf"}}) {
    const Outcome lost = Check(heavy + " --set " + set);
    EXPECT_EQ(lost.status, 2) << set;
    EXPECT_NE(lost.errors.find(key), std::string::npos) << lost.errors;
    EXPECT_NE(lost.errors.find("lost when it is enabled: axis x left the reference"), std::string::npos)
        << lost.errors;
    const Outcome in_csp = Check(
        heavy + " --set control.friction=srukf --set axes.x.drive.mode=csp --set axes.y.drive.mode=csp");
    EXPECT_EQ(in_csp.status, 0) << in_csp.errors;
  }
  EXPECT_EQ(Check(heavy).status, 0);
  for (const char* set : {"machine.controller=pid", "control.friction=srukf"}) {
    const Outcome held = Check(ExampleMachine("family/base.yaml") + " --set " + set);
    EXPECT_EQ(held.status, 0) << set << ": " << held.errors;
  }
}

// Limits need not lie about zero (the emulated axis met its bumpers), and a slow axis would take longer for a
// stroke of 10 mm than the trial lasts (the next one began while it moved).
TEST(CheckCommand, TriesAControllerWhereverAxesStandAndHoweverSlowTheyAre) {
  for (const char* set : {"axes.x.limits.position_mm=[100,400]", "axes.x.limits.position_mm=[-1000,-600]",
                          "axes.x.limits.velocity_mm_s=0.2"}) {
    const Outcome held =
        Check(ExampleMachine("family/base.yaml") + " --set machine.controller=pid --set " + set);
    EXPECT_EQ(held.status, 0) << set << ": " << held.errors;
  }
}

// Softened, but held: no reason to refuse it. All axes are softened together; named is the one that swings.
TEST(CheckCommand, WarnsOfAControllerWhoseLoopsAreSoftened) {
  const std::string pid = ExampleMachine("family/base.yaml") + " --set machine.controller=pid ";
  const Outcome held = Check(pid + "--set axes.x.drive.delay_cycles=2");
  EXPECT_EQ(held.status, 0);
  EXPECT_NE(held.errors.find("warning: machine.controller: found pid, which swings"), std::string::npos)
      << held.errors;
  EXPECT_NE(held.errors.find("of axis x)"), std::string::npos) << held.errors;
}

// What the controller leads is there; it was refused for a swing of its own making.
TEST(CheckCommand, TriesAControllerOnAMachineThatCogsAsStated) {
  const Outcome held =
      Check(ExampleMachine("family/base.yaml") +
            " --set control.friction=srukf --set 'axes.x.model.extensions={cogging: {amplitude_Nm: 0.05, "
            "order_per_rev: 6, phase_rad: 0}}'");
  EXPECT_EQ(held.status, 0) << held.errors;
}

// Ten ways to get a machine file wrong.

TEST(WrongConfiguration, UnknownKey) {
  ExpectRefused("lag_ms: 0.2", "lagg_ms: 0.2", "lagg_ms",
                "axes.x.drive.lagg_ms: unknown key; did you mean lag_ms?");
}

TEST(WrongConfiguration, MissingKey) {
  ExpectRefused(
      "      lead_mm: 5\n", "", "    model:\n",
      "axes.x.model.lead_mm: missing, expected a number from 0.1 to 200: travel of the table per motor turn");
}

TEST(WrongConfiguration, WrongType) {
  ExpectRefused("velocity_mm_s: 250", "velocity_mm_s: fast", "velocity_mm_s: fast",
                "axes.x.limits.velocity_mm_s: found 'fast', expected a number above 0");
}

TEST(WrongConfiguration, ZeroRatedTorque) {
  ExpectRefused("rated_torque_Nm: 0.637", "rated_torque_Nm: 0", "rated_torque_Nm: 0 ",
                "axes.x.drive.rated_torque_Nm: found '0', expected a number above 0");
}

TEST(WrongConfiguration, ImpossibleLimit) {
  ExpectRefused("acceleration_mm_s2: 5000", "acceleration_mm_s2: 50000", "acceleration_mm_s2: 50000",
                "axes.x.limits.acceleration_mm_s2: impossible limit: found 50000, which takes 3.463 Nm at "
                "250 mm/s against "
                "friction; the torque limit of 1.5 Nm leaves 20641 mm/s^2");
}

TEST(WrongConfiguration, DuplicateNode) {
  ExpectRefused("node_id: 2", "node_id: 1 # y", "node_id: 1 # y",
                "axes.y.drive.node_id: duplicate node: found 1, already the node of axis 'x' on bus 'main'");
}

TEST(WrongConfiguration, BusOverload) {
  const std::string text = Replaced(ReadText(ExampleMachine("xy_emulated.yaml")), "bitrate_bit_s: 1000000",
                                    "bitrate_bit_s: 500000");
  const std::string path = WriteTestFile("m.yaml", text);
  const Outcome o = Check(path);
  EXPECT_EQ(o.status, 2);
  EXPECT_EQ(o.errors.substr(0, o.errors.find("bus overload")),
            path + ":" + LineOf(text, "  main:\n") + ": buses.main: ")
      << o.errors;
  EXPECT_EQ(std::count(o.errors.begin(), o.errors.end(), '\n'), 1);
}

TEST(WrongConfiguration, NoSuchInterface) {
  const std::string path = WriteTestFile("m.yaml", Replaced(ReadText(ExampleMachine("xy_emulated.yaml")),
                                                            "interface: loopback", "interface: nosuch0"));
  const Outcome o = Check(path);
  EXPECT_EQ(o.status, 3);
  EXPECT_EQ(o.errors,
            "contour: buses.main.interface: found 'nosuch0', but this computer has no such interface; `ip "
            "link show type "
            "can` lists what there is\n");
}

TEST(WrongConfiguration, InterfaceOfAnotherKind) {
  const std::string path = WriteTestFile("m.yaml", Replaced(ReadText(ExampleMachine("xy_emulated.yaml")),
                                                            "interface: loopback", "interface: lo"));
  const Outcome o = Check(path);
  EXPECT_EQ(o.status, 3);
  EXPECT_EQ(o.errors, "contour: buses.main.interface: found 'lo', which is not a CAN interface\n");
}

TEST(WrongConfiguration, UnreadableFile) {
  const Outcome missing = Check("/nonexistent/machine.yaml");
  EXPECT_EQ(missing.status, 2);
  EXPECT_EQ(missing.errors, "/nonexistent/machine.yaml: cannot be read: No such file or directory\n");
  const Outcome directory = Check(SOURCE_DIR);
  EXPECT_EQ(directory.status, 2);
  EXPECT_EQ(directory.errors, std::string(SOURCE_DIR) + ": cannot be read: Is a directory\n");
}

TEST(WrongConfiguration, NotYaml) {
  const std::string path = WriteTestFile("m.yaml", "machine: {name: a\naxes: [\n");
  const Outcome o = Check(path);
  EXPECT_EQ(o.status, 2);
  EXPECT_EQ(o.errors.substr(0, path.size() + 12), path + ":2: not YAML") << o.errors;
}

// And some more.

TEST(WrongConfiguration, WrongUnit) {
  ExpectRefused("lead_mm: 5", "lead_m: 0.005", "lead_m: 0.005",
                "axes.x.model.lead_m: unknown key, wrong unit: expected lead_mm, in mm");
}

TEST(WrongConfiguration, EmulatorSectionIsCheckedToo) {
  ExpectRefused("law: lugre", "law: coulomb", "law: coulomb",
                "emulator.axes.x.friction.law: found 'coulomb', expected one of lugre or maxwell_slip");
}

TEST(WrongConfiguration, OverrideIsNamed) {
  const Outcome o = Check(ExampleMachine("single_axis.yaml") + " --set axes.x.drive.node_id=200");
  EXPECT_EQ(o.status, 2);
  EXPECT_EQ(o.errors,
            "--set axes.x.drive.node_id=200: axes.x.drive.node_id: found '200', expected a whole number from "
            "1 to 127\n");
}

TEST(CheckCommand, OverridesApply) {
  const Outcome o =
      Check(ExampleMachine("single_axis.yaml") +
            " --set machine.name=other --set machine.cycle_us=2000 --set axes.x.limits.safe_travel_mm=5"
            " --set control.friction=srukf");  // the file's loop is for its own cycle
  EXPECT_EQ(o.status, 0) << o.errors;
  EXPECT_EQ(o.out.substr(0, 30), "Machine other: cycle 2000 us, ");
}

TEST(CheckCommand, DescribeNeedsNoFile) {
  const Outcome o = Check("--describe");
  EXPECT_EQ(o.status, 0);
  for (const char* key : {"machine.cycle_us", "axes.<name>.drive.node_id",
                          "axes.<name>.model.friction.Fc_plus_Nm", "emulator.axes.<name>.friction.law"})
    EXPECT_NE(o.out.find(key), std::string::npos) << key;
}

TEST(CheckCommand, BadUsage) {
  EXPECT_EQ(Check("").status, 2);
  EXPECT_EQ(Check("--colour").status, 2);
  EXPECT_EQ(Check("--help").status, 0);
  EXPECT_EQ(Check("--version").status, 0);
  EXPECT_EQ(Check("--version").out.substr(0, 8), "contour ");
}

}  // namespace
}  // namespace contour
