#include "daemon/learning/learnt_program.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace contour {
namespace {

/// Passes differ by so much by themselves.
constexpr double kTolerance = 1.05;
constexpr double kSmallestShareOfGain = 0.125;
constexpr int kLongestRest = 16;
/// An error this many times as large as a shift may be is another fault, not to be made up for.
constexpr double kLargestError = 3.0;
constexpr double kShareOfAcceleration = 0.1;
/// Into and out of the shift at the ends of a program, which are at rest where the axes stand.
constexpr double kFade_s = 0.05;
/// Points at either end that are not shifted at all, so that derivatives are zero there too.
constexpr double kUntouched = 3.0;

double Fade(double points, double length) {
  const double x = std::clamp(points / length, 0.0, 1.0);
  return x * x * x * (10.0 + x * (6.0 * x - 15.0));
}

}  // namespace

LearntProgram::LearntProgram(const LearningConfig& config, double period_s,
                             std::vector<double> acceleration_m_s2)
    : config_(config),
      period_s_(period_s),
      acceleration_m_s2_(std::move(acceleration_m_s2)),
      learnt_(config.bandwidth_Hz, period_s),
      seen_(4.0 * config.bandwidth_Hz, period_s),
      gain_(config.gain) {}

double LearntProgram::Peak_m(const ErrorAcross& seen) const {
  std::vector<float> square;
  for (const std::vector<float>& axis : seen.error_m) {
    const std::vector<float> smooth = seen_.Of(axis);
    square.resize(smooth.size(), 0.0F);
    for (std::size_t k = 0; k < smooth.size(); ++k) square[k] += smooth[k] * smooth[k];
  }
  if (square.empty()) return 0.0;
  return std::sqrt(static_cast<double>(*std::max_element(square.begin(), square.end())));
}

std::string LearntProgram::Learn(ErrorAcross seen) {
  last_peak_m_ = Peak_m(seen);
  if (!(last_peak_m_ <= kLargestError * 1e-6 * config_.largest_um)) {
    best_ = trial_ = nullptr;
    passes_ = 0;
    return "the table was off by " + std::to_string(std::lround(1e6 * last_peak_m_)) +
           " um, more than three times learning.largest_um";
  }
  ++passes_;
  if (passes_ == 1 || trial_ == best_) {
    best_error_ = std::move(seen);  // what it is worth by now: machines change
    best_peak_m_ = last_peak_m_;
  } else if (last_peak_m_ <= (rest_ == 0 ? kTolerance : 1.0) * best_peak_m_) {
    best_ = trial_;
    best_error_ = std::move(seen);
    // The lowest, not the last: else a little worse each time would be let through without end.
    best_peak_m_ = std::min(best_peak_m_, last_peak_m_);
    gain_ = std::min(config_.gain, 1.5 * gain_);
    rest_ /= 2;
  } else {
    gain_ = std::max(0.5 * gain_, kSmallestShareOfGain * config_.gain);
    rest_ = std::clamp(2 * rest_, 1, kLongestRest);
    left_ = rest_;
  }
  trial_ = left_ > 0 ? best_ : Improved();
  left_ = std::max(0, left_ - 1);
  return {};
}

std::shared_ptr<const PathOffsets> LearntProgram::Improved() const {
  auto next = std::make_shared<PathOffsets>();
  next->period_s = period_s_;
  const auto late = static_cast<std::ptrdiff_t>(std::lround(best_error_.late_s / period_s_));
  for (std::size_t i = 0; i < best_error_.error_m.size(); ++i) {
    const std::vector<float>& error_m = best_error_.error_m[i];
    const auto points = static_cast<std::ptrdiff_t>(error_m.size());
    std::vector<float> shift_m(error_m.size());
    for (std::ptrdiff_t k = 0; k < points; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const double before_m = best_ ? best_->At(i, at) : 0.0;
      const bool known = k + late >= 0 && k + late < points;
      const double error = known ? static_cast<double>(error_m[static_cast<std::size_t>(k + late)]) : 0.0;
      shift_m[at] = static_cast<float>(before_m + gain_ * error);
    }
    shift_m = learnt_.Of(shift_m);
    Bound(shift_m, acceleration_m_s2_[i]);
    next->offset_m.push_back(std::move(shift_m));
  }
  return next;
}

void LearntProgram::Bound(std::vector<float>& shift_m, double acceleration_m_s2) const {
  const auto n = static_cast<double>(shift_m.size());
  const double length = kFade_s / period_s_, most_m = 1e-6 * config_.largest_um;
  for (std::size_t k = 0; k < shift_m.size(); ++k) {
    const auto at = static_cast<double>(k);
    const double fade = Fade(at - kUntouched, length) * Fade(n - 1.0 - kUntouched - at, length);
    const double bounded_m = std::clamp(static_cast<double>(shift_m[k]), -most_m, most_m);
    shift_m[k] = static_cast<float>(fade * bounded_m);
  }
  double largest = 0.0;
  for (std::size_t k = 1; k + 1 < shift_m.size(); ++k)
    largest = std::max(largest,
                       std::abs(static_cast<double>(shift_m[k + 1]) - 2.0 * static_cast<double>(shift_m[k]) +
                                static_cast<double>(shift_m[k - 1])));
  const double allowed = kShareOfAcceleration * acceleration_m_s2 * period_s_ * period_s_;
  if (largest <= allowed) return;
  for (float& s : shift_m) s = static_cast<float>(static_cast<double>(s) * allowed / largest);
}

}  // namespace contour
