#include "analysis/identification/axis_bundle.h"

#include <algorithm>
#include <numbers>

namespace contour::identify {

LaneAxis::LaneAxis(const Followed& followed, double period_s)
    : axis_(followed.axis),
      gain_(followed.gain),
      period_s_(period_s),
      substeps_(followed.substeps),
      stiff_(followed.axis) {
  const TableAxis& axis = axis_;
  if (axis.two_inertia && axis.side.share > 0.0) {
    const double omega = 2.0 * std::numbers::pi * axis.side.frequency_Hz;
    side_.mass_kg = axis.side.share * axis.load_inertia;
    side_.stiffness_N_m = side_.mass_kg * omega * omega;
    side_.damping_Ns_m = 2.0 * axis.side.damping_ratio * side_.mass_kg * omega;
    stiff_.load_inertia -= side_.mass_kg;
  }
  if (axis.two_inertia && axis.friction_on_load) on_motor_ = axis.motor_friction_share;
  steps_ = StepsOf(stiff_, period_s, substeps_);
}

bool LaneAxis::RunsWith(const LaneAxis& other) const {
  return axis_.two_inertia == other.axis_.two_inertia &&
         axis_.friction_on_load == other.axis_.friction_on_load &&
         axis_.friction.exponent == other.axis_.friction.exponent && substeps_ == other.substeps_ &&
         steps_.SameCuts(other.steps_);
}

AxisBundle::AxisBundle(const std::vector<const LaneAxis*>& axes) : members_(axes.size()) {
  for (std::size_t lane = 0; lane < kAxisLanes; ++lane) axes_[lane] = axes[lane < members_ ? lane : 0];
  const LaneAxis& first = *axes_.front();
  lanes_.period_s = first.period_s_;
  lanes_.substep_s = first.period_s_ / first.substeps_;
  lanes_.whole_delay = first.steps_.whole_delay;
  lanes_.two_inertia = first.axis_.two_inertia;
  lanes_.on_table = first.axis_.friction_on_load;
  lanes_.exponent = first.axis_.friction.exponent;
  for (const LaneAxis* a : axes_) {
    lanes_.on_motor_too = lanes_.on_motor_too || a->on_motor_ > 0.0;
    lanes_.swings = lanes_.swings || a->side_.mass_kg > 0.0;
  }
  for (int i = 0; i < 4; ++i) Fill(lanes_.gain[i], [i](const LaneAxis& a) { return a.gain_(i); });
  TakePieces();
  TakeFriction();
  TakeVariation();
  TakeWaves();
}

void AxisBundle::TakePieces() {
  const PeriodSteps& first = axes_.front()->steps_;
  const double period_s = lanes_.period_s;
  pieces_.resize(first.pieces.size());
  std::array<double, kAxisLanes> from_s{};
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    LanePiece& to = pieces_[i];
    to.older = first.pieces[i].older;
    to.ends_substep = first.pieces[i].ends_substep;
    for (std::size_t lane = 0; lane < kAxisLanes; ++lane) {
      const PeriodSteps::Piece& p = axes_[lane]->steps_.pieces[i];
      for (int r = 0; r < 4; ++r) {
        for (int c = 0; c < 4; ++c) to.flow[r][c].of[lane] = p.linear.a(r, c);
        to.delayed[r].of[lane] = p.linear.delayed(r);
        to.command[r].of[lane] = p.linear.command(r);
        to.motor[r].of[lane] = p.linear.motor(r);
      }
      to.lag_left.of[lane] = p.linear.lag_left;
      to.half_step_s.of[lane] = 0.5 * p.step_s;
      to.inverse_step.of[lane] = 1.0 / p.step_s;
      // The mean over the piece of a parabola through the period.
      const double begin = from_s[lane] / period_s, end = (from_s[lane] + p.step_s) / period_s;
      to.own_ramp.of[lane] = PartOfPeriod_N(0.0, 1.0, 0.5, begin, end);
      to.own_bow.of[lane] = PartOfPeriod_N(0.0, 0.0, 1.0, begin, end);
      from_s[lane] += p.step_s;
    }
  }
  lanes_.pieces = pieces_.size();
  lanes_.piece = pieces_.data();
}

