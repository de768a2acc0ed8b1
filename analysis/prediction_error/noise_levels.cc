#include "analysis/prediction_error/noise_levels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/diagnosis/tuning/prediction_tuning.h"

namespace contour::diagnosis {
namespace {

/// What a torque of two more numbers has to gain in -2 log likelihood (Akaike).
constexpr double kTwoNumbers = 4.0;
/// [rows] What remembers longer than the colour filter reaches passes for noise where a cause is missing: a
/// force or a level of friction that the model lacks is as constant.
constexpr auto kLongestMemory = static_cast<double>(kNoise.whitener_order);
/// [rows] A torque that forgets sooner is as good as white.
constexpr double kShortestMemory = 2.0;

class Search {
 public:
  Search(const LinearModel& model, const LevelsSearch& by) : model_(model), by_(by) {
    // Some segments all over the log are enough for few numbers.
    const std::size_t n = model.rows;
    length_ = std::min(n / kNoise.segments, std::max(n / kNoise.segments_of_log, kNoise.segment_rows));
  }

  NoiseLevels From(const NoiseLevels* before) {
    if (before != nullptr)
      Look(by_.slow_torque ? *before : NoiseLevels{.log10_torque = before->log10_torque});
    else
      for (double x = -4.5; x <= 4.6; x += 1.5) Look({.log10_torque = x});
    for (const double step : {0.75, 0.375, 0.19, 0.09}) Around(&NoiseLevels::log10_torque, step);
    if (!by_.slow_torque) return best_;
    AddSlow();
    DropSlow();
    return best_;
  }

 private:
  void Look(const NoiseLevels& l) {
    const double shortest = std::log10(kShortestMemory), longest = std::log10(kLongestMemory);
    if (l.slow_there && (l.log10_memory_rows < shortest || l.log10_memory_rows > longest)) return;
    const double unlikely = UnlikelyAt(l);
    if (!(unlikely < lowest_)) return;
    lowest_ = unlikely;
    best_ = l;
  }

  [[nodiscard]] double UnlikelyAt(const NoiseLevels& l) const {
    const std::size_t apart = model_.rows - length_;
    LikelihoodSums sums;
    for (std::size_t i = 0; i < kNoise.segments; ++i) {
      const std::size_t from = apart * i / (kNoise.segments - 1);
      KalmanPass({model_, by_.counted, by_.period_s, from, from + length_},
                 VariancesOf(l, by_.reading, by_.unit), sums, nullptr);
    }
    return sums.Unlikely() + (l.slow_there ? kTwoNumbers : 0.0);
  }

  void Around(double NoiseLevels::*number, double step) {
    for (const double by : {-step, step}) {
      NoiseLevels l = best_;
      l.*number += by;
      Look(l);
    }
  }

  /// A grid of the torque that is not there yet, then from the best point of it.
  void AddSlow() {
    if (!best_.slow_there) {
      const double torque = best_.log10_torque - 0.1;
      for (double memory = std::log10(kLongestMemory); memory > std::log10(kShortestMemory); memory -= 0.4)
        for (const double slow : {0.5, 1.2, 1.9, 2.6}) Look({torque, true, slow, memory});
    }
    if (!best_.slow_there) return;
    for (const double step : {0.4, 0.2, 0.1})
      for (double NoiseLevels::*number :
           {&NoiseLevels::log10_slow, &NoiseLevels::log10_memory_rows, &NoiseLevels::log10_torque})
        Around(number, step);
  }

  void DropSlow() {
    if (best_.slow_there) Look({.log10_torque = best_.log10_torque});
  }

  const LinearModel& model_;
  const LevelsSearch& by_;
  std::size_t length_ = 0;
  NoiseLevels best_;
  double lowest_ = std::numeric_limits<double>::infinity();
};

}  // namespace

NoiseVariances VariancesOf(const NoiseLevels& levels, double reading, double unit) {
  NoiseVariances out;
  out.reading = reading;
  out.torque = reading * unit * unit * std::pow(10.0, levels.log10_torque);
  if (!levels.slow_there) return out;
  out.keep = std::exp(-std::pow(10.0, -levels.log10_memory_rows));
  // Of a first-order noise of unit variance the density at 0 Hz is (1 + keep) / (1 - keep) that of white one.
  out.slow = out.torque * std::pow(10.0, levels.log10_slow) * (1.0 - out.keep) / (1.0 + out.keep);
  return out;
}

NoiseLevels LikeliestLevels(const LinearModel& model, const LevelsSearch& search, const NoiseLevels* before) {
  return Search(model, search).From(before);
}

}  // namespace contour::diagnosis
