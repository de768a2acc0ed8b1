#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/machine/load_emulated_machine.h"
#include "tools/validation/hidden/hidden_case.h"

namespace contour::hidden {

/// Puts the effect into the emulated axis x. `duration_s`: of the log, `begin_s`: the machine's time at which
/// it begins (bring-up and enabling lie before).
void HideEffect(const Hidden& hidden, const Setting& setting, double begin_s, double duration_s,
                EmulatedAxisConfig& axis);

/// The parameters that an answer must hold within its intervals, by the catalogue's names. Over the log means
/// against its beginning, the largest speed is that within the log.
std::map<std::string, double> TruthOf(const Hidden& hidden, const LogSpan& span);

/// Largest size that still is a machine.
double LargestSize(const Hidden& hidden);

/// Effects that no kind of the catalogue describes.
const std::vector<std::string>& OutsideKinds();

}  // namespace contour::hidden
