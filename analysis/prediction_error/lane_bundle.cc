#include "analysis/prediction_error/lane_bundle.h"

#include <algorithm>
#include <cmath>

namespace contour::diagnosis {
namespace {

void SetSignal(LaneSignal& lane, std::size_t i, const SharedSignal& signal, std::size_t rows,
               const double* zeros) {
  lane.from.at[i] = signal ? signal->data() : zeros;
  lane.to.at[i] = signal ? signal->data() + (signal->size() == 2 * rows ? rows : 1) : zeros;
}

/// How the coupling of two inertias goes on over a time h, whether it swings or is damped to death.
struct Decay {
  double dd, dr, rd, rr;
};
Decay DecayOver(double square, double decay, double h) {
  // cos and sin / w of what is left of the mode without its damping, or cosh and sinh.
  const double left = square - decay * decay, w = std::sqrt(std::fabs(left)), x = w * h;
  const double c = left > 0.0 ? std::cos(x) : std::cosh(x);
  const double s = x < 1e-6 ? h : (left > 0.0 ? std::sin(x) : std::sinh(x)) / w;
  const double e = std::exp(-decay * h);
  return {e * (c + decay * s), e * s, -square * e * s, e * (c - decay * s)};
}

void SetFlow(LaneFlow& flow, std::size_t i, const AxisModel& a, double load_inertia, double h) {
  const double per_inertia = 1.0 / a.motor_inertia + 1.0 / load_inertia;
  const double square = a.stiffness * per_inertia, decay = 0.5 * a.damping * per_inertia;
  const Decay whole = DecayOver(square, decay, h), half = DecayOver(square, decay, 0.5 * h);
  flow.dd[i] = whole.dd;
  flow.dr[i] = flow.ra[i] = whole.dr;
  flow.rd[i] = whole.rd;
  flow.rr[i] = whole.rr;
  flow.da[i] = square * h * h < 1e-8 ? 0.5 * h * h : (1.0 - whole.dd) / square;
  flow.half_rd[i] = half.rd;
  flow.half_rr[i] = half.rr;
  flow.half_ra[i] = half.dr;
  flow.stiff[i] = square;
  flow.damp[i] = 2.0 * decay;
  flow.motor_share[i] = a.motor_inertia / (a.motor_inertia + load_inertia);
  flow.load_share[i] = load_inertia / (a.motor_inertia + load_inertia);
}

void Compare(LaneRow& row) {
  row.alike = std::all_of(row.at, row.at + kLanes, [&](const double* p) { return p == row.at[0]; });
}

void SetFriction(Lanes& m, std::size_t i, const AxisModel& a) {
  const StatedFriction& f = a.friction;
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
}

}  // namespace

Lanes MakeLanes(const FilterSetup& setup, std::span<const AxisModel* const> models,
                std::span<const Delivered* const> delivered, const double* measured, const double* zeros) {
  const AxisModel& first = *models[0];
  Lanes m;
  m.rows = setup.log->size();
  m.substeps = SubstepsOf(setup, first);
  m.period_s = setup.log->period_s;
  m.measured = measured;
  m.valid = setup.valid.data();
  const ObserverGain& gain = first.two_inertia ? setup.gain_two : setup.gain;
  std::copy(gain.begin(), gain.end(), m.l);
  m.start_q = setup.start[0];
  m.start_w = setup.start[1];
  // Between 1 and 2 a mixture of both, which is the power to within 0.03 of the whole curve.
  m.square = std::clamp(first.friction.exponent - 1.0, 0.0, 1.0);
  m.linear = 1.0 - m.square;
  m.full = setup.full;
  m.trace = setup.trace;
  m.two = first.two_inertia;
  m.on_load = first.two_inertia && first.friction_on_load;
  m.soft = first.soft_share > 0.0;
  m.fading = first.friction.vd > 0.0;
  m.gap = first.two_inertia && first.gap > 0.0;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const std::size_t from = std::min(i, models.size() - 1);
    const AxisModel& a = *models[from];
    m.torque.at[i] = delivered[from]->mean.data();
    m.late.at[i] = delivered[from]->late.data();
    SetSignal(m.motor, i, a.motor_force, m.rows, zeros);
    SetSignal(m.load, i, a.load_force, m.rows, zeros);
    SetSignal(m.level, i, a.level, m.rows, zeros);
    m.viscous.at[i] = a.viscous ? a.viscous->data() : zeros;
    m.reading.at[i] = a.reading_error ? a.reading_error->data() : zeros;
    m.inv_motor[i] = 1.0 / a.motor_inertia;
    m.inv_load[i] = a.two_inertia ? 1.0 / a.load_inertia : 0.0;
    m.inv_payload[i] = 1.0 / ((a.two_inertia ? a.load_inertia : a.motor_inertia) + a.payload);
    m.payload_row[i] = static_cast<std::int64_t>(a.payload != 0.0 ? a.payload_row : setup.log->size() + 1);
    if (a.two_inertia) {
      const double h = m.period_s / m.substeps;
      SetFlow(m.flow, i, a, a.load_inertia, h);
      SetFlow(m.flow_payload, i, a, a.load_inertia + a.payload, h);
    }
    m.payload = m.payload || a.payload != 0.0;
    m.half_gap[i] = 0.5 * a.gap;
    m.elsewhere[i] = m.on_load ? a.motor_share : 0.0;
    SetFriction(m, i, a);
    m.offset[i] = a.offset;
    m.gain[i] = a.torque_gain;
    m.saturation[i] = a.saturation;
    m.start_z[i] = a.start_bristle;
    m.rough[i] = a.rough;
  }
  for (LaneRow* row : {&m.torque, &m.late, &m.motor.from, &m.motor.to, &m.load.from, &m.load.to,
                       &m.level.from, &m.level.to, &m.viscous, &m.reading})
    Compare(*row);
  return m;
}

Lanes Over(const Lanes& lanes, const Segment& segment) {
  Lanes m = lanes;
  const std::size_t from = segment.from;
  m.rows = segment.rows;
  for (LaneRow* row : {&m.motor.from, &m.motor.to, &m.load.from, &m.load.to, &m.level.from, &m.level.to,
                       &m.viscous, &m.reading})
    for (const double*& p : row->at) p += from;
  // Delivered for the segments only.
  for (LaneRow* row : {&m.torque, &m.late})
    for (const double*& p : row->at) p += segment.at * static_cast<std::size_t>(m.substeps);
  m.measured += from;
  m.valid += from;
  m.payload_row = m.payload_row - static_cast<std::int64_t>(from);
  m.start_q = segment.start_q;
  m.start_w = segment.start_w;
  if (from > 0) m.start_z = m.start_z * 0.0;  // slides
  for (auto* out : {&m.innovation, &m.table, &m.velocity, &m.friction})
    for (double*& p : *out)
      if (p != nullptr) p += segment.at;
  return m;
}

}  // namespace contour::diagnosis
