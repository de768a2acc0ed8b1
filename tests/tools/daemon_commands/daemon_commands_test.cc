// The subcommands that talk to a running daemon, as their users meet them: the real program against a control
// socket.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "daemon/control_socket/control_server.h"
#include "daemon/telemetry/log_writer.h"
#include "drivers/lcm/telemetry_encoder.h"
#include "tests/support/random_cycle_entry.h"
#include "tests/support/scratch_directory.h"
#include "tests/tools/daemon_commands/scripted_machine.h"

namespace contour {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kWindUp_m = 1e-6;  ///< the truth's table stands this far from the motor

std::string ReadAll(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class DaemonCommandsTest : public ::testing::Test {
 protected:
  struct Outcome {
    int status = -1;
    std::string out;
    std::string errors;
  };

  void SetUp() override {
    ControlServer::Options options;
    options.socket = directory_ / "control.sock";
    server_ = std::make_unique<ControlServer>(options, machine_);
    server_->Start();
    std::ofstream(directory_ / "circle.yaml") << "shape: circle\nradius_mm: 0.1\nfrequency_hz: 1\nturns: 3\n";
  }
  void TearDown() override { server_.reset(); }

  Outcome Contour(const std::string& arguments, const std::string& before = "") const {
    const fs::path errors = directory_ / "stderr.txt";
    const std::string command = before + CONTOUR_PROGRAM + " " + arguments + " 2>" + errors.string();
    std::FILE* pipe = ::popen(command.c_str(), "r");
    Outcome outcome;
    std::array<char, 4096> block{};
    for (std::size_t n = 0; (n = std::fread(block.data(), 1, block.size(), pipe)) > 0;)
      outcome.out.append(block.data(), n);
    const int status = ::pclose(pipe);
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    outcome.errors = ReadAll(errors);
    return outcome;
  }
  Outcome Ask(const std::string& arguments, const std::string& before = "") const {
    return Contour(arguments + " --socket " + (directory_ / "control.sock").string(), before);
  }

  test::ScratchDirectory scratch_;
  const fs::path directory_ = scratch_.path();
  test::ScriptedMachine machine_;
  std::unique_ptr<ControlServer> server_;
};

TEST_F(DaemonCommandsTest, RunSendsAProgramOfAnySize) {
  std::string program = "# \xC3\xA4\xE2\x82\xAC \xF0\x9F\x94\xA7\nsequence:\n";
  // Letters of two, three and four bytes come to lie on the ends of pieces.
  for (int i = 0; program.size() < 200'000; ++i)
    program +=
        "  # " + std::string(static_cast<std::size_t>(i % 7), 'x') + "\xC3\xA4\xE2\x82\xAC\xF0\x9F\x94\xA7\n";
  program += "  - {shape: hold, seconds: 0.01}\n";
  std::ofstream(directory_ / "long.yaml", std::ios::binary) << program;
  const Outcome run = Ask("run " + (directory_ / "long.yaml").string());
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(machine_.program(), program);
}

TEST_F(DaemonCommandsTest, AProgramThatIsNotInTheLogAsAWholeIsStatusOne) {
  std::ofstream(directory_ / "hold.yaml") << "{shape: hold, seconds: 0.2}\n";
  const std::string run = "run " + (directory_ / "hold.yaml").string();
  EXPECT_EQ(Ask(run).status, 0);
  machine_.FillLog();
  const Outcome o = Ask(run);
  EXPECT_EQ(o.status, 1);
  EXPECT_NE(o.out.find("log run.lcmlog, which LOST 2"), std::string::npos) << o.out;
  EXPECT_EQ(o.out.find("LOST 205"), std::string::npos) << "those from before are no loss of it: " << o.out;
  EXPECT_NE(o.out.find("File too large"), std::string::npos) << o.out;
  EXPECT_NE(o.errors.find("the program has ended, but it is not in the log as a whole"), std::string::npos)
      << o.errors;
}

TEST_F(DaemonCommandsTest, StatusForPeopleAndForPrograms) {
  const Outcome text = Ask("status");
  EXPECT_EQ(text.status, 0) << text.errors;
  EXPECT_NE(text.out.find("scripted: Idle"), std::string::npos) << text.out;
  const Outcome status = Ask("status --json");
  EXPECT_EQ(status.status, 0) << status.errors;
  EXPECT_EQ(json::parse(status.out)["state"], "Idle");
}

TEST_F(DaemonCommandsTest, RequestsEndWhereTheyLead) {
  const auto expect = [&](const char* command, const char* state) {
    const Outcome o = Ask(command);
    EXPECT_EQ(o.status, 0) << command << ": " << o.errors;
    EXPECT_EQ(o.out, std::string(state) + "\n") << command;
  };
  expect("enable", "Ready");
  expect("stop", "Ready");
  expect("disable", "Idle");
  expect("reset", "Idle");
  expect("pause", "paused");
  expect("feed 30", "done");
  EXPECT_NE(Ask("status").out.find("feed 30 %, paused"), std::string::npos) << Ask("status").out;
  expect("resume", "Running");
  expect("zero", "program zero is where the machine stands");
}

// contourd & contour enable, as the manual has it.
TEST_F(DaemonCommandsTest, WhatBeginsFromIdleWaitsForADaemonThatHasJustBeenStarted) {
  machine_.StartFor(5);
  const Outcome enable = Ask("enable");
  EXPECT_EQ(enable.status, 0) << enable.errors;
  EXPECT_EQ(enable.out, "Ready\n");
  EXPECT_EQ(enable.errors, "the machine is Starting; waiting for its drives to come up\n");
  EXPECT_EQ(Ask("enable").errors, "");
}

TEST_F(DaemonCommandsTest, ARefusalOrAFaultIsStatusOneWithItsReason) {
  machine_.Refuse("the enable chain is open");
  Outcome o = Ask("enable");
  EXPECT_EQ(o.status, 1);
  EXPECT_EQ(o.errors, "contour: enable refused: the enable chain is open\n");
  machine_.Refuse("");
  machine_.FailWith(Reason::kEmergencyStop, "the emergency-stop circuit is open");
  o = Ask("enable");
  EXPECT_EQ(o.status, 1);
  EXPECT_EQ(o.errors, "contour: Faulted: the emergency-stop circuit is open\n");
}

TEST_F(DaemonCommandsTest, WithoutADaemonIsStatusThree) {
  server_.reset();
  for (const char* command : {"status", "enable", "stop", "watch"}) {
    const Outcome o = Ask(command);
    EXPECT_EQ(o.status, 3) << command;
    EXPECT_NE(o.errors.find("no contourd listens there"), std::string::npos) << o.errors;
  }
}

TEST_F(DaemonCommandsTest, WatchPrintsALineNowAndAgain) {
  const Outcome o =
      Contour("watch --period 20 --socket " + (directory_ / "control.sock").string() + " | head -n 3");
  EXPECT_EQ(std::count(o.out.begin(), o.out.end(), '\n'), 3) << o.out << o.errors;
  EXPECT_EQ(o.out.find("Idle"), 0u) << o.out;
}

TEST_F(DaemonCommandsTest, RunUploadsWaitsAndScores) {
  const fs::path out = directory_ / "out";
  const Outcome o = Ask("run " + (directory_ / "circle.yaml").string() + " --out " + out.string());
  ASSERT_EQ(o.status, 0) << o.errors;
  const json metrics = json::parse(ReadAll(out / "metrics.json"));
  EXPECT_EQ(metrics["controller"], "mpc");
  EXPECT_EQ(metrics["cycle_us"], 1000);
  EXPECT_EQ(metrics["late_cycles"], 0);
  EXPECT_LT(metrics["contour"]["encoder"]["peak_um"].get<double>(), 1e-3);
  EXPECT_TRUE(metrics["contour"]["table"]["peak_um"].is_null()) << "nobody knows where the table was";
  const std::string table = ReadAll(out / "cycles.csv");
  const auto rows = static_cast<std::uint64_t>(std::count(table.begin(), table.end(), '\n')) - 1;
  EXPECT_EQ(rows, metrics["cycles"].get<std::uint64_t>());
  EXPECT_GT(rows, 3000u);
  EXPECT_FALSE(fs::exists(out / "rows.tmp"));
}

TEST_F(DaemonCommandsTest, RunJoinsATruthThatCountsSyncsFromItsOwnStart) {
  const fs::path file = directory_ / "truth.csv";
  std::ofstream truth(file);
  truth.precision(17);
  truth << "sync_number,time_s,free_running,x_table_position_m,x_friction_N,x_reported_position_rad,"
           "y_table_position_m,y_friction_N,y_reported_position_rad\n";
  machine_.TellTruth([&](std::uint64_t sync, const PerAxis<ReferencePoint>& axes) {
    truth << sync + 1234 << ",0,0";
    for (const ReferencePoint& axis : axes)
      truth << ',' << axis.position_m + kWindUp_m << ",3.5,"
            << axis.position_m / test::ScriptedMachine::kRadius_m_rad;
    truth << std::endl;
  });
  const fs::path out = directory_ / "out";
  const Outcome o = Ask("run " + (directory_ / "circle.yaml").string() + " --out " + out.string() +
                        " --truth " + file.string());
  machine_.TellTruth({});  // its thread is done with the stream
  ASSERT_EQ(o.status, 0) << o.errors;
  const json metrics = json::parse(ReadAll(out / "metrics.json"));
  EXPECT_LT(metrics["contour"]["encoder"]["peak_um"].get<double>(), 1e-3);
  EXPECT_NEAR(metrics["contour"]["table"]["peak_um"].get<double>(), 1e6 * kWindUp_m * 1.414, 0.01);
  EXPECT_NE(ReadAll(out / "cycles.csv").find(",y_friction_truth_N\n"), std::string::npos);
}

TEST_F(DaemonCommandsTest, RunRefusesATruthOfAnotherRun) {
  const fs::path file = directory_ / "truth.csv";
  std::ofstream(file)
      << "sync_number,time_s,free_running,x_table_position_m,x_friction_N,x_reported_position_rad,"
         "y_table_position_m,y_friction_N,y_reported_position_rad\n1,0,0,0,0,0,0,0,0\n";
  const Outcome o = Ask("run " + (directory_ / "circle.yaml").string() + " --out " +
                        (directory_ / "out").string() + " --truth " + file.string());
  EXPECT_EQ(o.status, 1);
  EXPECT_NE(o.errors.find("does not hold the truth of this run"), std::string::npos) << o.errors;
}

TEST_F(DaemonCommandsTest, AProgramThatFailsIsStatusOneWithTheReasonAndKeepsItsRows) {
  machine_.FailWith(Reason::kFollowingError, "axis x is further from its reference than allowed");
  const fs::path out = directory_ / "out";
  const Outcome o = Ask("run " + (directory_ / "circle.yaml").string() + " --out " + out.string());
  EXPECT_EQ(o.status, 1);
  EXPECT_NE(o.errors.find("axis x is further from its reference than allowed"), std::string::npos)
      << o.errors;
  EXPECT_TRUE(fs::exists(out / "cycles.csv"));
}

// Whoever is told that it failed would go near a machine that moves.
TEST_F(DaemonCommandsTest, AFullDiskKeepsNobodyFromFollowingTheProgramToItsEnd) {
  const fs::path out = directory_ / "out";
  const Outcome o = Ask("run " + (directory_ / "circle.yaml").string() + " --out " + out.string(),
                        "trap '' XFSZ; ulimit -f 64; ");
  EXPECT_EQ(o.status, 1);
  const std::size_t told = o.errors.find("the program goes on without rows");
  EXPECT_NE(told, std::string::npos) << o.errors;
  EXPECT_NE(o.out.find("done: "), std::string::npos) << "it waits for the end: " << o.out;
  EXPECT_NE(o.errors.find("the program has ended, but its rows are lost", told), std::string::npos)
      << o.errors;
  EXPECT_FALSE(fs::exists(out / "metrics.json"));
}

TEST_F(DaemonCommandsTest, AProgramThatMakesNoSenseIsStatusTwo) {
  std::ofstream(directory_ / "bad.yaml") << "shape: circle\nradius_mm: -1\n";
  const Outcome o = Ask("run " + (directory_ / "bad.yaml").string());
  EXPECT_EQ(o.status, 2);
  EXPECT_EQ(o.errors.find((directory_ / "bad.yaml").string()), 0u) << o.errors;
  EXPECT_EQ(Ask("run " + (directory_ / "missing.yaml").string()).status, 2);
  EXPECT_EQ(Ask("run " + (directory_ / "circle.yaml").string() + " --truth " +
                (directory_ / "circle.yaml").string())
                .status,
            2)
      << "--truth means nothing without --out";
}

TEST_F(DaemonCommandsTest, ExportWritesOneRowPerCycleAndSaysWhatIsMissing) {
  const fs::path log = directory_ / "run.lcmlog";
  LogHeader header;
  header.cycle_us = 1000;
  header.axis_names = {"x", "y"};
  {
    LogWriter writer(log, header);
    TelemetryEncoder encoder({}, 1000, header.axis_names);
    TelemetrySink* sinks[] = {&writer};
    test::RandomCycleEntry random(1);
    for (std::uint64_t cycle = 1; cycle <= 120; ++cycle)
      if (cycle != 60) encoder.Add(random.Next(cycle, 2), sinks);
    encoder.Flush(sinks);
  }
  const fs::path table = directory_ / "run.csv";
  Outcome o = Contour("export " + log.string() + " --out " + table.string());
  EXPECT_EQ(o.status, 0) << o.errors;
  EXPECT_NE(o.out.find("119 cycles; 1 more ran"), std::string::npos) << o.out;
  const std::string text = ReadAll(table);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 120);
  EXPECT_NE(text.find("y_motor_angle_rad,y_torque_Nm"), std::string::npos);

  EXPECT_EQ(Contour("export " + (directory_ / "none").string() + " --out " + table.string()).status, 2);
  o = Contour("export " + (directory_ / "circle.yaml").string() + " --out " + table.string());
  EXPECT_EQ(o.status, 1);
  EXPECT_NE(o.errors.find("is not a log"), std::string::npos) << o.errors;
}

TEST_F(DaemonCommandsTest, ReferenceTellsWhereAxesStandAndRefusesWhatIsNoPosition) {
  const std::string socket = " --socket " + (directory_ / "control.sock").string();
  EXPECT_EQ(Contour("reference x=12.5 y=-3" + socket).status, 0);
  EXPECT_EQ(machine_.referenced_mm, (std::map<std::string, double>{{"x", 12.5}, {"y", -3.0}}));
  for (const char* wrong : {"x", "x=", "=3", "x=3mm", "x=1 x=2"}) {
    const Outcome outcome = Contour("reference " + std::string(wrong) + socket);
    EXPECT_EQ(outcome.status, 2) << wrong;
    EXPECT_NE(outcome.errors.find("expected AXIS=MM"), std::string::npos) << wrong;
  }
}

}  // namespace
}  // namespace contour
