#pragma once

#include <span>
#include <string>

#include "analysis/diagnosis/decision/gate.h"
#include "analysis/diagnosis/result/finding.h"
#include "analysis/diagnosis/screening/jitter.h"
#include "analysis/diagnosis/screening/score.h"

namespace contour::diagnosis {

/// Fills smallest_detectable and not_excited: what exceeds the gate in 90 % of cases, by the candidates'
/// standard errors, by the stated uncertainties where these decide, or by runs where a kind is far from
/// linear, times what it takes to pass the other tests as well. A kind for which the gate alone asks for more
/// than such an axis can have, or whose signal the log lacks, is not excited.
/// Beside causes that are accepted: once more, for the others.
/// `only`: of these kinds; empty: of all.
void KeepDetectable(const Problem& problem, const Fit& base, std::span<const Scored> scored,
                    const Jitter& jitter, const Gate& gate, std::span<const std::string> only,
                    Diagnosis& out);

}  // namespace contour::diagnosis
