#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace contour::diagnosis::test {

struct Motion {
  std::vector<double> table_m, velocity_m_s, acceleration_m_s2;
  std::vector<double> dither_rel;  ///< of rated, added to the command
  std::vector<double> axis2_m, axis2_m_s2;
};

/// Creep, sweeps over the stroke at several speeds, reversals of several amplitudes, multisine, quick moves,
/// and all of it again in another order until the rows are full.
Motion MakeMotion(std::size_t rows, double period_s, double half_stroke_m, std::uint64_t seed);

}  // namespace contour::diagnosis::test
