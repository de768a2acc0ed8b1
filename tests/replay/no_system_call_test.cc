// A cycle enters the kernel for nothing: it runs in a process that the kernel kills at its first system call.
#include <gtest/gtest.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>
#include <vector>

#include "daemon/make_cycle_config.h"
#include "tests/replay/eventful_run.h"

namespace contour::test {
namespace {

/// The signal that ended a process which did this without being allowed any system call but to end; 0 none.
int KilledBy(const std::function<void()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) _exit(77);
    work();
    syscall(SYS_exit, 0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFEXITED(status)) return WEXITSTATUS(status) == 0 ? 0 : -1;
  return WTERMSIG(status);
}

TEST(NoSystemCall, InAnyStepOfAnEventfulRun) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizer makes system calls of its own";
#endif
  const EmulatedMachineFile file = LoadEmulatedMachine(std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml");
  std::vector<CycleInput> inputs;
  EventfulRun run(file, ControllerName::kFull);
  run.machine().SetRecorder([&](const CycleEntry& entry) { inputs.push_back(entry.input); });
  run.BringUp();
  run.Enable();
  run.Start("{shape: square, side_mm: 0.4, feed_mm_min: 1200, corners: velocity_jump}", 150);
  run.Stop();
  run.Start("{shape: circle, radius_mm: 10, turns: 2, feed_mm_min: 900}", 100);
  run.EmergencyStop();
  run.Reset();
  ASSERT_GT(inputs.size(), 1500u);
  Cycle cycle(MakeCycleConfig(file.machine, ControllerName::kFull));
  CycleOutput output;
  const int signal = KilledBy([&] {
    for (const CycleInput& input : inputs) cycle.Step(input, output);
  });
  if (signal == -1) GTEST_SKIP() << "this kernel has no seccomp";
  EXPECT_EQ(signal, 0) << "killed by signal " << signal;
  EXPECT_EQ(KilledBy([] { getppid(); }), SIGKILL) << "the trap works";
}

}  // namespace
}  // namespace contour::test
