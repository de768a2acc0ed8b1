#pragma once

namespace contour::diagnosis {

struct Lanes;
struct LaneColumns;
struct LaneWhiten;
struct LaneProducts;
struct LaneLikelihood;

/// One translation of the loops. Those for AVX2 and AVX-512 multiply and add in one rounding and give the
/// same bits; the baseline differs from them by rounding.
struct LaneLoops {
  void (*run)(const Lanes& m);
  /// Two bundles of one shape over the same rows, faster than one after the other. Where both are
  /// linearised, the lanes that are not moved are the same.
  void (*run_both)(const Lanes& a, const Lanes& b);
  void (*columns)(const LaneColumns& m);
  void (*whiten)(const LaneWhiten& m);
  void (*products)(const LaneProducts& m);
  void (*likelihood)(LaneLikelihood& m);
  int abreast;  ///< lanes that cost no more than one
};

extern const LaneLoops kBaselineLoops, kAvx2Loops, kAvx512Loops;
bool HasAvx2();
bool HasAvx512();

/// The fastest that this machine has.
const LaneLoops& BestLoops();

}  // namespace contour::diagnosis
