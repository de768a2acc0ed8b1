// What an operator is told and what the cycle is handed must be the same story, however slow or dead the rest
// is. The test plays the cycle: it takes requests and publishes records. Nobody empties the telemetry queue.
#include "daemon/supervisor.h"

#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "daemon/make_cycle_config.h"

namespace contour {
namespace {

class SupervisorTest : public ::testing::Test {
 protected:
  static TelemetryConfig Silent() {
    TelemetryConfig config;
    config.publish = false;
    return config;
  }
  /// The next cycle: what it takes of the mailbox.
  Request Take() { return mailbox_.TakeRequest(); }
  Request TakeWhenItComes() {
    for (;;) {
      if (const Request request = Take(); request.kind != RequestKind::kNone) return request;
      std::this_thread::yield();
    }
  }
  void Publish(std::uint32_t acknowledged, bool ok, MachineState state,
               ReferenceState reference = ReferenceState::kAbsolute, Reason reason = Reason::kNone) {
    CycleRecord& record = queue_.Reserve()->output.record;
    record = {};
    record.cycle = ++cycles_;
    record.state = state;
    record.acknowledged = acknowledged;
    record.acknowledged_ok = ok;
    record.axes.resize(1);
    record.axes[0].reference_state = reference;
    record.reason = reason;
    record.reason_axis = reason == Reason::kNone ? 0xFF : 0;
    queue_.Publish();
  }
  std::future<Answer> Enable() {
    return std::async(std::launch::async, [this] { return supervisor_.Enable(unwanted_.get_token()); });
  }

  std::future<Answer> RunOfOneThatLearns() {
    ProgramUpload upload;
    upload.name = "line.yaml";
    upload.format = "yaml";
    upload.text = "{shape: creep, axis: x, stroke_mm: 5, velocities_mm_s: [5]}";
    upload.from_here = true;
    return std::async(std::launch::async,
                      [this, upload] { return learns_.Run(upload, unwanted_.get_token()); });
  }

