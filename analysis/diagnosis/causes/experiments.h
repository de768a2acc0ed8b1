#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/diagnosis/causes/cause_definition.h"

namespace contour::diagnosis {

// What decides between the causes of a family. `among_couplings`: an elastic coupling is one of them.
Experiment TorqueStepsFromRest(const Problem& problem, bool among_couplings);
Experiment GrowingReversals(const Problem& problem, bool among_couplings);
/// Growing reversals do not tell presliding or play from a coupling.
Experiment GrowingReversalsOrNone(const Problem& problem, bool among_couplings);
Experiment GrowingReversalsOrChirp(const Problem& problem, bool among_couplings);
Experiment FullStrokes(const Problem& problem, bool among_couplings);
Experiment SameStretchAtThreeSpeeds(const Problem& problem, bool among_couplings);
Experiment SameStrokesWarmAndCold(const Problem& problem, bool among_couplings);
Experiment FiveSpeedsAndPulses(const Problem& problem, bool among_couplings);
Experiment ChirpWhileCreeping(const Problem& problem, bool among_couplings);
Experiment OtherAxisMoves(const Problem& problem, bool among_couplings);
Experiment SeveralConstantSpeeds(const Problem& problem, bool among_couplings);

/// What would tell a cause from other candidate hypotheses, or show it better, within the stroke and torque
/// of the log.
Experiment DecidingExperiment(const Problem& problem, std::string_view kind,
                              const std::vector<std::string>& hypotheses);

/// For people: shows more of what depends on a quantity and has no name.
std::string ExperimentOn(const Problem& problem, Quantity quantity);

}  // namespace contour::diagnosis
