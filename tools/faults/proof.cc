#include "tools/faults/proof.h"

#include <algorithm>

#include "tools/faults/campaign.h"

namespace contour::faults {
namespace {

bool Failed(const RunResult& r) { return !r.violations.empty(); }

std::size_t CountFailed(const std::vector<RunResult>& runs) {
  return static_cast<std::size_t>(std::count_if(runs.begin(), runs.end(), Failed));
}

std::string FirstViolation(const std::vector<RunResult>& runs) {
  const auto first = std::find_if(runs.begin(), runs.end(), Failed);
  return first == runs.end() ? "" : first->violations.front();
}

std::string Nearer(const Supervisor& s) {
  std::string names;
  for (std::size_t i = 0; i < kWatchCount; ++i) {
    const auto watch = static_cast<Watch>(i);
    if (!s.nearer.Acts(watch)) names += (names.empty() ? "" : ", ") + std::string(Name(watch));
  }
  return names;
}

}  // namespace

bool Proof::holds() const {
  return !with.empty() && CountFailed(with) == 0 && !without.empty() &&
         CountFailed(without) == without.size();
}

Proof Prove(const Supervisor& supervisor, const EmulatedMachineFile& file, std::uint64_t seed,
            unsigned threads) {
  std::vector<PlannedAxis> axes;
  for (const auto& [name, axis] : file.machine.axes) axes.push_back({name, axis.limits.velocity_mm_s});
  PlanRequest plan = ProofOf(supervisor);
  plan.seed = seed;
  const std::vector<FaultCase> cases = Plan(plan, axes);
  return {&supervisor, RunCampaign(cases, {&file, seed, &supervisor, false}, threads, {}),
          RunCampaign(cases, {&file, seed, &supervisor, true}, threads, {})};
}

std::vector<Proof> ProveAll(const EmulatedMachineFile& file, std::uint64_t seed, unsigned threads) {
  std::vector<Proof> proofs;
  for (const Supervisor& s : Supervisors()) proofs.push_back(Prove(s, file, seed, threads));
  return proofs;
}

std::string ProofsMarkdown(const std::vector<Proof>& proofs) {
  std::string text =
      "| supervisor | watches | fault | also off | with it | failed | without it | failed |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const Proof& p : proofs) {
    const Supervisor& s = *p.supervisor;
    const auto of = [](const std::vector<RunResult>& runs) {
      return std::to_string(CountFailed(runs)) + " of " + std::to_string(runs.size());
    };
    const std::string wrong = FirstViolation(p.with);
    text += "| `" + std::string(Name(s.watch)) + "` | " + std::string(s.what) + " | `" +
            std::string(Name(s.fault)) + "," + std::string(Name(s.phase)) + "` | " + Nearer(s) + " | " +
            (wrong.empty() ? "`" + std::string(Name(s.reason)) + "`" : wrong) + " | " + of(p.with) + " | " +
            FirstViolation(p.without) + " | " + of(p.without) + (p.holds() ? "" : " **not shown**") + " |\n";
  }
  return text;
}

}  // namespace contour::faults
