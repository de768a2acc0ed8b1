#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "analysis/diagnosis/result/finding.h"
#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

/// What the fit of a block has not seen: nothing is left out, the block, or the block with those next to it,
/// as many as a scale wanders for.
enum class LeftOut { kNothing, kBlock, kNeighbours };

/// What the white residual loses in blocks of time, over the root of the sum of squares per block: 1 where a
/// single block carries it. In blocks that the fit has not seen (to first order) about standard normal, or
/// less, where there is no effect.
double Consistency(const Problem& problem, const Fit& without, const Fit& with, LeftOut left_out);

/// Gain of `with` over `without` on blocks that the fit did not see (two interleaved folds; parameters of
/// each fold by one Gauss-Newton step from the whole fit, then run anew), 95 % interval by a bootstrap of the
/// blocks. Numbers of the base that the last effect of `with` frees are where they are stated without it.
/// False: what a cause of this kind is asked for, torque, is lost in some blocks that have most of it, though
/// most blocks gain or the cause is a play, and the gain told is that of the rows as multiples of their
/// noise.
bool HeldOutGain(const Problem& problem, const Fit& without, const Fit& with, bool scale, Cause& cause,
                 std::vector<BlockGain>& blocks);

/// Whether most places that the log comes to are seen in both folds by which a cause on the scale is judged.
/// Of a log that goes along the stroke once, one fold foresees nothing of where the other is.
bool FoldsShareTheStroke(const Problem& problem);

/// Whether more than half of them gain.
inline bool MostGain(const std::vector<BlockGain>& blocks) {
  const auto gain =
      std::count_if(blocks.begin(), blocks.end(), [](const BlockGain& b) { return b.gain > 0.0; });
  return 2 * static_cast<std::size_t>(gain) > blocks.size();
}

}  // namespace contour::diagnosis
