#include "analysis/diagnosis/screening/octave_noise.h"

#include <algorithm>
#include <cstddef>
#include <numbers>

#include "analysis/diagnosis/tuning/screening_tuning.h"

namespace contour::diagnosis {

void OverTheOctave(std::vector<double>& scores) {
  const std::vector<double> raw = scores;
  std::vector<double> octave;
  double above = 1.0;
  for (std::size_t i = 0, renewed = 0; i < raw.size(); ++i) {
    if (i >= renewed) {
      octave.clear();
      // An octave to either side, counted from beyond the next: of the lowest order it is hardly more than
      // it.
      for (std::size_t j = i / 2; j < std::min(raw.size(), 2 * (i + 2)); ++j) octave.push_back(raw[j]);
      // Of few, the lower middle one: half of them may be waves.
      const auto middle = octave.begin() + static_cast<std::ptrdiff_t>((octave.size() - 1) / 2);
      std::nth_element(octave.begin(), middle, octave.end());
      above = std::max(1.0, *middle / (2.0 * std::numbers::ln2));
      renewed = i + 1 + i / static_cast<std::size_t>(kScreening.bins);
    }
    scores[i] /= above;
  }
}

}  // namespace contour::diagnosis
