#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "analysis/diagnosis/decision/score_threshold.h"
#include "analysis/diagnosis/result/finding.h"
#include "analysis/diagnosis/screening/jitter.h"
#include "analysis/diagnosis/screening/score.h"

namespace contour::diagnosis {

/// What screening saw in addition to the causes that are accepted.
struct Screened {
  std::span<const Scored> scored;
  const Jitter& jitter;
  const ScoreThreshold& threshold;
};

/// Of each kind that the log would show: its main parameter, and the smallest that is found in 90 % of cases.
/// What exceeds the threshold by the candidates' standard errors, by the stated uncertainties where these
/// decide, or by runs where a kind is far from linear, times what it takes to pass the other tests as well. A
/// kind for which the threshold alone asks for more than such an axis can have, or whose signal the log
/// lacks, is missing. `only`: of these kinds; empty: of all.
std::map<std::string, std::map<std::string, double>> SmallestDetectable(const Problem& problem,
                                                                        const Fit& base,
                                                                        const Screened& screened,
                                                                        std::span<const std::string> only);

/// The kinds that are not in there.
std::vector<std::string> NotExcited(const std::map<std::string, std::map<std::string, double>>& detectable);

}  // namespace contour::diagnosis
