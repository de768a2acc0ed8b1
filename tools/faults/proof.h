#pragma once

#include <string>
#include <vector>

#include "tools/faults/fault_run.h"

namespace contour::faults {

/// What a supervisor is good for: the runs on its fault, with it and without it.
struct Proof {
  const Supervisor* supervisor = nullptr;
  std::vector<RunResult> with;
  std::vector<RunResult> without;
  /// With it every run stops by its reason and holds; without it none does.
  [[nodiscard]] bool holds() const;
};

Proof Prove(const Supervisor& supervisor, const EmulatedMachineFile& file, std::uint64_t seed,
            unsigned threads);
std::vector<Proof> ProveAll(const EmulatedMachineFile& file, std::uint64_t seed, unsigned threads);
std::string ProofsMarkdown(const std::vector<Proof>& proofs);

}  // namespace contour::faults
