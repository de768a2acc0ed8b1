#pragma once

#include <functional>
#include <vector>

namespace contour {

/// What a search found.
struct SearchResult {
  std::vector<double> best;
  double cost = 0.0;
  int evaluations = 0;
};

/// Smallest cost in the unit box by Nelder and Mead's simplex (The Computer Journal 7(4), 1965), points
/// outside put back on the border. A simplex that has shrunk to a point is set up anew, smaller, around the
/// best. Ends when `evaluations` are spent: the budget is the only criterion, so that it is the same for all.
/// No random numbers: the same function gives the same result.
SearchResult SimplexSearch(const std::function<double(const std::vector<double>&)>& cost,
                           std::vector<double> start, int evaluations);

}  // namespace contour
