#include "analysis/prediction_error/forward_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "analysis/parallel/parallel_for.h"
#include "analysis/prediction_error/lane_bundle.h"
#include "analysis/prediction_error/simd/lane_loops.h"

namespace contour::diagnosis {
namespace {

// The rest would take more memory than it is worth.
constexpr std::size_t kMostKept = kLanes, kMostSpare = 6 * kLanes;

using MeansCache = std::map<DeliveredKey, Delivered>;

DeliveredKey KeyOf(const FilterSetup& setup, const AxisModel& m) {
  return {m.delay_s - m.lag_for_delay_s, m.lag_s + m.lag_for_delay_s, SubstepsOf(setup, m)};
}

/// A step of a fit may end anywhere; what is no number has no place in the cache of means either.
bool IsMachine(const AxisModel& m) {
  const StatedFriction& f = m.friction;
  const double all = m.motor_inertia + m.load_inertia + m.stiffness + m.damping + m.gap + m.rough +
                     m.start_bristle + m.offset + m.delay_s + m.lag_s + m.lag_for_delay_s + m.torque_gain +
                     m.saturation + m.soft_share + m.soft_ratio + m.payload + f.Fc_plus + f.Fc_minus +
                     f.Fs_plus + f.Fs_minus + f.vs + f.s0 + f.s1 + f.vd + f.s2;
  const double carried = m.two_inertia ? m.load_inertia : m.motor_inertia;
  return std::isfinite(all) && m.motor_inertia > 0.0 && carried > 0.0 && carried + m.payload > 0.0;
}

bool HasGap(const AxisModel& m) { return m.two_inertia && m.gap > 0.0; }

/// What must be alike in one bundle of lanes.
using Shape = std::tuple<bool, bool, bool, bool, bool>;
Shape ShapeOf(const AxisModel& m) {
  return {m.two_inertia, m.two_inertia && m.friction_on_load, m.soft_share > 0.0, m.friction.vd > 0.0,
          HasGap(m)};
}

struct Bundle {
  std::vector<const AxisModel*> models;
  std::vector<FilterRun*> out;
};

/// What a bundle reads besides its models.
struct Inputs {
  const FilterSetup& setup;
  MeansCache means;
  std::vector<double> measured, zeros;
};

std::size_t RowsOf(const FilterSetup& setup) {
  if (setup.segments.empty()) return setup.log->size();
  return setup.segments.back().at + setup.segments.back().rows;
}

Lanes Prepare(const Inputs& in, const Bundle& bundle, std::vector<double>& spare) {
  std::vector<const Delivered*> delivered;
  for (const AxisModel* a : bundle.models) delivered.push_back(&in.means.at(KeyOf(in.setup, *a)));
  const std::size_t rows = RowsOf(in.setup);
  Lanes m = MakeLanes(in.setup, bundle.models, delivered, in.measured.data(), in.zeros.data());
  for (std::size_t i = 0; i < kLanes; ++i) {
    if (i >= bundle.models.size()) {
      if (spare.empty()) spare = in.setup.spare->Take(rows);
      m.innovation[i] = m.table[i] = m.velocity[i] = m.friction[i] = spare.data();
      continue;
    }
    FilterRun& r = *bundle.out[i];
    r.innovation = in.setup.spare->Take(rows);
    m.innovation[i] = r.innovation.data();
    if (m.full) {
      r.table_position = in.setup.spare->Take(rows);
      m.table[i] = r.table_position.data();
    }
    if (m.trace) {
      r.velocity.resize(rows);
      r.friction.resize(rows);
      m.velocity[i] = r.velocity.data();
      m.friction[i] = r.friction.data();
    }
  }
  return m;
}

/// Of every key; those that are left from runs before first, or what others are made into could be theirs.
void MakeMeans(const FilterSetup& setup, MeansCache& means) {
  std::vector<MeansCache::iterator> rest;
  const bool whole = setup.segments.empty();
  for (auto at = means.begin(); at != means.end(); ++at)
    if (!setup.store->Find(at->first, whole, at->second)) rest.push_back(at);
  for (const MeansCache::iterator& at : rest) {
    const auto& [delay_s, lag_s, substeps] = at->first;
    at->second = setup.store->Take();
    DeliveredMeans(*setup.log, delay_s, lag_s, substeps, PartsOf(setup), at->second);
  }
}

/// One bundle, or two of the same shape.
void RunBundles(const Inputs& in, std::span<const Bundle> some) {
  std::vector<double> spare;
  const Lanes first = Prepare(in, some[0], spare);
  const auto run = [&](const Lanes& a, const Lanes* b) {
    b == nullptr ? BestLoops().run(a) : BestLoops().run_both(a, *b);
  };
  std::optional<Lanes> second;
  if (some.size() > 1) second = Prepare(in, some[1], spare);
  const std::span<const Segment> parts = PartsOf(in.setup);
  if (parts.empty()) run(first, second ? &*second : nullptr);
  for (const Segment& s : parts) {
    const Lanes a = Over(first, s);
    if (!second) {
      run(a, nullptr);
      continue;
    }
    const Lanes b = Over(*second, s);
    run(a, &b);
  }
  in.setup.spare->Give(std::move(spare));
}

}  // namespace

bool DeliveredStore::Find(const DeliveredKey& key, bool whole, Delivered& out) {
  const std::scoped_lock lock(mutex_);
  const auto at = std::find_if(left_.begin(), left_.end(),
                               [&](const Left& l) { return whole && l.whole && l.key == key; });
  if (at == left_.end()) return false;
  out = std::move(at->means);
  left_.erase(at);
  return true;
}

Delivered DeliveredStore::Take() {
  const std::scoped_lock lock(mutex_);
  if (left_.empty()) return {};
  Delivered out = std::move(left_.front().means);
  left_.pop_front();
  return out;
}

void DeliveredStore::Give(const DeliveredKey& key, bool whole, Delivered used) {
  const std::scoped_lock lock(mutex_);
  if (left_.size() == kMostKept) left_.pop_front();
  left_.push_back({key, whole, std::move(used)});
}

std::vector<double> RowStore::Take(std::size_t size) {
  std::vector<double> out;
  {
    const std::scoped_lock lock(mutex_);
    if (!left_.empty()) {
      out = std::move(left_.back());
      left_.pop_back();
    }
  }
  out.resize(size);
  return out;
}

void RowStore::Give(std::vector<double> used) {
  const std::scoped_lock lock(mutex_);
  if (!used.empty() && left_.size() < kMostSpare) left_.push_back(std::move(used));
}

std::span<const Segment> PartsOf(const FilterSetup& setup) {
  return setup.segments.empty() ? std::span<const Segment>(setup.pieces) : setup.segments;
}

int SubstepsOf(const FilterSetup& setup, const AxisModel& m) {
  return m.two_inertia ? setup.substeps_two : setup.substeps_rigid;
}

std::vector<FilterRun> RunFilter(const FilterSetup& setup, std::span<const AxisModel> models, int threads) {
  std::vector<FilterRun> runs(models.size());
  const std::size_t rows = RowsOf(setup);
  Inputs in{setup, {}, setup.log->position, std::vector<double>(setup.log->size(), 0.0)};
  for (std::size_t k = 0; k < in.measured.size(); ++k)
    if (setup.valid[k] == 0) in.measured[k] = 0.0;
  std::map<Shape, std::vector<Bundle>> bundles;
  for (std::size_t i = 0; i < models.size(); ++i) {
    const AxisModel& m = models[i];
    if (!IsMachine(m)) {
      const std::vector<double> none(rows, std::numeric_limits<double>::quiet_NaN());
      runs[i].innovation = none;
      if (setup.full) runs[i].table_position = none;
      if (setup.trace) runs[i].velocity = runs[i].friction = none;
      continue;
    }
    in.means[KeyOf(setup, m)];
    std::vector<Bundle>& alike = bundles[ShapeOf(m)];
    if (alike.empty() || alike.back().models.size() == kLanes) alike.emplace_back();
    alike.back().models.push_back(&m);
    alike.back().out.push_back(&runs[i]);
  }
  MakeMeans(setup, in.means);
  std::vector<std::span<const Bundle>> work;
  for (const auto& [shape, alike] : bundles)
    for (std::size_t i = 0; i < alike.size(); i += 2)
      work.push_back(std::span(alike).subspan(i, std::min<std::size_t>(2, alike.size() - i)));
  ParallelFor(work.size(), threads, [&](std::size_t i) { RunBundles(in, work[i]); });
  for (auto& [key, means] : in.means) setup.store->Give(key, setup.segments.empty(), std::move(means));
  return runs;
}

}  // namespace contour::diagnosis
