// The loop in lock-step: time stands still while nothing is to be done, but not for the auxiliary I/O, and a
// machine that has died is not waited for over and over.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <thread>

#include "daemon/make_cycle_config.h"
#include "daemon/path_feeder.h"
#include "daemon/program/program.h"
#include "daemon/program_limits.h"
#include "daemon/rt/loop.h"
#include "drivers/can/loopback_bus.h"
#include "tools/machine/load_emulated_machine.h"
#include "tools/machine/placements.h"

namespace contour::test {
namespace {

/// The bus of the emulated machine, which may fall silent. Counts how often each grid point looked for
/// frames.
class SilencedBus final : public FrameBus {
 public:
  SilencedBus(std::uint32_t bitrate_bit_s, BusNode& node) : bus_(bitrate_bit_s, {&node}) {}
  std::size_t Receive(std::int64_t now_ns, std::span<StampedFrame> frames) noexcept override {
    looks_here_ = now_ns == here_ns_ ? looks_here_ + 1 : 1;
    here_ns_ = now_ns;
    most_looks = std::max(most_looks, looks_here_);
    if (sync_sent_ && stands_still_ms > 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(stands_still_ms.exchange(0)));
      return 0;
    }
    sync_sent_ = false;
    if (chatter > 0) return Chatter(now_ns, frames);
    const std::size_t got = bus_.Receive(now_ns, frames);
    if (!silent) return got;
    ++looks[now_ns];
    return 0;
  }
  std::size_t Send(std::int64_t now_ns, std::span<const CanFrame> frames) noexcept override {
    sync_sent_ = sync_sent_ || !frames.empty();
    return bus_.Send(now_ns, frames);
  }
  [[nodiscard]] BusState State() const noexcept override { return bus_.State(); }

  std::atomic<bool> silent{false};
  std::atomic<int> chatter{0};  ///< heartbeats that arrive before anything else
  /// The host stands still for so long in the first look after the next SYNC, which comes to nothing for it.
  std::atomic<int> stands_still_ms{0};
  // Of the loop's thread, until it has ended.
  std::map<std::int64_t, int> looks;
  int most_looks = 0;  ///< at one grid point, silent or not

 private:
  std::size_t Chatter(std::int64_t now_ns, std::span<StampedFrame> frames) noexcept {
    const std::size_t got = std::min(frames.size(), static_cast<std::size_t>(chatter.load()));
    const CanFrame operational{0x701, 1, {0x05}};
    std::fill_n(frames.begin(), got, StampedFrame{operational, 0, now_ns});
    chatter -= static_cast<int>(got);
    return got;
  }

