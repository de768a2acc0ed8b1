#pragma once

#include <string>
#include <vector>

#include "analysis/diagnosis/result/finding.h"
#include "tools/improve/working_space.h"

namespace contour::improve {

/// What a diagnosis leaves open, in a sentence; empty where it is decided: causes found, and those that have
/// a tenth of the evidence or more with a gain on unseen data that is beyond doubt and no other that the log
/// cannot tell from them.
std::string WhatIsOpen(const diagnosis::Diagnosis& found);

/// Programs that decide between causes that a record does not tell apart: those that the causes name, each
/// once, and not one of `done`.
std::vector<ProgramText> DecidingPrograms(const diagnosis::Diagnosis& found,
                                          const std::vector<ProgramText>& done);

/// Those of `programs` that are not among `done`.
std::vector<ProgramText> NotYetRun(const std::vector<ProgramText>& programs,
                                   const std::vector<ProgramText>& done);

/// What can be run of `programs` inside the space and within `time_s` of machine time, in their order; why
/// not of the others is added to `left_out`.
std::vector<Placed> Runnable(const std::vector<ProgramText>& programs, const WorkingSpace& space,
                             const PerAxis<PlanLimits>& limits, const PerAxis<double>& middle_m,
                             double time_s, std::vector<std::string>& left_out);

}  // namespace contour::improve
