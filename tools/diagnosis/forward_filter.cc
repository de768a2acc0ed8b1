#include "tools/diagnosis/forward_filter.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>
#include <thread>
#include <tuple>

#include "tools/diagnosis/lane_run.h"

namespace contour::diagnosis {
namespace {

using MeansKey = std::tuple<double, double, int>;
using MeansCache = std::map<MeansKey, Delivered>;

MeansKey KeyOf(const FilterSetup& setup, const AxisModel& m) {
  return {m.delay_s, m.lag_s, m.two_inertia ? setup.substeps_two : setup.substeps_rigid};
}

/// What must be alike in one bundle of lanes.
std::tuple<bool, bool, bool, bool> ShapeOf(const AxisModel& m) {
  return {m.two_inertia, m.two_inertia && m.friction_on_load, m.soft_share > 0.0, m.friction.vd > 0.0};
}

void RunBundle(const FilterSetup& setup, const MeansCache& means, const std::vector<double>& measured,
               const std::vector<double>& zeros, std::span<const AxisModel* const> models,
               std::span<FilterRun* const> out) {
  const AxisModel& first = *models[0];
  Lanes m;
  m.rows = setup.log->size();
  m.substeps = first.two_inertia ? setup.substeps_two : setup.substeps_rigid;
  m.period_s = setup.log->period_s;
  m.measured = measured.data();
  m.valid = setup.valid.data();
  const ObserverGain& gain = first.two_inertia ? setup.gain_two : setup.gain;
  std::copy(gain.begin(), gain.end(), m.l);
  m.start_q = setup.start[0];
  m.start_w = setup.start[1];
  m.square = first.friction.exponent > 1.5;
  m.full = setup.full;
  m.trace = setup.trace;
  std::vector<std::vector<double>> spare(kLanes);
  for (std::size_t i = 0; i < kLanes; ++i) {
    const AxisModel& a = *models[std::min(i, models.size() - 1)];
    const StatedFriction& f = a.friction;
    const auto signal = [&](const SharedSignal& s) { return s ? s->data() : zeros.data(); };
    const Delivered& delivered = means.at(KeyOf(setup, a));
    m.torque[i] = delivered.mean.data();
    m.late[i] = delivered.late.data();
    m.motor[i] = signal(a.motor_force);
    m.load[i] = signal(a.load_force);
    m.level[i] = signal(a.level);
    m.viscous[i] = signal(a.viscous);
    m.reading[i] = signal(a.reading_error);
    m.inv_motor[i] = 1.0 / a.motor_inertia;
    m.inv_load[i] = a.two_inertia ? 1.0 / a.load_inertia : 0.0;
    m.inv_payload[i] = 1.0 / ((a.two_inertia ? a.load_inertia : a.motor_inertia) + a.payload);
    m.payload_row[i] = static_cast<std::int64_t>(a.payload != 0.0 ? a.payload_row : setup.log->size() + 1);
    // The leapfrog's mode is too fast by (w h)^2 / 24: taken off the stiffness.
    if (a.two_inertia) {
      const double w = std::sqrt(a.stiffness * (1.0 / a.motor_inertia + 1.0 / a.load_inertia));
      const double x = std::min(1.2, 0.5 * w * m.period_s / m.substeps);
      m.stiffness[i] = a.stiffness * (x > 1e-6 ? std::pow(std::sin(x) / x, 2) : 1.0);
    }
    m.damping[i] = a.damping;
    m.half_gap[i] = 0.5 * a.gap;
    const double stiff = 1.0 - a.soft_share;
    m.Fc_plus[i] = f.Fc_plus;
    m.Fc_minus[i] = f.Fc_minus;
    m.dF_plus[i] = f.Fs_plus - f.Fc_plus;
    m.dF_minus[i] = f.Fs_minus - f.Fc_minus;
    m.inv_vs[i] = 1.0 / f.vs;
    m.s0[i] = f.s0;
    m.s1[i] = f.s1;
    m.inv_vd[i] = f.vd > 0.0 ? 1.0 / f.vd : 0.0;
    m.s2[i] = f.s2;
    m.smallest[i] = 1e-3 * 0.5 * (f.Fc_plus + f.Fc_minus) + 1e-30;
    m.offset[i] = a.offset;
    m.gain[i] = a.torque_gain;
    m.saturation[i] = a.saturation;
    m.start_z[i] = a.start_bristle;
    if (a.soft_share > 0.0) {
      m.Fc_plus[i] *= stiff;
      m.Fc_minus[i] *= stiff;
      m.dF_plus[i] *= stiff;
      m.dF_minus[i] *= stiff;
      m.s0[i] *= stiff;
      m.soft_level[i] = a.soft_share / stiff;
      m.soft_s0[i] = f.s0 * a.soft_share * a.soft_ratio;
    } else {
      m.soft_level[i] = 1.0;
      m.soft_s0[i] = 0.0;
    }
    if (i < models.size()) {
      FilterRun& r = *out[i];
      r.innovation.resize(m.rows);
      m.innovation[i] = r.innovation.data();
      if (m.full) {
        r.table_position.resize(m.rows);
        m.table[i] = r.table_position.data();
      }
      if (m.trace) {
        r.velocity.resize(m.rows);
        r.friction.resize(m.rows);
        m.velocity[i] = r.velocity.data();
        m.friction[i] = r.friction.data();
      }
    } else {
      spare[i].resize(m.rows);
      m.innovation[i] = m.table[i] = m.velocity[i] = m.friction[i] = spare[i].data();
    }
  }
  std::tie(m.two, m.on_load, m.soft, m.fading) = ShapeOf(first);
  static const bool avx2 = __builtin_cpu_supports("avx2") != 0;
  avx2 ? RunLanesAvx2(m) : RunLanesBaseline(m);
}

}  // namespace

AxisModel ModelOf(const StatedAxis& s) {
  AxisModel m;
  m.two_inertia = s.two_inertia;
  m.friction_on_load = s.friction_on_load && s.two_inertia;
  m.motor_inertia = s.motor_inertia;
  m.load_inertia = s.load_inertia;
  m.stiffness = s.stiffness;
  m.damping = s.damping;
  m.friction = s.friction;
  m.offset = s.offset;
  m.delay_s = s.delay_s;
  m.lag_s = s.lag_s;
  return m;
}

std::vector<FilterRun> RunFilter(const FilterSetup& setup, std::span<const AxisModel> models, int threads) {
  std::vector<FilterRun> runs(models.size());
  MeansCache means;
  for (const AxisModel& m : models) {
    const MeansKey key = KeyOf(setup, m);
    if (!means.contains(key))
      means[key] = DeliveredMeans(*setup.log, std::get<0>(key), std::get<1>(key), std::get<2>(key));
  }
  const std::size_t rows = setup.log->size();
  std::vector<double> measured = setup.log->position, zeros(rows, 0.0);
  for (std::size_t k = 0; k < rows; ++k)
    if (setup.valid[k] == 0) measured[k] = 0.0;
  struct Bundle {
    std::vector<const AxisModel*> models;
    std::vector<FilterRun*> out;
  };
  std::vector<Bundle> bundles;
  std::map<std::tuple<bool, bool, bool, bool>, std::size_t> open;
  for (std::size_t i = 0; i < models.size(); ++i) {
    const auto shape = ShapeOf(models[i]);
    const auto it = open.find(shape);
    if (it == open.end() || bundles[it->second].models.size() == kLanes) {
      open[shape] = bundles.size();
      bundles.emplace_back();
    }
    Bundle& b = bundles[open[shape]];
    b.models.push_back(&models[i]);
    b.out.push_back(&runs[i]);
  }
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < bundles.size(); i = next++)
      RunBundle(setup, means, measured, zeros, bundles[i].models, bundles[i].out);
  };
  std::vector<std::thread> pool;
  for (int t = 1; t < threads && static_cast<std::size_t>(t) < bundles.size(); ++t) pool.emplace_back(work);
  work();
  for (std::thread& t : pool) t.join();
  return runs;
}

}  // namespace contour::diagnosis
