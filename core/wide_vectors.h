#pragma once

/// Before a function of plain loops, or of much plain arithmetic, which takes fewer instructions with three
/// operands: it is translated twice, for the baseline and for processors with AVX2,
/// and the program takes the one that fits when it is loaded. There is no contraction and no reordering, so
/// both give the same bits. Sanitizers are not up yet when the choice is made, so their builds have the
/// baseline only.
#ifdef CONTOUR_BASELINE_VECTORS
#define CONTOUR_WIDE_VECTORS
#else
#define CONTOUR_WIDE_VECTORS [[gnu::target_clones("avx2", "default")]]
#endif
