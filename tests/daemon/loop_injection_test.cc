// Delays brought into the real-time loop from outside, through a bus of the test: each must be found under
// its own cause. On a busy computer other causes may come on top; the stamps and counts of the cycle then say
// so, too.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <memory>
#include <thread>
#include <vector>

#include "config/load_machine.h"
#include "daemon/make_cycle_config.h"
#include "daemon/rt/loop.h"

namespace contour::test {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kPeriod_ns = 2 * kMs;
constexpr int kEvery = 20;
constexpr int kTimes = 12;

std::int64_t Now_ns() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

void Spin(std::int64_t length_ns) {
  for (const std::int64_t end = Now_ns() + length_ns; Now_ns() < end;) {
  }
}

enum class Injected { kNothing, kSlowReceive, kSlowSend, kPageFaults, kWait };

/// A bus on which nobody answers, and on which now and then something takes its time.
class DisturbedBus final : public FrameBus {
 public:
  explicit DisturbedBus(Injected what) : what_(what) {
    if (what == Injected::kPageFaults) {
      memory_ = static_cast<char*>(
          mmap(nullptr, kMemory, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
      madvise(memory_, kMemory, MADV_NOHUGEPAGE);
    }
  }
  ~DisturbedBus() override {
    if (memory_ != nullptr) munmap(memory_, kMemory);
  }
  std::size_t Receive(std::int64_t, std::span<StampedFrame>) noexcept override {
    ++calls_;
    if (!Due()) return 0;
    if (what_ == Injected::kSlowReceive) Spin(4 * kMs);
    if (what_ == Injected::kPageFaults) {
      madvise(memory_, kMemory, MADV_DONTNEED);
      for (std::size_t at = 0; at < kMemory; at += 4096) memory_[at] = 1;
    }
    if (what_ == Injected::kWait) {
      const timespec t{0, 4 * kMs};
      nanosleep(&t, nullptr);
    }
    return 0;
  }
  std::size_t Send(std::int64_t, std::span<const CanFrame> frames) noexcept override {
    if (Due() && what_ == Injected::kSlowSend) Spin(4 * kMs);
    return frames.size();
  }
  [[nodiscard]] BusState State() const noexcept override { return {.up = true}; }
  [[nodiscard]] bool Due() const noexcept { return calls_ % kEvery == 0; }

 private:
  static constexpr std::size_t kMemory = std::size_t{6} << 20;
  Injected what_;
  int calls_ = 0;
  char* memory_ = nullptr;
};

struct Case {
  const char* name;
  Injected what;
  LateCause cause;
};

class LoopInjection : public ::testing::TestWithParam<Case> {};

/// The timing of every cycle of a loop on such a bus.
std::vector<CycleTiming> RunLoop(Injected what) {
  CycleConfig config = MakeCycleConfig(LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/single_axis.yaml"),
                                       ControllerName::kPid);
  config.cycle_us = 2000;
  config.master.cycle_us = 2000;
  auto cycle = std::make_unique<Cycle>(config);
  DisturbedBus bus(what);
  FrameBus* buses[] = {&bus};
  CommandMailbox mailbox(4, 4);
  NoIo io;
  TelemetryQueue queue(1024);
  Loop loop({kPeriod_ns, kMs, nullptr}, *cycle, buses, mailbox, io, queue);
  std::thread thread([&] { loop.RunWall(); });
  // Frames are sent while drives are looked for; the master sends at every SYNC.
  while (loop.counters().cycles < kEvery * kTimes + kEvery / 2) usleep(5000);
  mailbox.PostTerminate();
  thread.join();
  std::vector<CycleTiming> timings;
  while (CycleEntry* entry = queue.Front()) {
    timings.push_back(entry->timing);
    queue.Release();
  }
  std::uint64_t late = 0;
  for (const auto& count : loop.counters().causes) late += count;
  EXPECT_EQ(late, loop.counters().late_cycles) << "each late cycle has exactly one cause";
  EXPECT_EQ(loop.counters().causes[0], 0u);
  return timings;
}

TEST_P(LoopInjection, IsFoundUnderItsCause) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  // The sanitizer's shadow memory is paged in while the loop runs: these page faults are real, and rightly
  // blamed.
  if (GetParam().what != Injected::kPageFaults)
    GTEST_SKIP() << "page faults of the sanitizer come before other causes";
#endif
  const std::vector<CycleTiming> timings = RunLoop(GetParam().what);
  int clean = 0;
  for (std::size_t i = kEvery - 1; i < timings.size(); i += kEvery) {
    const CycleTiming& t = timings[i];
    if (GetParam().what == Injected::kSlowSend && t.sent_ns - t.stepped_ns < 4 * kMs)
      continue;  // nothing to send
    ASSERT_TRUE(t.late) << "cycle " << i + 1;
    // Somebody else had the CPU for longer than was injected: then that is the cause, and right.
    const bool disturbed = t.run_delay_ns > kMs || t.wakeup_late_ns > 2 * kMs;
    if (disturbed) continue;
    EXPECT_EQ(t.cause, GetParam().cause)
        << "cycle " << i + 1 << ": " << Name(t.cause) << ", faults " << t.page_faults << ", switches "
        << t.voluntary_switches << " " << t.involuntary_switches << ", ready " << t.run_delay_ns;
    ++clean;
  }
  if (clean == 0) GTEST_SKIP() << "this computer is too busy: every injection was disturbed";
}

TEST(LoopInjectionTest, WithoutInjectionNothingIsBlamedOnTheProgram) {
  LateCause before = LateCause::kNone;
  for (const CycleTiming& t : RunLoop(Injected::kNothing)) {
    EXPECT_EQ(t.late, t.cause != LateCause::kNone);
    const bool alone = t.run_delay_ns == 0 && t.involuntary_switches == 0;
    // What is late for the cycle before has the cause of that one.
    EXPECT_FALSE(alone && t.cause == LateCause::kPreempted && before != LateCause::kPreempted);
    before = t.cause;
  }
}

INSTANTIATE_TEST_SUITE_P(EveryPart, LoopInjection,
                         ::testing::Values(Case{"receive", Injected::kSlowReceive, LateCause::kReceive},
                                           Case{"page_faults", Injected::kPageFaults, LateCause::kPageFault},
                                           Case{"wait", Injected::kWait, LateCause::kStopped}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace contour::test
