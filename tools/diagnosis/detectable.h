#pragma once

#include <span>

#include "tools/diagnosis/finding.h"
#include "tools/diagnosis/gate.h"
#include "tools/diagnosis/jitter.h"
#include "tools/diagnosis/score.h"

namespace contour::diagnosis {

/// Fills smallest_detectable and not_excited from the candidates' standard errors: the stated size
/// exceeds the gate in 90 % of cases; one of 1.5 times that passes the other tests as well. A kind whose
/// smallest detectable size is beyond what such an axis can have, or whose signal the log lacks, is not
/// excited.
void KeepDetectable(const Problem& problem, const Fit& base, std::span<const Scored> scored,
                    const Jitter& jitter, const Gate& gate, Diagnosis& out);

}  // namespace contour::diagnosis
