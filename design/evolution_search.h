#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "design/simplex_search.h"

namespace contour {

struct EvolutionOptions {
  double first_step = 0.1;  ///< standard deviation of the first points about the start, in the unit box
  int evaluations = 400;
  int population = 0;      ///< points of a generation; 0: Hansen's default, 4 + 3 ln n
  std::uint64_t seed = 1;  ///< the same seed gives the same result on every machine
};

/// Smallest cost in the unit box by adaptation of the covariance of a normal distribution (CMA-ES: Hansen,
/// arXiv:1604.00772, with its default parameters). For costs with narrow curved valleys of up to some twenty
/// parameters. A point outside of the box counts as the nearest one on its border and a little more, by how
/// far it is.
SearchResult EvolutionSearch(const std::function<double(const std::vector<double>&)>& cost,
                             const std::vector<double>& start, const EvolutionOptions& options);

/// Random numbers that are the same on every machine: uniform in [0, 1), and normal.
class PortableRandom {
 public:
  explicit PortableRandom(std::uint64_t seed) noexcept : state_(seed) {}
  double Uniform() noexcept;
  double Normal() noexcept;

 private:
  std::uint64_t state_;
};

}  // namespace contour
