#pragma once

#include <cstddef>

#include "core/visit.h"

namespace contour {

inline constexpr std::size_t kMostSideModes = 2;  ///< of one axis
inline constexpr double kMostSwinging = 0.9;      ///< share of the table on springs

/// A part of the table that swings on a spring beside the screw: a bed that rocks, a head that nods
/// (`model.side_modes`).
struct SideMode {
  double frequency_Hz = 0.0;
  double mass_share_rel = 0.0;
  double damping_ratio = 0.02;
  double frequency_std_rel = 0.05;

  friend bool operator==(const SideMode&, const SideMode&) = default;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("frequency_Hz", frequency_Hz, Range{1.0, 5000.0}, "of the part on its spring, the table held");
    v.Required("mass_share_rel", mass_share_rel, Range{0.0, 0.9, true}, "of table_mass_kg");
    v.Optional("damping_ratio", damping_ratio, Range{0.0, 1.0}, "of the part on its spring");
    v.Optional("frequency_std_rel", frequency_std_rel, Range{0.0, 0.5},
               "relative standard deviation of its frequency");
  }
};

}  // namespace contour
