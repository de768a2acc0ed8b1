#include "tools/doctor/examination.h"

#include <gtest/gtest.h>
#include <filesystem>
#include <fstream>
#include <map>

#include "tests/support/scratch_directory.h"

namespace contour {
namespace {

namespace fs = std::filesystem;

/// A computer made of files, first one on which everything is as it should be.
class ExaminationTest : public ::testing::Test {
 protected:
  void SetUp() override {
    Put("proc/sys/kernel/osrelease", "6.1.0-rt");
    Put("sys/kernel/realtime", "1");
    Put("proc/cmdline", "isolcpus=1");
    Put("sys/devices/system/cpu/isolated", "1-2");
    Put("proc/sys/kernel/sched_rt_runtime_us", "-1");
    Put("proc/sys/kernel/sched_rt_period_us", "1000000");
    Put("proc/sys/kernel/soft_watchdog", "0");
    Put("boot/config-6.1.0-rt", "# CONFIG_RT_GROUP_SCHED is not set");
    Put("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "performance");
    Put("proc/self/limits",
        "Max locked memory         unlimited            unlimited            bytes\n"
        "Max realtime priority     90                   90");
    Put("sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc");
    Put("sys/class/net/can0/type", "280");
    Put("sys/class/net/can0/tx_queue_len", "128");
    Put("sys/class/net/can0/device/irq", "17");
    Put("proc/irq/17/smp_affinity_list", "1");
    Put("sys/class/net/eth0/type", "1");
    request_.root = root_;
    request_.cpu = 1;
  }

  void Put(const std::string& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text << "\n";
  }
  [[nodiscard]] std::map<std::string, Finding> Findings() const {
    std::map<std::string, Finding> findings;
    for (const Finding& f : Examine(request_)) findings[f.what] = f;
    return findings;
  }
  /// This one is found, everything else stays good.
  void ExpectOnly(const std::string& what, FindingLevel level, const std::string& change) const {
    for (const auto& [name, finding] : Findings()) {
      if (name == what) {
        EXPECT_EQ(finding.level, level) << finding.found;
        EXPECT_NE(finding.change.find(change), std::string::npos) << finding.change;
      } else {
        EXPECT_EQ(finding.level, FindingLevel::kGood) << finding.found;
      }
    }
  }

  test::ScratchDirectory scratch_;
  const fs::path root_ = scratch_.path();
  ExaminationRequest request_;
};

TEST_F(ExaminationTest, FindsNothingOnAComputerThatIsReady) {
  EXPECT_EQ(Findings().size(), 11u);
  for (const auto& [name, finding] : Findings()) {
    EXPECT_EQ(finding.level, FindingLevel::kGood) << finding.found;
    EXPECT_EQ(finding.change, "");
  }
}

TEST_F(ExaminationTest, Kernel) {
  Put("sys/kernel/realtime", "0");
  ExpectOnly("kernel", FindingLevel::kChange, "linux-image-rt");
}

TEST_F(ExaminationTest, LockupWatchdog) {
  Put("proc/sys/kernel/soft_watchdog", "1");
  ExpectOnly("lockup_watchdog", FindingLevel::kAdvice, "soft_watchdog=0");
  Put("proc/sys/kernel/watchdog_cpumask", "0,2-3");
  EXPECT_EQ(Findings().at("lockup_watchdog").level, FindingLevel::kGood);
  Put("proc/sys/kernel/watchdog_cpumask", "0-3");
  ExpectOnly("lockup_watchdog", FindingLevel::kAdvice, "soft_watchdog=0");
}

TEST_F(ExaminationTest, Isolation) {
  Put("sys/devices/system/cpu/isolated", "2-3");
  ExpectOnly("isolation", FindingLevel::kAdvice, "isolcpus=1");
}

TEST_F(ExaminationTest, Throttling) {
  Put("proc/sys/kernel/sched_rt_runtime_us", "950000");
  ExpectOnly("throttling", FindingLevel::kAdvice, "sysctl -w kernel.sched_rt_runtime_us=-1");
}

TEST_F(ExaminationTest, GroupScheduling) {
  Put("boot/config-6.1.0-rt", "CONFIG_RT_GROUP_SCHED=y");
  ExpectOnly("group_scheduling", FindingLevel::kChange, "rt_group_sched=0");
  Put("proc/cmdline", "quiet rt_group_sched=0");
  ExpectOnly("group_scheduling", FindingLevel::kGood, "");
}

TEST_F(ExaminationTest, Governor) {
  Put("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "powersave");
  ExpectOnly("governor", FindingLevel::kChange, "echo performance > $g");
  Put("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "performance");
  Put("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "powersave");
  ExpectOnly("governor", FindingLevel::kGood, "");
}

TEST_F(ExaminationTest, Limits) {
  Put("proc/self/limits",
      "Max locked memory         unlimited            unlimited            bytes\n"
      "Max realtime priority     0                    0");
  ExpectOnly("priority", FindingLevel::kAdvice, "rtprio 80");
  Put("proc/self/limits",
      "Max locked memory         8388608              8388608              bytes\n"
      "Max realtime priority     90                   90");
  ExpectOnly("memory_lock", FindingLevel::kAdvice, "memlock unlimited");
}

TEST_F(ExaminationTest, Clock) {
  Put("sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet");
  ExpectOnly("clock", FindingLevel::kChange, "current_clocksource");
}

TEST_F(ExaminationTest, QueueOfTheInterface) {
  Put("sys/class/net/can0/tx_queue_len", "10");
  ExpectOnly("queue", FindingLevel::kChange, "ip link set can0 txqueuelen 128");
  request_.interfaces = {"can1"};
  ExpectOnly("queue", FindingLevel::kChange, "can-up@can1.service");
}

TEST_F(ExaminationTest, InterruptOfTheController) {
  Put("proc/irq/17/smp_affinity_list", "0-3");
  ExpectOnly("interrupts", FindingLevel::kAdvice, "echo 1 > /proc/irq/17/smp_affinity_list");
}

}  // namespace
}  // namespace contour
