#include "tools/doctor/examination.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>

namespace contour {
namespace {

namespace fs = std::filesystem;
using Level = FindingLevel;

constexpr int kArpHardwareCan = 280;  // ARPHRD_CAN
constexpr int kShortestQueue = 64;

/// What a computer says of itself, below a root.
class Computer {
 public:
  explicit Computer(fs::path root) : root_(std::move(root)) {}

  /// The first line of a file, without its end.
  [[nodiscard]] std::optional<std::string> Line(const fs::path& file) const {
    std::ifstream in(root_ / file);
    std::string line;
    if (!std::getline(in, line)) return std::nullopt;
    return line;
  }
  [[nodiscard]] std::optional<long> Number(const fs::path& file) const {
    const auto line = Line(file);
    long value = 0;
    if (!line || std::from_chars(line->data(), line->data() + line->size(), value).ec != std::errc())
      return std::nullopt;
    return value;
  }
  [[nodiscard]] std::string Text(const fs::path& file) const {
    std::ifstream in(root_ / file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  [[nodiscard]] bool Exists(const fs::path& file) const {
    std::error_code ignored;
    return fs::exists(root_ / file, ignored);
  }
  [[nodiscard]] std::vector<std::string> Names(const fs::path& directory) const {
    std::vector<std::string> names;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(root_ / directory, error))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  fs::path root_;
};

/// "1-3,7" as numbers.
std::set<int> Cpus(const std::string& list) {
  std::set<int> cpus;
  std::istringstream parts(list);
  for (std::string part; std::getline(parts, part, ',');) {
    int first = 0;
    const char* end = part.data() + part.size();
    const auto read = std::from_chars(part.data(), end, first);
    if (read.ec != std::errc()) continue;
    int last = first;
    if (read.ptr != end && *read.ptr == '-') std::from_chars(read.ptr + 1, end, last);
    for (int cpu = first; cpu <= last; ++cpu) cpus.insert(cpu);
  }
  return cpus;
}

Finding Kernel(const Computer& c) {
  const std::string release = c.Line("proc/sys/kernel/osrelease").value_or("unknown");
  const bool realtime = c.Line("sys/kernel/realtime").value_or("0") == "1" ||
                        c.Line("proc/version").value_or("").find("PREEMPT_RT") != std::string::npos;
  if (realtime) return {"kernel", Level::kGood, "kernel " + release + " is PREEMPT_RT", ""};
  return {"kernel", Level::kChange,
          "kernel " + release + " is not PREEMPT_RT: wake-ups may be milliseconds late",
          "apt-get install linux-image-rt-amd64 && reboot"};
}

Finding Isolation(const Computer& c, int cpu) {
  const std::string isolated = c.Line("sys/devices/system/cpu/isolated").value_or("");
  if (cpu < 0)
    return {"isolation", Level::kAdvice, "the cycle's thread is not bound to a CPU (realtime.cpu)",
            "realtime: {cpu: 1} in the machine file, and isolcpus=1 nohz_full=1 rcu_nocbs=1 on the kernel's "
            "command line"};
  if (Cpus(isolated).contains(cpu))
    return {"isolation", Level::kGood, "CPU " + std::to_string(cpu) + " is isolated", ""};
  const std::string n = std::to_string(cpu);
  return {"isolation", Level::kAdvice,
          "CPU " + n + " is shared with everything else (isolated: " +
              (isolated.empty() ? std::string("none") : isolated) + ")",
          "sed -i 's/^GRUB_CMDLINE_LINUX=\"/&isolcpus=" + n + " nohz_full=" + n + " rcu_nocbs=" + n +
              " /' /etc/default/grub && update-grub && reboot"};
}

Finding Throttling(const Computer& c) {
  const auto runtime_us = c.Number("proc/sys/kernel/sched_rt_runtime_us");
  if (!runtime_us)
    return {"throttling", Level::kUnknown, "the kernel does not say whether it throttles real time", ""};
  if (*runtime_us < 0) return {"throttling", Level::kGood, "real-time throttling is off", ""};
  const long period_us = c.Number("proc/sys/kernel/sched_rt_period_us").value_or(1'000'000);
  return {"throttling", Level::kAdvice,
          "when real-time threads take " + std::to_string(*runtime_us / 1000) + " of " +
              std::to_string(period_us / 1000) + " ms the kernel stops them for the rest",
          "sysctl -w kernel.sched_rt_runtime_us=-1"};
}

Finding LockupWatchdog(const Computer& c, int cpu) {
  const std::string name = "lockup_watchdog";
  if (c.Number("proc/sys/kernel/soft_watchdog").value_or(0) == 0)
    return {name, Level::kGood, "no watchdog for lockups takes the CPU from real-time threads", ""};
  const auto watched = c.Line("proc/sys/kernel/watchdog_cpumask");
  if (watched && cpu >= 0 && !Cpus(*watched).contains(cpu))
    return {name, Level::kGood, "the watchdog for lockups leaves CPU " + std::to_string(cpu) + " out", ""};
  return {
      name, Level::kAdvice,
      "the kernel's watchdog for lockups takes the CPU from any thread every few seconds, for microseconds",
      "sysctl -w kernel.soft_watchdog=0"};
}

Finding GroupScheduling(const Computer& c, int priority) {
  const std::string release = c.Line("proc/sys/kernel/osrelease").value_or("");
  const bool groups = c.Exists("sys/fs/cgroup/cpu/cpu.rt_runtime_us") ||
                      c.Text("boot/config-" + release).find("CONFIG_RT_GROUP_SCHED=y") != std::string::npos;
  if (!groups)
    return {"group_scheduling", Level::kGood, "the kernel has no real-time budgets for control groups", ""};
  if (c.Line("proc/cmdline").value_or("").find("rt_group_sched=0") != std::string::npos)
    return {"group_scheduling", Level::kGood, "real-time budgets for control groups are switched off", ""};
  return {
      "group_scheduling", Level::kChange,
      "the kernel gives control groups real-time budgets (RT_GROUP_SCHED), and services none: SCHED_FIFO " +
          std::to_string(priority) + " will be refused under systemd",
      "sed -i 's/^GRUB_CMDLINE_LINUX=\"/&rt_group_sched=0 /' /etc/default/grub && update-grub && reboot"};
}

Finding Governor(const Computer& c, int cpu) {
  std::set<std::string> governors;
  bool any = false;
  for (const std::string& name : c.Names("sys/devices/system/cpu")) {
    if (!name.starts_with("cpu") || (cpu >= 0 && name != "cpu" + std::to_string(cpu))) continue;
    const auto governor = c.Line(fs::path("sys/devices/system/cpu") / name / "cpufreq/scaling_governor");
    if (!governor) continue;
    any = true;
    if (*governor != "performance") governors.insert(*governor);
  }
  if (!any) return {"governor", Level::kGood, "the clock of the CPUs is not changed by the kernel", ""};
  if (governors.empty()) return {"governor", Level::kGood, "the CPUs' governor is performance", ""};
  const std::string which = cpu >= 0 ? "cpu" + std::to_string(cpu) : std::string("cpu*");
  return {"governor", Level::kChange,
          "the CPUs' governor is " + *governors.begin() + ": a cycle begins on a slow clock",
          "for g in /sys/devices/system/cpu/" + which +
              "/cpufreq/scaling_governor; do echo performance > $g; done"};
}

std::vector<std::string> CanInterfaces(const Computer& c) {
  std::vector<std::string> found;
  for (const std::string& name : c.Names("sys/class/net"))
    if (c.Number(fs::path("sys/class/net") / name / "type") == kArpHardwareCan) found.push_back(name);
  return found;
}

/// Interrupts of an interface's controller; none for a virtual one.
std::vector<std::string> InterruptsOf(const Computer& c, const std::string& interface) {
  const fs::path device = fs::path("sys/class/net") / interface / "device";
  std::vector<std::string> irqs = c.Names(device / "msi_irqs");
  if (irqs.empty())
    if (const auto irq = c.Number(device / "irq"); irq && *irq > 0) irqs.push_back(std::to_string(*irq));
  return irqs;
}

Finding Interrupts(const Computer& c, const std::string& interface, int cpu) {
  const std::vector<std::string> irqs = InterruptsOf(c, interface);
  if (irqs.empty()) return {"interrupts", Level::kGood, interface + " has no interrupt of its own", ""};
  std::string change, where;
  for (const std::string& irq : irqs) {
    const std::string list = c.Line(fs::path("proc/irq") / irq / "smp_affinity_list").value_or("");
    where += (where.empty() ? "" : ", ") + irq + " on CPU " + (list.empty() ? "unknown" : list);
    // Next to the cycle the frames wait for nobody else; anywhere else they must at least stay in one place.
    const bool good = cpu >= 0 ? Cpus(list) == std::set<int>{cpu} : Cpus(list).size() == 1;
    if (!good)
      change += (change.empty() ? "" : " && ") + std::string("echo ") + std::to_string(std::max(cpu, 0)) +
                " > /proc/irq/" + irq + "/smp_affinity_list";
  }
  return {"interrupts", change.empty() ? Level::kGood : Level::kAdvice,
          "interrupt of " + interface + ": " + where, change};
}

Finding Queue(const Computer& c, const std::string& interface) {
  const auto length = c.Number(fs::path("sys/class/net") / interface / "tx_queue_len");
  if (!length)
    return {"queue", Level::kChange, "there is no interface " + interface,
            interface.starts_with("vcan") ? "systemctl enable --now vcan-up@" + interface + ".service"
                                          : "systemctl enable --now can-up@" + interface + ".service"};
  const std::string text = interface + " queues " + std::to_string(*length) + " frames";
  if (*length >= kShortestQueue) return {"queue", Level::kGood, text, ""};
  return {"queue", Level::kChange, text + ": a batch of frames may not fit",
          "ip link set " + interface + " txqueuelen 128"};
}

/// The soft limit of a row of /proc/self/limits; -1 unlimited.
std::optional<long> Limit(const Computer& c, const std::string& row) {
  std::istringstream lines(c.Text("proc/self/limits"));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(row)) continue;
    std::istringstream rest(line.substr(row.size()));
    std::string value;
    rest >> value;
    if (value == "unlimited") return -1;
    long number = 0;
    if (std::from_chars(value.data(), value.data() + value.size(), number).ec == std::errc()) return number;
  }
  return std::nullopt;
}

Finding Priority(const Computer& c, int priority) {
  const auto limit = Limit(c, "Max realtime priority");
  const std::string wanted = std::to_string(priority);
  if (!limit) return {"priority", Level::kUnknown, "the limit of real-time priorities is not known", ""};
  if (*limit < 0 || *limit >= priority)
    return {"priority", Level::kGood, "priority " + wanted + " is allowed to this user", ""};
  return {"priority", Level::kAdvice,
          "this user may use priorities up to " + std::to_string(*limit) + ", the machine file asks for " +
              wanted + " (the service has its own limit, LimitRTPRIO)",
          "echo '@realtime - rtprio " + wanted + "' > /etc/security/limits.d/contourd.conf"};
}

Finding MemoryLock(const Computer& c) {
  const auto limit = Limit(c, "Max locked memory");
  if (!limit) return {"memory_lock", Level::kUnknown, "the limit of locked memory is not known", ""};
  if (*limit < 0) return {"memory_lock", Level::kGood, "memory may be locked without limit", ""};
  return {"memory_lock", Level::kAdvice,
          "this user may lock " + std::to_string(*limit / 1024) +
              " KiB, contourd locks all of its memory (the service has its own limit, LimitMEMLOCK)",
          "echo '@realtime - memlock unlimited' >> /etc/security/limits.d/contourd.conf"};
}

Finding Clock(const Computer& c) {
  const auto source = c.Line("sys/devices/system/clocksource/clocksource0/current_clocksource");
  if (!source) return {"clock", Level::kUnknown, "the kernel does not name its clock", ""};
  // Clocks that are read without leaving the processor.
  for (const char* fast : {"tsc", "arch_sys_counter", "kvm-clock"})
    if (*source == fast) return {"clock", Level::kGood, "the clock is " + *source, ""};
  return {"clock", Level::kChange, "the clock is " + *source + ": each look at it takes microseconds",
          "echo tsc > /sys/devices/system/clocksource/clocksource0/current_clocksource"};
}

}  // namespace

std::string_view Name(FindingLevel level) {
  switch (level) {
    case Level::kGood:
      return "good";
    case Level::kAdvice:
      return "advice";
    case Level::kChange:
      return "change";
    case Level::kUnknown:
      return "unknown";
  }
  return "unknown";
}

std::vector<Finding> Examine(const ExaminationRequest& request) {
  const Computer computer(request.root);
  std::vector<Finding> findings{Kernel(computer),
                                Isolation(computer, request.cpu),
                                Throttling(computer),
                                LockupWatchdog(computer, request.cpu),
                                GroupScheduling(computer, request.priority),
                                Governor(computer, request.cpu),
                                Priority(computer, request.priority),
                                MemoryLock(computer),
                                Clock(computer)};
  const auto interfaces = request.interfaces.empty() ? CanInterfaces(computer) : request.interfaces;
  for (const std::string& interface : interfaces) {
    findings.push_back(Queue(computer, interface));
    if (computer.Exists(fs::path("sys/class/net") / interface))
      findings.push_back(Interrupts(computer, interface, request.cpu));
  }
  return findings;
}

}  // namespace contour
