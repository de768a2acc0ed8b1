#pragma once

#include <cstddef>
#include <vector>

namespace contour::diagnosis {

/// Whether a row's value lies far beyond those of the whole log, and of the rows about it: a wrong reading is
/// rare, and larger than anything near it. In addition to both, some counts of the encoder.
class StandsOut {
 public:
  StandsOut(const std::vector<double>& values, double position_step);
  bool operator()(std::size_t row);

 private:
  double LevelNear(std::size_t row);

  const std::vector<double>& values_;
  double counts_;
  double level_ = 0.0;  ///< of the whole log
  std::vector<double> scratch_;
};

}  // namespace contour::diagnosis
