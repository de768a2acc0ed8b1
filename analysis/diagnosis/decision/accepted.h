#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "analysis/diagnosis/decision/hypothesis.h"
#include "analysis/diagnosis/decision/score_threshold.h"
#include "analysis/diagnosis/result/diagnose_options.h"
#include "analysis/diagnosis/result/finding.h"

namespace contour::diagnosis {

/// What is in the model so far, and what it leaves behind.
struct Accepted {
  Fit fit;                          ///< base and accepted effects
  std::vector<std::size_t> places;  ///< of the causes in the fit, jitter left out
  std::vector<double> scatter;      ///< of their residuals from block to block, over white noise's
  double explained = 0.0;           ///< drop by what is accepted
  double in_presliding = 0.0;       ///< by an element in presliding
  double leakage = 0.0;             ///< what of their scores may look like other causes
  std::map<std::string, double> leakage_of_kind;
  bool play_is_bound = false;   ///< a quicker observer does not see the play that a slow one makes smaller
  Point by_slow_observer = {};  ///< where a quicker one was taken for a play: the fit before; else empty
};

/// What a score must exceed in addition to what is accepted.
ScoreThreshold ScoreThresholdOf(const Problem& problem, const Accepted& accepted,
                                std::span<const Scored> scored, double by_extras,
                                const DiagnoseOptions& options);

/// By which the deviations of the last effect are larger, squared: its residual's scatter from block to block
/// over white noise's, and that most effects show in a few strokes only.
double ScatterOfLast(const Problem& problem, const Fit& fit);

/// Takes the first of the hypotheses into the model and says so in `out`: its cause, what cannot be told from
/// it, the experiment that would decide.
void AcceptFirst(const Problem& problem, const std::vector<Hypothesis>& hypotheses,
                 const ScoreThreshold& threshold, Accepted& accepted, Diagnosis& out);

/// Takes a cause back, the one at `in_fit` among those that are in the fit: out of all lists of `accepted`
/// and `out`, not out of a fit. The cause comes back.
Cause TakeBack(std::size_t in_fit, Accepted& accepted, Diagnosis& out);

/// Of hypotheses whose first is from outside the catalogue: the best known one that holds in its place,
/// described by its own fit.
void KeepLeadingKnown(const Problem& problem, const Fit& current, const ScoreThreshold& threshold,
                      const std::vector<Hypothesis>& hypotheses, std::vector<Cause>& leading);

}  // namespace contour::diagnosis