  const MachineConfig machine_ = LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/single_axis.yaml");
  CommandMailbox mailbox_{16, 16};
  TelemetryQueue queue_{4};
  TelemetryHub hub_{Silent(), 1000, {"x"}, std::nullopt};
  Pump pump_{queue_, mailbox_, hub_, 1e-3, {"x"}, {"main"}};
  ProgramLearning learning_{machine_};
  Cycle cycle_{MakeCycleConfig(machine_, ControllerName::kPid)};
  NoIo io_;
  Loop loop_{{}, cycle_, {}, mailbox_, io_, queue_};
  Supervisor supervisor_{
      machine_, ControllerName::kPid, "wall", {}, {mailbox_, queue_, hub_, pump_, loop_, learning_}, {}};
  const MachineConfig learning_machine_ = LoadMachine(
      ReadSource(std::string(CONTOUR_CONFIG_DIR) + "/single_axis.yaml",
                 {"learning={enabled: true}", "axes.x.drive.linear_scale={counts_per_mm: 1000}"}));
  ProgramLearning learns_programs_{learning_machine_};
  Supervisor learns_{learning_machine_,
                     ControllerName::kPid,
                     "wall",
                     {},
                     {mailbox_, queue_, hub_, pump_, loop_, learns_programs_},
                     {}};
  std::stop_source unwanted_;
  std::uint64_t cycles_ = 0;
};

TEST_F(SupervisorTest, AnswersAndStatusComeThoughNobodyEmptiesTheTelemetryQueue) {
  for (int i = 0; i < 20; ++i) Publish(0, false, MachineState::kIdle);
  ASSERT_GT(queue_.dropped(), 0u);
  auto enabling = Enable();
  const Request request = TakeWhenItComes();
  EXPECT_EQ(request.kind, RequestKind::kEnable);
  Publish(request.sequence, true, MachineState::kEnabling);
  EXPECT_TRUE(enabling.get().accepted);
  EXPECT_EQ(supervisor_.Status().record.state, MachineState::kEnabling);
  EXPECT_EQ(supervisor_.Status().record.cycle, 21u);
  auto stopping = std::async(std::launch::async, [this] { return supervisor_.Stop(); });
  const Request stop = TakeWhenItComes();
  EXPECT_EQ(stop.kind, RequestKind::kStop);
  Publish(stop.sequence, true, MachineState::kIdle);
  EXPECT_TRUE(stopping.get().accepted);
}

TEST_F(SupervisorTest, WhatTheCycleDoesNotTakeInTimeItNeverGets) {
  const Answer answer = Enable().get();
  EXPECT_FALSE(answer.accepted);
  EXPECT_NE(answer.reason.find("withdrawn"), std::string::npos) << answer.reason;
  EXPECT_EQ(Take().kind, RequestKind::kNone) << "the loop lives again, and nothing happens";
}

TEST_F(SupervisorTest, WhatNobodyWantsAnyMoreIsNotHandedToTheCycle) {
  unwanted_.request_stop();
  EXPECT_FALSE(Enable().get().accepted) << "before it was asked of the cycle";
  unwanted_ = std::stop_source();
  auto enabling = Enable();
  while (!mailbox_.request_waiting()) std::this_thread::yield();
  unwanted_.request_stop();
  EXPECT_FALSE(enabling.get().accepted) << "while it waited for the cycle";
  EXPECT_EQ(Take().kind, RequestKind::kNone);
}

TEST_F(SupervisorTest, WhatTheCycleHasTakenIsAnsweredByItWhoeverIsGone) {
  auto enabling = Enable();
  const Request request = TakeWhenItComes();
  unwanted_.request_stop();
  EXPECT_EQ(enabling.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
  Publish(request.sequence, true, MachineState::kEnabling);
  EXPECT_TRUE(enabling.get().accepted);
}

TEST_F(SupervisorTest, AnAbsoluteEncoderIsToldOnlyWhereItIsNotBelieved) {
  ASSERT_TRUE(machine_.axes.at("x").drive.absolute_encoder);
  const auto tell = [this] { return supervisor_.Reference({{"x", 12.5}}, unwanted_.get_token()); };
  Publish(0, false, MachineState::kIdle);
  const Answer knows = tell();
  EXPECT_FALSE(knows.accepted);
  EXPECT_NE(knows.reason.find("it knows where it is"), std::string::npos) << knows.reason;
  Publish(0, false, MachineState::kIdle, ReferenceState::kLost);
  auto telling = std::async(std::launch::async, tell);
  const Request request = TakeWhenItComes();
  EXPECT_EQ(request.kind, RequestKind::kReference);
  EXPECT_NEAR(DecodeReference(request.program_id).position_m, 0.0125, 1e-9);
  Publish(request.sequence, true, MachineState::kIdle);
  EXPECT_TRUE(telling.get().accepted);
}

TEST_F(SupervisorTest, WhyAnAxisThatMovesIsNotEnabledIsSaid) {
  Publish(0, false, MachineState::kIdle);
  auto enabling = Enable();
  const Request request = TakeWhenItComes();
  Publish(request.sequence, false, MachineState::kIdle, ReferenceState::kAbsolute, Reason::kAxisMoves);
  const Answer answer = enabling.get();
  EXPECT_FALSE(answer.accepted);
  EXPECT_NE(answer.reason.find("axis x is not at rest"), std::string::npos) << answer.reason;
  // One that falls under a weight never stands: what helps is its brake.
  EXPECT_NE(answer.reason.find("needs its brake"), std::string::npos) << answer.reason;
}

TEST_F(SupervisorTest, AWarningOfADriveIsInTheStatusWhileItLasts) {
  const std::uint16_t enabled = 0x1237;
  for (const std::uint16_t statusword : {enabled, static_cast<std::uint16_t>(enabled | 0x0080), enabled}) {
    CycleRecord& record = queue_.Reserve()->output.record;
    record = {};
    record.cycle = ++cycles_;
    record.axes.resize(1);
    record.axes[0].feedback.statusword = statusword;
    queue_.Publish();
    std::string told;
    for (const std::string& warning : supervisor_.Status().warnings) told += warning;
    EXPECT_EQ(told.find("axis x: its drive warns") != std::string::npos, statusword != enabled) << told;
  }
}

TEST_F(SupervisorTest, TorqueModeIsRefusedBeforeAnythingEnds) {
  const Answer unknown = supervisor_.ChangeMode({{"q", "regulator_Hz: 20"}}, {});
  EXPECT_FALSE(unknown.accepted);
  EXPECT_NE(unknown.reason.find("no axis q"), std::string::npos) << unknown.reason;
  const Answer pid = supervisor_.ChangeMode({{"x", "regulator_Hz: 20"}}, {});
  EXPECT_FALSE(pid.accepted) << "pid goes by no loop";
  EXPECT_NE(pid.reason.find("full"), std::string::npos) << pid.reason;
  const Answer csp = supervisor_.LeaveToDrives();
  EXPECT_FALSE(csp.accepted) << "pid has no drive that leads";
  EXPECT_NE(csp.reason.find("full"), std::string::npos) << csp.reason;
  EXPECT_FALSE(supervisor_.wanted().has_value());
}

// The main thread asks what is wanted between two looks for signals, and feeds the watchdog.
TEST_F(SupervisorTest, ACheckThatTakesLongKeepsNobodyFromAskingWhatIsWanted) {
  std::promise<void> go_on;
  std::promise<void> checking;
  const auto check = [&](const NewStart&) {
    checking.set_value();
    go_on.get_future().wait();
  };
  Supervisor slow{machine_,
                  ControllerName::kPid,
                  "wall",
                  {},
                  {mailbox_, queue_, hub_, pump_, loop_, learning_, nullptr, {}, {{}, check}},
                  ReadSource(std::string(CONTOUR_CONFIG_DIR) + "/single_axis.yaml", {})};
  Publish(0, false, MachineState::kIdle);
  auto loading = std::async(std::launch::async, [&] { return slow.LoadModel("x", ""); });
  checking.get_future().wait();
  auto asking = std::async(std::launch::async, [&] { return slow.wanted().has_value(); });
  EXPECT_EQ(asking.wait_for(std::chrono::seconds(20)), std::future_status::ready);
  // Enabled in the meantime: nobody begins anew under a machine that moves.
  Publish(0, false, MachineState::kReady);
  go_on.set_value();
  EXPECT_FALSE(asking.get());
  const Answer answer = loading.get();
  EXPECT_FALSE(answer.accepted);
  EXPECT_NE(answer.reason.find("it is Ready"), std::string::npos) << answer.reason;
  EXPECT_FALSE(slow.wanted().has_value());
}

// Else the pass that ended last would teach nothing.
TEST_F(SupervisorTest, AProgramThatIsLearntWaitsForTheEndOfItsLastPass) {
  Publish(0, false, MachineState::kReady);
  auto running = RunOfOneThatLearns();
  EXPECT_EQ(running.wait_for(std::chrono::milliseconds(1500)), std::future_status::timeout);
  EXPECT_FALSE(mailbox_.request_waiting()) << "the pump has shown nothing yet";
  pump_.Start();
  const Request request = TakeWhenItComes();
  EXPECT_EQ(request.kind, RequestKind::kRun);
  Publish(request.sequence, true, MachineState::kRunning);
  EXPECT_TRUE(running.get().accepted);
  pump_.Finish();
}

TEST_F(SupervisorTest, AStopEndsTheWaitForTheEndOfALastPass) {
  Publish(0, false, MachineState::kReady);
  auto running = RunOfOneThatLearns();
  ASSERT_EQ(running.wait_for(std::chrono::milliseconds(500)), std::future_status::timeout);
  unwanted_.request_stop();
  ASSERT_EQ(running.wait_for(std::chrono::seconds(5)), std::future_status::ready);
  const Answer answer = running.get();
  EXPECT_FALSE(answer.accepted);
  EXPECT_NE(answer.reason.find("a stop came first"), std::string::npos) << answer.reason;
  EXPECT_FALSE(mailbox_.request_waiting());
}

TEST_F(SupervisorTest, AStopMakesVoidWhatTheCycleHasNotTaken) {
  auto enabling = Enable();
  while (!mailbox_.request_waiting()) std::this_thread::yield();
  const std::uint32_t stop = mailbox_.PostStop();
  EXPECT_EQ(Take().sequence, stop);
  Publish(stop, true, MachineState::kIdle);
  EXPECT_EQ(Take().kind, RequestKind::kNone);
  const Answer answer = enabling.get();
  EXPECT_FALSE(answer.accepted);
  EXPECT_NE(answer.reason.find("a stop came first"), std::string::npos) << answer.reason;
}

TEST_F(SupervisorTest, WhoeverWaitsWhenTheLoopEndsIsToldSo) {
  auto enabling = Enable();
  while (!mailbox_.request_waiting()) std::this_thread::yield();
  supervisor_.LoopEnded();
  EXPECT_EQ(enabling.get().reason, "contourd is ending");
}

TEST_F(SupervisorTest, AMachineThatNobodyAttendsAnyMoreIsDisabled) {
  for (const MachineState state : {MachineState::kReady, MachineState::kRunning, MachineState::kEnabling}) {
    Publish(0, false, state);
    auto leaving = std::async(std::launch::async, [this] { supervisor_.Abandoned(); });
    while (!mailbox_.request_waiting() &&
           leaving.wait_for(std::chrono::milliseconds(1)) == std::future_status::timeout) {
    }
    const Request request = Take();
    EXPECT_EQ(request.kind, RequestKind::kDisable) << Name(state);
    Publish(request.sequence, true, MachineState::kIdle);
    leaving.get();
    EXPECT_FALSE(supervisor_.wanted().has_value()) << "in the mode of its file it stays as it is";
  }
}

TEST_F(SupervisorTest, AStopStaysAskedForWhileTheCycleDoesNotTakeIt) {
  const Answer answer = supervisor_.Stop();
  EXPECT_FALSE(answer.accepted) << "nobody has obeyed it";
  EXPECT_EQ(Take().kind, RequestKind::kStop) << "the loop lives again";
}

}  // namespace
}  // namespace contour
