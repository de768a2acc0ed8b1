#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <span>
#include <tuple>
#include <vector>

#include "analysis/axis_model/axis_model.h"
#include "analysis/prediction_error/excerpt.h"
#include "analysis/recording/axis_log.h"

namespace contour::diagnosis {

/// Correction of each state per unit of innovation: motor position, motor velocity, load position, velocity.
using ObserverGain = std::array<double, 4>;

/// Steady-state Kalman gain of the linear nominal plant (friction's viscous part only) for a bandwidth.
ObserverGain SteadyObserverGain(const AxisModel& nominal, double period_s, double bandwidth_Hz);

/// What a run gives, one element per row.
struct FilterRun {
  std::vector<double> innovation;      ///< measured minus predicted position; 0 at masked rows
  std::vector<double> table_position;  ///< q of the body that carries the table, after the correction
  std::vector<double> velocity;        ///< of the body that carries the friction, after the correction
  std::vector<double> friction;        ///< LuGre force without its viscous part, at the row
};

/// What the drive delivers of the logged command: the hold, the pure delay, the first-order lag, all exact.
struct Delivered {
  std::vector<double> mean;  ///< over every sub-step of every row
  /// Per sub-step of every row, too: what the delivered torque moves a unit inertia beyond what its mean
  /// does, because it is not constant inside the sub-step: the integral of (h/2 - t) u(t) dt. Without it the
  /// model shifts some 30 us from lag to delay.
  std::vector<double> late;
};

/// What the means are of: delay and lag in seconds, sub-steps a row.
using DeliveredKey = std::tuple<double, double, int>;

/// Arrays that runs need and leave again: fresh memory costs as much as filling it does, and the next runs
/// often need what the last ones left.
class DeliveredStore {
 public:
  /// What is left of this key; `whole`: of the whole log, else it is not kept for that.
  bool Find(const DeliveredKey& key, bool whole, Delivered& out);
  /// What has been of no use for longest, to be filled.
  Delivered Take();
  void Give(const DeliveredKey& key, bool whole, Delivered used);

 private:
  struct Left {
    DeliveredKey key;
    bool whole;
    Delivered means;
  };
  std::mutex mutex_;
  std::deque<Left> left_;  // last given last
};

/// Vectors of rows for runs and what is made of them, for the same reason: nothing is filled with zeros
/// first.
class RowStore {
 public:
  /// Of any content.
  std::vector<double> Take(std::size_t size);
  void Give(std::vector<double> used);
  void Give(std::vector<std::vector<double>> used) {
    for (std::vector<double>& one : used) Give(std::move(one));
  }

 private:
  std::mutex mutex_;
  std::vector<std::vector<double>> left_;
};

/// Everything that the runs of one diagnosis share.
struct FilterSetup {
  const AxisLog* log = nullptr;
  std::vector<std::uint8_t> valid;  ///< rows whose position may correct
  std::vector<double> start;        ///< position and velocity of the motor at the first row
  ObserverGain gain{}, gain_two{};  ///< for rigid runs, for two-inertia runs
  int substeps_rigid = 4, substeps_two = 8;
  bool full = false;  ///< fill table_position; velocity and friction too when `trace`
  bool trace = false;
  /// Only these are run, back to back in what comes out; none: the whole log.
  std::span<const Segment> segments;
  /// The whole log, one after the other, where it has gaps: after each, motion begins anew. Empty: none.
  std::vector<Segment> pieces;
  std::shared_ptr<DeliveredStore> store = std::make_shared<DeliveredStore>();
  std::shared_ptr<RowStore> spare = std::make_shared<RowStore>();
};

/// What a run goes over; empty: the whole log at once.
std::span<const Segment> PartsOf(const FilterSetup& setup);

/// Per row, as the model's shape asks for.
int SubstepsOf(const FilterSetup& setup, const AxisModel& m);

/// The model driven by the logged command and held to the measured position by a fixed gain: DIAGNOSIS eqs.
/// of the forward model in innovation form. Lanes of eight run together; the result of each does not depend
/// on the others, nor on the number of threads.
std::vector<FilterRun> RunFilter(const FilterSetup& setup, std::span<const AxisModel> models, int threads);

/// A delay below 0 counts as 0.
Delivered DeliveredMeans(const AxisLog& log, double delay_s, double lag_s, int substeps);
/// The same into what is there already; over some segments only, back to back, where there are any.
void DeliveredMeans(const AxisLog& log, double delay_s, double lag_s, int substeps,
                    std::span<const Segment> segments, Delivered& out);

}  // namespace contour::diagnosis