void AxisBundle::TakeFriction() {
  AxisLanes& to = lanes_;
  const auto fill = [this](PerLane& lanes, const auto& number) {
    Fill(lanes, [&](const LaneAxis& a) { return number(a.axis_, a.axis_.friction); });
  };
  using Friction = diagnosis::StatedFriction;
  fill(to.offset_N, [](const TableAxis& a, const Friction&) { return a.offset; });
  fill(to.stiffness_N_m, [](const TableAxis& a, const Friction&) { return a.stiffness; });
  fill(to.Fc_plus, [](const TableAxis&, const Friction& f) { return f.Fc_plus; });
  fill(to.Fc_minus, [](const TableAxis&, const Friction& f) { return f.Fc_minus; });
  fill(to.Fs_above_plus, [](const TableAxis&, const Friction& f) { return f.Fs_plus - f.Fc_plus; });
  fill(to.Fs_above_minus, [](const TableAxis&, const Friction& f) { return f.Fs_minus - f.Fc_minus; });
  fill(to.inverse_vs, [](const TableAxis&, const Friction& f) { return 1.0 / f.vs; });
  fill(to.s0, [](const TableAxis&, const Friction& f) { return f.s0; });
  fill(to.s1, [](const TableAxis&, const Friction& f) { return std::max(0.0, f.s1); });
  fill(to.inverse_vd, [](const TableAxis&, const Friction& f) { return 1.0 / f.vd; });
  fill(to.s2, [](const TableAxis&, const Friction& f) { return f.s2; });
  fill(to.most_bent_m,
       [](const TableAxis&, const Friction& f) { return std::min(f.Fc_plus, f.Fc_minus) / f.s0; });
  Fill(to.rubbing[0].share, [](const LaneAxis& a) { return 1.0 - a.on_motor_; });
  Fill(to.rubbing[1].share, [](const LaneAxis& a) { return a.on_motor_; });
  const bool on_table = to.on_table;
  Fill(to.rubbing[0].per_mass, [on_table](const LaneAxis& a) {
    return 1.0 / (on_table ? a.stiff_.load_inertia : a.stiff_.motor_inertia);
  });
  Fill(to.rubbing[1].per_mass, [](const LaneAxis& a) { return 1.0 / a.stiff_.motor_inertia; });
  if (!to.swings) return;
  Fill(to.side_stiffness, [](const LaneAxis& a) { return a.side_.stiffness_N_m; });
  Fill(to.side_damping, [](const LaneAxis& a) { return a.side_.damping_Ns_m; });
  Fill(to.side_per_mass,
       [](const LaneAxis& a) { return a.side_.mass_kg > 0.0 ? 1.0 / a.side_.mass_kg : 0.0; });
  Fill(to.table_per_mass, [](const LaneAxis& a) { return 1.0 / a.stiff_.load_inertia; });
}

void AxisBundle::TakeVariation() {
  LaneVariation& to = lanes_.variation;
  const auto fill = [this](PerLane& lanes, const auto& number) {
    Fill(lanes, [&](const LaneAxis& a) { return number(a.axis_.variation); });
  };
  Fill(to.turns_per_m, [](const LaneAxis& a) { return a.axis_.turn_m > 0.0 ? 1.0 / a.axis_.turn_m : 0.0; });
  fill(to.middle_m, [](const LevelVariation& v) { return 0.5 * (v.low_m + v.high_m); });
  const auto known = [](const LevelVariation& v) { return v.high_m > v.low_m; };
  fill(to.per_m, [&](const LevelVariation& v) { return known(v) ? 2.0 / (v.high_m - v.low_m) : 0.0; });
  for (std::size_t i = 0; i < LevelVariation::kDegrees; ++i)
    fill(to.place[i], [&, i](const LevelVariation& v) { return known(v) ? v.place[i] : 0.0; });
  for (std::size_t i = 0; i < 2 * LevelVariation::kHarmonics; ++i) {
    fill(to.turn_plus[i], [i](const LevelVariation& v) { return v.turn_plus[i]; });
    fill(to.turn_minus[i], [i](const LevelVariation& v) { return v.turn_minus[i]; });
  }
}

void AxisBundle::TakeWaves() {
  for (std::size_t i = 0; i < kMostWaves; ++i) {
    const auto is = [i](const LaneAxis& a) { return a.axis_.cogging[i].order > 0.0; };
    if (std::none_of(axes_.begin(), axes_.end(), [&](const LaneAxis* a) { return is(*a); })) continue;
    LaneWave& wave = waves_.emplace_back();
    Fill(wave.per_m,
         [&](const LaneAxis& a) { return is(a) ? a.axis_.cogging[i].order / a.axis_.turn_m : 0.0; });
    Fill(wave.cosine_N, [&](const LaneAxis& a) { return is(a) ? a.axis_.cogging[i].cosine_N : 0.0; });
    Fill(wave.sine_N, [&](const LaneAxis& a) { return is(a) ? a.axis_.cogging[i].sine_N : 0.0; });
  }
  lanes_.waves = waves_.size();
  lanes_.wave = waves_.data();
}

void AxisBundle::SetLane(std::size_t lane, const OwnForce* own, const Results& results) {
  own_[lane] = own;
  results_[lane] = results;
}

void AxisBundle::Run(const Measured& data) {
  lanes_.rows = data.size();
  lanes_.run_up = data.run_up;
  lanes_.sent_N = data.led_by_drive() ? data.offset_N.data() : data.force_N.data();
  lanes_.reported_N = data.led_by_drive() ? data.reported_N.data() : nullptr;
  lanes_.position_m = data.position_m.data();
  lanes_.present = data.present.data();
  // Lanes that repeat the first write the same numbers to the same place.
  for (std::size_t lane = 0; lane < kAxisLanes; ++lane) {
    const std::size_t from = lane < members_ ? lane : 0;
    lanes_.error_m[lane] = results_[from].error_m;
    lanes_.table_m[lane] = results_[from].table_m;
    lanes_.friction_N[lane] = results_[from].friction_N;
    if (!data.led_by_drive()) continue;
    lanes_.own_at_N[lane] = own_[from]->at_N.data();
    lanes_.own_mean_N[lane] = own_[from]->mean_N.data();
    lanes_.own_offset_N[lane] = own_[from]->offset_N.data();
  }
  RunAxisLanes(lanes_);
}

}  // namespace contour::identify
