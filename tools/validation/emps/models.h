#pragma once

#include <string>
#include <vector>

#include "tools/validation/emps/fit_free_run.h"

namespace contour::emps {

struct ScoredModel {
  std::string name;
  Parameters parameters;
  double first_m = 0.0, second_m = 0.0, pulses_m = 0.0;  ///< 1 s free-run RMSE
};

inline constexpr Segment kFirstHalf{100, 12420};
inline constexpr Segment kSecondHalf{12420, 24700};
inline constexpr Segment kWhole{100, 24700};

/// As published: symmetric, and asymmetric.
Parameters AuthorsSymmetric();
Parameters AuthorsAsymmetric();

/// Free-run windows of the fits: two seconds, twice what is scored.
inline constexpr std::size_t kFitWindow = 2000;

/// Parameters that a fit may change, from fewer to more.
std::vector<Free> DirectionTerms();
std::vector<Free> StrokeTerms();
std::vector<Free> StribeckTerms();

ScoredModel Score(std::string name, const Parameters& p, const Recording& train, const Recording& pulses);

}  // namespace contour::emps
