#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace contour {

/// A key split where its unit begins: "lead_mm" is {"lead", "mm"}, "sigma0_N_m" is {"sigma0", "N_m"},
/// "seed" is {"seed", ""}. In a unit `_` means per.
struct KeyParts {
  std::string stem;
  std::string unit;
};
KeyParts SplitUnit(std::string_view key);

/// The unit as people write it: "N_m" is "N/m", "mm_s2" is "mm/s^2", "kgm2" is "kg m^2".
std::string UnitText(std::string_view unit);

/// The known key that an unknown one most likely stands for.
struct KeyHint {
  std::string key;          ///< empty: nothing is near
  bool other_unit = false;  ///< the same quantity in another unit
};
KeyHint NearestKey(std::string_view unknown, const std::vector<std::string>& known);

}  // namespace contour
