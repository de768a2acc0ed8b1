#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>

#include "config/config_error.h"
#include "core/exit_status.h"
#include "tools/faults/campaign.h"
#include "tools/faults/machine_in_mode.h"
#include "tools/faults/options.h"
#include "tools/faults/proof.h"
#include "tools/faults/report.h"
#include "tools/faults/supervisor.h"

namespace contour::faults {
namespace {

void List() {
  std::puts("faults:");
  for (const FaultName& f : kFaults)
    std::printf("  %-26s %s\n", std::string(f.name).c_str(), std::string(f.what).c_str());
  std::puts("phases:");
  for (const Phase p : kPhases) std::printf("  %s\n", std::string(Name(p)).c_str());
  std::puts("supervisors:");
  for (const Supervisor& s : Supervisors())
    std::printf("  %-26s %s\n", std::string(Name(s.watch)).c_str(), std::string(s.what).c_str());
}

void Write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw EnvironmentError("cannot write " + file.string());
}

int Prove(const EmulatedMachineFile& file, const Options& o) {
  const std::vector<Proof> proofs = ProveAll(file, o.plan.seed, o.threads);
  std::fputs(ProofsMarkdown(proofs).c_str(), stdout);
  const bool all = std::all_of(proofs.begin(), proofs.end(), [](const Proof& p) { return p.holds(); });
  return all ? kExitDone : kExitFailed;
}

int Run(const Options& o) {
  const EmulatedMachineFile file = LoadEmulatedMachine(o.config);
  std::vector<PlannedAxis> axes;
  std::vector<double> highest_mm_s;
  for (const auto& [name, axis] : file.machine.axes) {
    axes.push_back({name, axis.limits.velocity_mm_s});
    highest_mm_s.push_back(axis.limits.velocity_mm_s);
  }
  if (o.supervisors) return Prove(file, o);
  const Supervisor* supervisor = FindSupervisor(o.without);
  const bool its_own = supervisor != nullptr && o.plan.only.empty() && o.plan.feed_mm_s == 0.0;
  const std::vector<FaultCase> cases = Plan(its_own ? ProofOf(*supervisor) : o.plan, axes);
  const auto in = [&](DriveMode mode) -> std::optional<EmulatedMachineFile> {
    if (std::none_of(cases.begin(), cases.end(), [mode](const FaultCase& c) { return c.mode == mode; }))
      return {};
    return MachineInMode(o.config, file, mode);
  };
  const std::optional<EmulatedMachineFile> cst = in(DriveMode::kCst), csp = in(DriveMode::kCsp);
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  const auto progress = [&](std::size_t done) {
    if (terminal) std::fprintf(stderr, "\r\x1b[K%zu of %zu runs", done, cases.size());
  };
  const std::vector<RunResult> results = RunCampaign(
      cases, {cst ? &*cst : &file, o.plan.seed, supervisor, supervisor != nullptr, csp ? &*csp : nullptr},
      o.threads, progress);
  if (terminal) std::fputs("\r\x1b[K", stderr);

  const std::vector<Cell> cells = Cells(results, highest_mm_s);
  const std::string failures = Failures(results, o.config, o.plan.seed, o.without);
  if (o.verbose) std::fputs(RunsCsv(results).c_str(), stdout);
  std::fputs(TableText(cells, highest_mm_s).c_str(), stdout);
  std::fputs(failures.c_str(), stdout);
  std::size_t failed = 0;
  for (const RunResult& r : results)
    if (!r.violations.empty()) ++failed;
  std::printf("%zu runs of %s, seed %llu: %zu failed\n", results.size(), o.config.c_str(),
              static_cast<unsigned long long>(o.plan.seed), failed);
  if (!o.out.empty()) {
    const std::filesystem::path out = o.out;
    std::filesystem::create_directories(out);
    Write(out / "table.md", TableMarkdown(cells, highest_mm_s));
    Write(out / "table.csv", TableCsv(cells));
    Write(out / "runs.csv", RunsCsv(results));
    Write(out / "failures.txt", failures);
  }
  return failed == 0 ? kExitDone : kExitFailed;
}

int Main(int argc, char** argv) {
  const Options o = ParseOptions(argc, argv);
  if (o.list) {
    List();
    return kExitDone;
  }
  try {
    return Run(o);
  } catch (const ConfigError& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return kExitBadUsage;
  } catch (const std::invalid_argument& e) {
    std::fprintf(stderr, "contour_faults: %s\n", e.what());
    return kExitBadUsage;
  } catch (const EnvironmentError& e) {
    std::fprintf(stderr, "contour_faults: %s\n", e.what());
    return kExitEnvironment;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "contour_faults: %s\n", e.what());
    return kExitFailed;
  }
}

}  // namespace
}  // namespace contour::faults

int main(int argc, char** argv) { return contour::faults::Main(argc, argv); }
