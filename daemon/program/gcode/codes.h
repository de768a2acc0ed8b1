#pragma once

#include <cstddef>
#include <string>

namespace contour {

/// Modal groups of G and M codes: one code of each may stand in a block.
enum GGroup : std::size_t {
  kNonModal,  ///< G4 G10 G28 G30 G52 G53 G92...
  kMotion,
  kPlane,
  kDistance,
  kCentreDistance,
  kFeedMode,
  kUnits,
  kCutterCompensation,
  kToolLength,
  kRetract,
  kCoordinateSystem,
  kPathControl,
  kSpindleMode,
  kLatheMode,
  kGGroups,
};
enum MGroup : std::size_t { kStopping, kToolChange, kSpindle, kCoolant, kOverride, kMGroups };

inline constexpr int kNoCode = -1;
inline constexpr int kNoMotion = 800;  ///< G80, of the group of motions, tenfold

/// A code as it may stand in a program; tenfold, so that G61.1 is 611.
struct CodeGroup {
  bool known = false;
  std::size_t group = 0;
  const char* refused = nullptr;  ///< known elsewhere but not here: what it would ask for
};
CodeGroup GroupOfG(int tenfold);
CodeGroup GroupOfM(int number);

/// "G61.1".
std::string NameOfG(int tenfold);

}  // namespace contour
