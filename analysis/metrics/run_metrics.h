#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/metrics/scored_row.h"
#include "daemon/program/motion_plan.h"

namespace contour {

/// Contour errors seen at one place, the encoder or the table. Empty where they have no meaning.
struct ContourMetrics {
  std::optional<double> rms_um;
  std::optional<double> peak_um;
  std::optional<double> circular_deviation_um;
  std::optional<std::array<double, 4>> quadrant_peak_um;  ///< at +X, +Y, -X, -Y
};

struct AxisMetrics {
  std::string axis;
  std::optional<double> friction_estimate_error_rms_N;
  double torque_saturated_fraction = 0.0;        ///< of all cycles of the program
  std::optional<double> following_error_rms_um;  ///< at the encoder
  std::optional<double> following_error_peak_um;
  std::optional<double> encoder_pp_counts;  ///< hold only
};

struct RunMetrics {
  ContourMetrics encoder;
  ContourMetrics table;
  std::vector<AxisMetrics> axes;
  std::optional<double> encoder_pp_counts;  ///< hold only: of the worst axis
  std::uint64_t scored_cycles = 0;
};

/// An axis's name and resolution.
struct ScoredAxisFacts {
  std::string name;
  double encoder_count_m = 0.0;  ///< travel of the table per encoder count
};

/// Scores a run of a program, row by row: see docs/metrics.md.
class RunScorer {
 public:
  RunScorer(std::shared_ptr<const MotionPlan> plan, std::vector<ScoredAxisFacts> axes);

  /// Rows in order of time. Rows before the start, and those after the first at the end, are not counted.
  void Add(const ScoredRow& row);

  [[nodiscard]] RunMetrics Finish() const;

 private:
  struct Place {
    double sum_squared_m2 = 0.0;
    double peak_m = 0.0;
    std::uint64_t count = 0;
    std::array<double, 4> quadrant_peak_m{};
    std::vector<std::array<double, 2>> points_m;  ///< circles: about the commanded centre
  };
  struct Axis {
    double friction_squared_N2 = 0.0;
    std::uint64_t friction_count = 0;
    std::uint64_t saturated = 0;
    double following_squared_m2 = 0.0;
    double following_peak_m = 0.0;
    double lowest_m = 0.0;  ///< hold: over its last part
    double highest_m = 0.0;
    std::uint64_t held = 0;
  };

  void AddContour(const PerAxis<double>& position_m, Place& place) const;
  void AddAxis(const ScoredAxis& from, bool scored, bool held, Axis& to);
  [[nodiscard]] ContourMetrics FinishContour(const Place& place) const;

  std::shared_ptr<const MotionPlan> plan_;
  std::optional<CommandedCircle> circle_;
  std::vector<ScoredAxisFacts> facts_;
  std::vector<Axis> axes_;
  Place encoder_;
  Place table_;
  std::uint64_t rows_ = 0;
  std::uint64_t scored_ = 0;
  double last_path_time_s_ = -1.0;
};

}  // namespace contour
