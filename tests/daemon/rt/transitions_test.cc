#include <gtest/gtest.h>

#include <vector>

#include "tests/daemon/rt/transitions_fixture.h"

namespace contour {
namespace {

TEST_F(TransitionsTest, NothingEnablesItself) {
  EXPECT_TRUE(Step().start_bring_up);
  for (int i = 0; i < 1000; ++i) {
    const Orders orders = Step();
    ASSERT_FALSE(orders.torque_allowed);
    ASSERT_NE(orders.goal, DriveGoal::kEnabled);
  }
  EXPECT_EQ(machine_.state(), MachineState::kIdle);
}

TEST_F(TransitionsTest, WhatTheMachineFindsWrongWithItselfIsAStopOnThePath) {
  ToRunning();
  now_.stop = {Reason::kOscillation, 1};
  const Orders orders = Step();
  EXPECT_TRUE(orders.stop_path);
  EXPECT_TRUE(orders.torque_allowed);
  EXPECT_EQ(machine_.state(), MachineState::kStopping);
  EXPECT_FALSE(Step().stop_path) << "begun once";
  now_.path_at_rest = true;
  Step();
  EXPECT_EQ(machine_.state(), MachineState::kFaulted);
  EXPECT_EQ(machine_.reason(), Reason::kOscillation);
  EXPECT_EQ(machine_.reason_where(), 1);
}

TEST_F(TransitionsTest, EnableRunAndProgramEnd) {
  ToRunning();
  EXPECT_EQ(machine_.program_id(), 3u);
  now_.path_at_end = true;
  const Orders orders = Step();
  EXPECT_EQ(machine_.state(), MachineState::kReady);
  EXPECT_EQ(machine_.reason(), Reason::kProgramEnd);
  EXPECT_TRUE(orders.torque_allowed);
}

TEST_F(TransitionsTest, EnableIsRefusedWithoutPermission) {
  ToIdle();
  for (const IoInput& io : {IoInput{true, false, true, true, 0}, IoInput{true, true, false, true, 0},
                            IoInput{true, true, true, false, 0}}) {
    now_.io = io;
    Step(RequestKind::kEnable);
    EXPECT_FALSE(machine_.acknowledged_ok());
    EXPECT_EQ(machine_.acknowledged(), sequence_);
    EXPECT_EQ(machine_.state(), MachineState::kIdle);
  }
  now_.io = {};  // no I/O configured
  Step(RequestKind::kEnable);
  EXPECT_TRUE(machine_.acknowledged_ok());
}

TEST_F(TransitionsTest, AnAxisThatMovesIsNotEnabled) {
  ToIdle();
  now_.moves = 1;
  Step(RequestKind::kEnable);
  EXPECT_FALSE(machine_.acknowledged_ok());
  EXPECT_EQ(machine_.state(), MachineState::kIdle);
  EXPECT_EQ(machine_.reason(), Reason::kAxisMoves);
  EXPECT_EQ(machine_.reason_where(), 1);
  Step();
  EXPECT_EQ(machine_.reason(), Reason::kAxisMoves);
  now_.moves = 0xFF;
  Step();
  EXPECT_EQ(machine_.reason(), Reason::kNone) << "it stands: nothing is in the way any more";
  Step(RequestKind::kEnable);
  EXPECT_TRUE(machine_.acknowledged_ok());
  EXPECT_EQ(machine_.reason(), Reason::kNone);
  for (int i = 0; i < 5; ++i) Step();
  ASSERT_EQ(machine_.state(), MachineState::kReady);
  now_.moves = 0;
  Step(RequestKind::kEnable);
  EXPECT_TRUE(machine_.acknowledged_ok()) << "it is enabled already";
}

TEST_F(TransitionsTest, ADriveThatIsFoundEnabledIsWaitedForAndThenNamed) {
  Step();
  now_.drives[1] = DriveState::kOperationEnabled;
  int waited = 0;
  while (machine_.state() == MachineState::kStarting && waited < 100) {
    machine_.Step(now_);
    ++waited;
  }
  EXPECT_EQ(machine_.state(), MachineState::kFaulted);
  EXPECT_EQ(machine_.reason(), Reason::kDriveStaysEnabled);
  EXPECT_EQ(machine_.reason_where(), 1);
  EXPECT_GT(waited, 10);

  // Its driver knows sooner, and stops it by NMT.
  machine_ = Transitions({10, 20, 30});
  machine_.Step(now_);
  machine_.Step(now_);
  now_.lost = {Reason::kDriveStaysEnabled, 1};
  machine_.Step(now_);
  EXPECT_EQ(machine_.state(), MachineState::kFaulted);
  EXPECT_EQ(machine_.reason(), Reason::kDriveStaysEnabled);
  EXPECT_EQ(machine_.reason_where(), 1);
  now_.lost = {};

  machine_ = Transitions({10, 20, 30});
  now_.drives[1] = DriveState::kOperationEnabled;
  machine_.Step(now_);
  machine_.Step(now_);
  now_.drives[1] = DriveState::kSwitchOnDisabled;
  machine_.Step(now_);
  EXPECT_EQ(machine_.state(), MachineState::kIdle);
}

TEST_F(TransitionsTest, EveryMovingStateFallsToFaultedInTheSameCycle) {
  struct Case {
    Reason reason;
    bool lost;
  };
  for (const Case c :
       {Case{Reason::kDriveFault, false}, Case{Reason::kBusDown, true}, Case{Reason::kHeartbeatLost, true}}) {
    machine_ = Transitions({10, 20, 30});
    now_.fault = now_.lost = {};
    SetDrives(DriveState::kSwitchedOn);
    now_.path_prefetched = now_.path_begins_here = false;
    ToRunning();
    (c.lost ? now_.lost : now_.fault) = {c.reason, 1};
    const Orders orders = machine_.Step(now_);
    EXPECT_EQ(machine_.state(), MachineState::kFaulted);
    EXPECT_EQ(machine_.reason(), c.reason);
    EXPECT_EQ(machine_.reason_where(), 1);
    EXPECT_FALSE(orders.torque_allowed);
    EXPECT_EQ(orders.goal, DriveGoal::kQuickStop);
  }
}

TEST_F(TransitionsTest, EmergencyStopInputIsAQuickStop) {
  ToRunning();
  now_.io.emergency_stop_ok = false;
  const Orders orders = machine_.Step(now_);
  EXPECT_EQ(machine_.state(), MachineState::kFaulted);
  EXPECT_EQ(machine_.reason(), Reason::kEmergencyStop);
  EXPECT_EQ(orders.goal, DriveGoal::kQuickStop);
}

TEST_F(TransitionsTest, LostIoStopsOnThePathThenFaults) {
  ToRunning();
  now_.io.fresh = false;
  EXPECT_TRUE(Step().stop_path);
  EXPECT_EQ(machine_.state(), MachineState::kStopping);
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(Step().stop_path);
  now_.path_at_rest = true;
  Step();
  EXPECT_EQ(machine_.state(), MachineState::kFaulted);
  EXPECT_EQ(machine_.reason(), Reason::kIoStale);
}

TEST_F(TransitionsTest, EmergencyStopDuringAStopStillActsAtOnce) {
  ToRunning();
  Step(RequestKind::kStop);
  now_.io.emergency_stop_ok = false;
  Step();
  EXPECT_EQ(machine_.state(), MachineState::kFaulted);
}

TEST_F(TransitionsTest, StopLeadsToReadyDisableToIdle) {
  ToRunning();
  EXPECT_TRUE(Step(RequestKind::kStop).stop_path);
  now_.path_at_rest = true;
  Step();
  EXPECT_EQ(machine_.state(), MachineState::kReady);
  Step(RequestKind::kDisable);
  const Orders orders = Step();
  EXPECT_EQ(machine_.state(), MachineState::kIdle);
  EXPECT_FALSE(orders.torque_allowed);
}

TEST_F(TransitionsTest, WhoAsksForAStopAgainGetsTheShortest) {
  ToRunning();
  EXPECT_TRUE(Step(RequestKind::kStop).within_limits);
  EXPECT_FALSE(Step().shorten_stop);
  EXPECT_TRUE(Step(RequestKind::kStop).shorten_stop);
  EXPECT_EQ(machine_.state(), MachineState::kStopping);
}

TEST_F(TransitionsTest, WhoAsksForAStopHasTimeForTheLimitsAFaultHasNot) {
  for (const RequestKind kind : {RequestKind::kStop, RequestKind::kDisable, RequestKind::kTerminate}) {
    machine_ = Transitions({10, 20, 30});
    SetDrives(DriveState::kSwitchedOn);
    now_.io.enable_chain_ok = now_.path_at_rest = true;
    now_.path_prefetched = now_.path_begins_here = false;
    ToRunning();
    EXPECT_TRUE(Step(kind).within_limits);
    now_.io.enable_chain_ok = false;
    const Orders orders = Step();
    EXPECT_TRUE(orders.stop_path) << "one that is under way becomes the shortest";
    EXPECT_FALSE(orders.within_limits);
  }
}

TEST_F(TransitionsTest, TerminateStopsOnThePathThenFinishes) {
  ToRunning();
  EXPECT_TRUE(Step(RequestKind::kTerminate).stop_path);
  EXPECT_FALSE(Step().finished);
  now_.path_at_rest = true;
  bool finished = false;
  for (int i = 0; i < 5 && !finished; ++i) finished = Step().finished;
  EXPECT_TRUE(finished);
  Step(RequestKind::kEnable);
  EXPECT_FALSE(machine_.acknowledged_ok()) << "nothing enables a machine that is going down";
}

TEST_F(TransitionsTest, TerminateWhileFaultedOrStartingFinishes) {
  machine_ = Transitions({10, 20, 30});
  now_.operational = false;
  now_.bring_up_active = true;
  Step();
  bool finished = false;
  Step(RequestKind::kTerminate);
  for (int i = 0; i < 50 && !finished; ++i) finished = Step().finished;
  EXPECT_TRUE(finished);
}

TEST_F(TransitionsTest, AStopThatDoesNotComeToRestIsAFault) {
  ToRunning();
  Step(RequestKind::kStop);
  for (int i = 0; i < 30; ++i) Step();
  EXPECT_EQ(machine_.state(), MachineState::kFaulted);
  EXPECT_EQ(machine_.reason(), Reason::kStopTimeout);
}

TEST_F(TransitionsTest, DrivesThatDoNotEnableAreAFault) {
  ToIdle();
  now_.request = {RequestKind::kEnable, ++sequence_, 0};
  machine_.Step(now_);
  now_.request = {};
  for (int i = 0; i < 30; ++i) machine_.Step(now_);
  EXPECT_EQ(machine_.state(), MachineState::kFaulted);
  EXPECT_EQ(machine_.reason(), Reason::kEnableTimeout);
  EXPECT_EQ(machine_.reason_where(), 0);
}

TEST_F(TransitionsTest, TheDriveThatDoesNotEnableIsNamedAtItsOwnDeadline) {
  ToIdle();
  now_.request = {RequestKind::kEnable, ++sequence_, 0};
  machine_.Step(now_);
  now_.request = {};
  now_.drives[0] = DriveState::kOperationEnabled;
  now_.drives[1] = DriveState::kReadyToSwitchOn;
  machine_.Step(now_);
  EXPECT_EQ(machine_.state(), MachineState::kEnabling);
  now_.stuck = 1;
  machine_.Step(now_);
  EXPECT_EQ(machine_.reason(), Reason::kEnableTimeout);
  EXPECT_EQ(machine_.reason_where(), 1);
}

TEST_F(TransitionsTest, WhatLeavesTimeStopsOnThePathThenFaults) {
  ToRunning();
  now_.stop = {Reason::kDriveEmergency, 1};
  EXPECT_TRUE(Step().stop_path);
  EXPECT_EQ(machine_.state(), MachineState::kStopping);
  EXPECT_EQ(machine_.reason(), Reason::kDriveEmergency);
  EXPECT_EQ(machine_.reason_where(), 1);
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(Step().stop_path);
  now_.path_at_rest = true;
  Step();
  EXPECT_EQ(machine_.state(), MachineState::kFaulted);
  EXPECT_EQ(machine_.reason(), Reason::kDriveEmergency);
}

// Before: the drive's ramp went by its encoder, and where that was the one that lied an axis at rest ran
// away.
TEST_F(TransitionsTest, AfterAStopForADoubtedScaleNoRampGoesByTheEncoder) {
  ToRunning();
  now_.stop = {Reason::kScaleDoubted, 1};
  EXPECT_EQ(machine_.Step(now_).voltage_off, 0xFF) << "it stops on the path first";
  now_.path_at_rest = true;
  machine_.Step(now_);
  ASSERT_EQ(machine_.state(), MachineState::kFaulted);
  EXPECT_EQ(machine_.Step(now_).voltage_off, 1);
}

TEST_F(TransitionsTest, WhatLeavesTimeForAStopKeepsAMachineFromBeingEnabled) {
  ToIdle();
  now_.stop = {Reason::kDriveEmergency, 0};
  for (int i = 0; i < 5; ++i) Step();
  EXPECT_EQ(machine_.state(), MachineState::kIdle);
  Step(RequestKind::kEnable);
  Step();
  EXPECT_EQ(machine_.state(), MachineState::kFaulted);
}

TEST_F(TransitionsTest, AnEncoderThatCannotBeBelievedTakesTheVoltageOfItsAxisAlone) {
  ToRunning();
  now_.fault = {Reason::kDriveEmergency, 1, true};
  Orders orders = machine_.Step(now_);
  EXPECT_EQ(orders.goal, DriveGoal::kQuickStop);
  EXPECT_EQ(orders.voltage_off, 1);
  now_.fault = {};
  orders = machine_.Step(now_);
  EXPECT_EQ(orders.voltage_off, 1) << "as long as the others brake";
  EXPECT_EQ(machine_.RaiseLate({Reason::kFollowingError, 0}).voltage_off, 0xFF);
  EXPECT_EQ(machine_.RaiseLate({Reason::kFeedbackFrozen, 0, true}).voltage_off, 0);
}

TEST_F(TransitionsTest, ADriveThatLaterSaysThatItLostItsMasterExplainsWhatWasSeenOfIt) {
  ToRunning();
  now_.fault = {Reason::kFollowingError, 1};
  Step();
  now_.fault = {};
  EXPECT_EQ(machine_.reason(), Reason::kFollowingError);
  now_.says_lost_master = true;
  Step();
  EXPECT_EQ(machine_.state(), MachineState::kFaulted);
  EXPECT_EQ(machine_.reason(), Reason::kDriveLostMaster);
  EXPECT_EQ(machine_.reason_where(), 1);
}

TEST_F(TransitionsTest, WhatADriveSaysMuchLaterOrOfAnotherCauseExplainsNothing) {
  for (const bool late : {false, true}) {
    machine_ = Transitions({10, 20, 30, 50});
    now_.path_prefetched = now_.says_lost_master = false;
    SetDrives(DriveState::kSwitchedOn);
    ToReady();
    now_.fault = {late ? Reason::kFollowingError : Reason::kFeedbackJump, 0};
    Step();
    const Reason reason = now_.fault.reason;
    now_.fault = {};
    for (int i = 0; i < (late ? 60 : 1); ++i) Step();
    now_.says_lost_master = true;
    Step();
    EXPECT_EQ(machine_.reason(), reason);
  }
}

TEST_F(TransitionsTest, APathThatBeginsElsewhereIsRefused) {
  ToReady();
  Step(RequestKind::kRun, 4);
  now_.path_prefetched = true;
  now_.path_begins_here = false;
  const Orders orders = Step();
  EXPECT_TRUE(orders.forget_path);
  EXPECT_FALSE(orders.start_path);
  EXPECT_EQ(machine_.state(), MachineState::kReady);
  EXPECT_EQ(machine_.reason(), Reason::kPathDiscontinuous);
}

TEST_F(TransitionsTest, ALateFaultActsInTheSameCycle) {
  ToRunning();
  const Orders orders = machine_.RaiseLate({Reason::kFollowingError, 0});
  EXPECT_EQ(machine_.state(), MachineState::kFaulted);
  EXPECT_FALSE(orders.torque_allowed);
  EXPECT_TRUE(orders.forget_path);
}

TEST_F(TransitionsTest, AnotherMasterIsAFaultFromIdleUpAndEndsInSilence) {
  ToReady();
  now_.second_master = {Reason::kSecondMaster, 1};
  now_.lost = {Reason::kHeartbeatLost, 0};  // its doing
  EXPECT_EQ(Step().goal, DriveGoal::kQuickStop);
  EXPECT_EQ(machine_.reason(), Reason::kSecondMaster);
  EXPECT_EQ(machine_.reason_where(), 1);
  int cycles = 0;
  while (!Step().fall_silent && cycles < 100) ++cycles;
  EXPECT_GT(cycles, 3) << "the drives are told to disable their voltage first";
  EXPECT_LT(cycles, 20);
}

TEST_F(TransitionsTest, AnotherMasterFaultsAnIdleMachineAndSilencesAFaultedOne) {
  ToIdle();
  now_.second_master = {Reason::kSecondMaster, 0};
  Step();
  EXPECT_EQ(machine_.reason(), Reason::kSecondMaster);

  Transitions other({10, 20, 30});
  std::swap(machine_, other);
  now_.second_master = {};
  ToReady();
  now_.fault = {Reason::kDriveFault, 0};
  Step();
  ASSERT_EQ(machine_.state(), MachineState::kFaulted);
  now_.second_master = {Reason::kSecondMaster, 0};
  bool silent = false;
  for (int i = 0; i < 50; ++i) silent = Step().fall_silent;
  EXPECT_TRUE(silent);
  EXPECT_EQ(machine_.reason(), Reason::kDriveFault) << "the first cause stays";
}

TEST_F(TransitionsTest, DrivesThatDoNotLetGoDoNotKeepItTalking) {
  ToReady();
  now_.second_master = {Reason::kSecondMaster, 0};
  bool silent = false;
  for (int i = 0; i < 40; ++i) {
    silent = Step().fall_silent;
    SetDrives(DriveState::kOperationEnabled);
    if (i < 15) {
      EXPECT_FALSE(silent);
    }
  }
  EXPECT_TRUE(silent) << "after the stop's own deadline";
}

TEST_F(TransitionsTest, WithoutAReferenceProgramsAreRefusedAndItCanBeToldInIdleOnly) {
  ToReady();
  now_.not_referenced = 1;
  now_.can_reference = true;
  EXPECT_FALSE(Step(RequestKind::kRun, 3).expect_path);
  EXPECT_FALSE(machine_.acknowledged_ok());
  EXPECT_EQ(machine_.reason(), Reason::kNotReferenced);
  EXPECT_EQ(machine_.reason_where(), 1);
  EXPECT_FALSE(Step(RequestKind::kReference).reference) << "held";
  EXPECT_FALSE(machine_.acknowledged_ok());
  Step(RequestKind::kDisable);
  now_.path_at_rest = true;
  for (int i = 0; i < 5; ++i) Step();
  ASSERT_EQ(machine_.state(), MachineState::kIdle);
  const Orders orders = Step(RequestKind::kReference);
  EXPECT_TRUE(orders.reference);
  EXPECT_TRUE(orders.hold_here);
  EXPECT_TRUE(machine_.acknowledged_ok());
  now_.can_reference = false;
  EXPECT_FALSE(Step(RequestKind::kReference).reference);
  EXPECT_FALSE(machine_.acknowledged_ok());
}

}  // namespace
}  // namespace contour
