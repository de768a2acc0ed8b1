#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "control/oscillation_detector.h"
#include "core/cycle_record.h"
#include "daemon/rt/cycle_config.h"

namespace contour {

/// In csp a drive closes the loop, and whether it is stable is not for the cycle to mend. This tells an
/// operator of a loop that goes on swinging while its set-point rests, and by how much. One thread consumes,
/// any thread asks.
class RestSwing {
 public:
  explicit RestSwing(const CycleConfig& config);

  /// Every cycle, in order.
  void Consume(const CycleRecord& record);
  /// A sentence for each axis that swung when it was last seen at rest.
  [[nodiscard]] std::vector<std::string> warnings() const;
  /// What has begun since it was last asked for, for the text log.
  [[nodiscard]] std::vector<std::string> TakeNew();

 private:
  /// From the lowest to the highest, since it was restarted.
  class Span {
   public:
    void Restart(double value) noexcept { least_ = most_ = value; }
    void See(double value) noexcept;
    [[nodiscard]] double size() const noexcept { return most_ - least_; }
    [[nodiscard]] double middle() const noexcept { return 0.5 * (most_ + least_); }

   private:
    double least_ = 0.0, most_ = 0.0;
  };
  struct Swing {
    double position_m = 0.0;  ///< from peak to peak
    double frequency_Hz = 0.0;
  };
  struct Axis {
    std::string name;
    double radius_m_rad = 0.0;
    double count_m = 0.0;
    OscillationBounds bounds;
    OscillationDetector detector;
    bool rests = false;
    double reference_m = 0.0;
    Span position_m{}, target_m{};
    double middle_m = 0.0;         ///< of the position, as it was found last
    bool above = false;            ///< of that
    std::uint32_t crossings = 0;   ///< of that
    std::uint64_t since = 0;       ///< cycle in which what is measured began
    bool told = false;             ///< which is when the detector last told of a swing
    std::uint64_t told_since = 0;  ///< again and again
    std::optional<Swing> swing{};
  };
  void Look(Axis& axis, const AxisRecord& record, std::uint64_t cycle);
  static void Restart(Axis& axis, const AxisRecord& record, std::uint64_t cycle);
  static std::string Sentence(const Axis& axis);

  std::vector<Axis> axes_;
  mutable std::mutex mutex_;  ///< guards what follows, and `swing` of axes_
  std::vector<std::string> new_;
};

}  // namespace contour
