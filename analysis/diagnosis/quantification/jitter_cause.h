#pragma once

#include "analysis/diagnosis/result/finding.h"
#include "analysis/diagnosis/screening/jitter.h"

namespace contour::diagnosis {

/// What the jitter test scored: its drop less a penalty.
double ScoreOf(const Jitter& jitter);

/// Adds readings at uncertain instants to the causes. They are in no fit: they have no mean effect.
void AcceptJitter(const Problem& problem, const Fit& nominal, const Jitter& jitter, Diagnosis& out);

}  // namespace contour::diagnosis