  LoopbackBus bus_;
  bool sync_sent_ = false;  ///< since the last look
  std::int64_t here_ns_ = -1;
  int looks_here_ = 0;
};

class SwitchedIo final : public IoSource {
 public:
  IoInput Read(std::int64_t) noexcept override { return {true, true, closed, true, 20.0}; }
  std::atomic<bool> closed{true};
};

/// A loop in lock-step in a thread of its own, with the pump's work done by the test.
class LockstepLoop : public ::testing::Test {
 protected:
  LockstepLoop()
      : file_(LoadEmulatedMachine(std::string(CONTOUR_CONFIG_DIR) + "/single_axis.yaml", {})),
        emulated_(file_.emulator, EmulatedPlacements(file_.machine),
                  static_cast<std::uint32_t>(file_.machine.machine.cycle_us), EmulatedClock::kSync),
        bus_(file_.machine.buses.begin()->second.bitrate_bit_s, emulated_.node(0)),
        cycle_(MakeCycleConfig(file_.machine, ControllerName::kPid)),
        loop_({std::int64_t{1000} * file_.machine.machine.cycle_us, 200'000, nullptr}, cycle_, buses_,
              mailbox_, io_, queue_),
        thread_([this] { loop_.RunLockstep(); }) {}
  ~LockstepLoop() override { End(); }

  void End() {
    mailbox_.PostTerminate();
    AwaitRecord([this](const CycleRecord&) { return ended_; });
    if (thread_.joinable()) thread_.join();
  }
  /// Until a record is as wanted; CTest ends a test that waits for ever.
  void AwaitRecord(const std::function<bool(const CycleRecord&)>& wanted) {
    while (!ended_) {
      CycleEntry* entry = queue_.Front();
      if (entry == nullptr) {
        std::this_thread::yield();
        continue;
      }
      const CycleRecord record = entry->output.record;
      ended_ = entry->output.finished;
      quiescent_ = entry->output.quiescent;
      stale_cycles_ = record.stale_cycles;
      queue_.Release();
      if (wanted(record)) return;
    }
  }
  void AwaitState(MachineState state) {
    AwaitRecord([state](const CycleRecord& r) { return r.state == state; });
  }

  EmulatedMachineFile file_;
  EmulatedMachine emulated_;
  SilencedBus bus_;
  FrameBus* buses_[1] = {&bus_};
  SwitchedIo io_;
  CommandMailbox mailbox_{16, 64};
  TelemetryQueue queue_{256};
  Cycle cycle_;
  Loop loop_;
  bool ended_ = false;
  bool quiescent_ = false;          ///< after the latest record
  std::uint64_t stale_cycles_ = 0;  ///< likewise
  std::thread thread_;
};

TEST_F(LockstepLoop, AnOpenedEmergencyStopIsSeenWhileTimeStandsStill) {
  AwaitState(MachineState::kIdle);
  mailbox_.Post(RequestKind::kEnable);
  AwaitState(MachineState::kReady);
  io_.closed = false;
  // No request comes: without the I/O nothing would end the wait.
  CycleRecord seen;
  AwaitRecord([&](const CycleRecord& r) {
    seen = r;
    return r.state == MachineState::kFaulted;
  });
  EXPECT_EQ(seen.reason, Reason::kEmergencyStop) << Name(seen.reason);
}

// The thread with the points may be kept waiting for longer than the cycles take that a program is waited
// for.
TEST_F(LockstepLoop, PointsThatAreAnnouncedAreWaitedFor) {
  AwaitState(MachineState::kIdle);
  mailbox_.Post(RequestKind::kEnable);
  CycleRecord seen;
  AwaitRecord([&](const CycleRecord& r) {
    seen = r;
    return r.state == MachineState::kReady;
  });
  constexpr std::uint32_t kProgram = 7;
  PathFeeder feeder(mailbox_);
  feeder.Announce();
  const std::uint32_t asked = mailbox_.Post(RequestKind::kRun, kProgram);
  AwaitRecord([&](const CycleRecord& r) { return r.acknowledged == asked; });
  for (const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(300);
       std::chrono::steady_clock::now() < until;) {
    const CycleEntry* entry = queue_.Front();
    if (entry == nullptr) continue;
    ASSERT_EQ(entry->output.record.reason, Reason::kNone) << Name(entry->output.record.reason);
    queue_.Release();
  }
  PerAxis<double> start_m;
  start_m.push_back(seen.axes[0].reference.position_m);
  feeder.Begin(std::make_unique<PathGenerator>(
      ParseProgram("shape: hold\nseconds: 0.3\n", "hold", ProgramFormat::kYaml), start_m,
      ProgramLimits(file_.machine), 1e-6 * file_.machine.machine.cycle_us, kProgram));
  AwaitRecord([&](const CycleRecord& r) {
    feeder.Feed();
    seen = r;
    return r.reason != Reason::kNone;
  });
  EXPECT_EQ(seen.reason, Reason::kProgramEnd) << Name(seen.reason);
}

TEST_F(LockstepLoop, NoAnswerIsWaitedForBeforeTheFirstSync) {
  AwaitState(MachineState::kIdle);
  End();
  // Waiting in vain is for 2 s, a look every 50 us; an answer of the emulated machine is there at once.
  EXPECT_LT(bus_.most_looks, 2000);
}

TEST_F(LockstepLoop, HeartbeatsOfALongPauseDoNotHideTheFeedback) {
  AwaitState(MachineState::kIdle);
  mailbox_.Post(RequestKind::kEnable);
  AwaitState(MachineState::kReady);
  while (!quiescent_) AwaitRecord([](const CycleRecord&) { return true; });
  const std::uint64_t missing = stale_cycles_;
  bus_.chatter = 5 * static_cast<int>(kMaxFramesPerCycle);
  while (bus_.chatter > 0) std::this_thread::yield();
  mailbox_.Post(RequestKind::kDisable);
  AwaitState(MachineState::kIdle);
  EXPECT_EQ(stale_cycles_, missing);
}

// What answers is there, and a look that came late says no more of its silence than one in time.
TEST_F(LockstepLoop, AHostThatStandsStillMakesNoDriveSilent) {
  AwaitState(MachineState::kIdle);
  while (!quiescent_) AwaitRecord([](const CycleRecord&) { return true; });
  const std::uint64_t missing = stale_cycles_;
  bus_.stands_still_ms = 2200;  // an answer is waited for 2 s
  mailbox_.Post(RequestKind::kEnable);
  AwaitState(MachineState::kReady);
  EXPECT_EQ(bus_.stands_still_ms, 0);
  EXPECT_EQ(stale_cycles_, missing);
}

TEST_F(LockstepLoop, ADeadMachineIsWaitedForOnceNotEveryCycle) {
  AwaitState(MachineState::kIdle);
  mailbox_.Post(RequestKind::kEnable);
  AwaitState(MachineState::kReady);
  bus_.silent = true;
  mailbox_.Post(RequestKind::kDisable);
  AwaitState(MachineState::kFaulted);
  End();
  ASSERT_GT(bus_.looks.size(), 4u);
  int waited_long = 0;
  // Looks are at least 50 us apart, so that a period has 20 at most, whatever this computer is busy with.
  for (const auto& [grid, looks] : bus_.looks) waited_long += looks > 25 ? 1 : 0;
  EXPECT_LE(waited_long, 1);
}

}  // namespace
}  // namespace contour::test
