#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "config/learning_config.h"
#include "daemon/learning/error_across.h"
#include "daemon/learning/smoothing.h"
#include "daemon/program/path_offsets.h"

namespace contour {

/// Iterative learning of one program. With u the shift of the reference on the best pass so far, e its error
/// and d the time by which the table is late, the next pass tries
///
///     u'(t) = Q [ u(t) + gain e(t + d) ],
///
/// Q without phase, within bounds, nothing at either end of the program. A pass that is worse than the best
/// is not built upon: the best is run again, once, and twice as often each time that happens, before a step
/// of half the size is tried from it.
class LearntProgram {
 public:
  /// `acceleration_m_s2`: limits of the axes; a shift takes a tenth of them at most.
  LearntProgram(const LearningConfig& config, double period_s, std::vector<double> acceleration_m_s2);

  /// What the next pass is to be shifted by; null before anything has been learnt.
  [[nodiscard]] std::shared_ptr<const PathOffsets> next() const { return trial_; }
  /// The pass that followed next() is over. Gives why nothing is learnt from it, and all is forgotten; empty:
  /// it is.
  std::string Learn(ErrorAcross seen);

  [[nodiscard]] std::size_t passes() const { return passes_; }
  /// Largest error across the path, without what is faster than four times the bandwidth.
  [[nodiscard]] double last_peak_m() const { return last_peak_m_; }
  [[nodiscard]] double best_peak_m() const { return best_peak_m_; }

 private:
  [[nodiscard]] double Peak_m(const ErrorAcross& seen) const;
  [[nodiscard]] std::shared_ptr<const PathOffsets> Improved() const;
  void Bound(std::vector<float>& shift_m, double acceleration_m_s2) const;

  LearningConfig config_;
  double period_s_;
  std::vector<double> acceleration_m_s2_;
  Smoothing learnt_, seen_;
  std::shared_ptr<const PathOffsets> best_, trial_;
  ErrorAcross best_error_;
  double gain_;
  double best_peak_m_ = 0.0;
  double last_peak_m_ = 0.0;
  int rest_ = 0;  ///< passes of the best after a trial that was worse
  int left_ = 0;  ///< of them
  std::size_t passes_ = 0;
};

}  // namespace contour
