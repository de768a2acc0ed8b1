#pragma once

#include <vector>

#include "analysis/axis_model/axis_model.h"

namespace contour::diagnosis {

/// One element per row as two per row.
Signal Doubled(const Signal& s);

/// A wave between rows and the one a quarter period on, best straight line over each row: at high speed it
/// turns far from row to row. `phase` per row, `size` of the wave per row or empty. Two elements per row.
std::vector<SharedSignal> WaveSignals(const std::vector<double>& phase, const std::vector<double>& size);

}  // namespace contour::diagnosis
