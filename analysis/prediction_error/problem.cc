#include "analysis/prediction_error/problem.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/prediction_error/extras.h"
#include "analysis/prediction_error/fit.h"
#include "analysis/prediction_error/simd/lane_run.h"

namespace contour::diagnosis {
namespace {

constexpr std::size_t kSlowRows = kRows.slow_rows;
/// Over which the speed is taken that a run begins with; the observer does the rest.
constexpr double kStart_s = 0.01;

const double* DataOf(const SharedSignal& s) { return s ? s->data() : nullptr; }

}  // namespace

Problem::Problem(const AxisLog& axis_log, const StatedAxis& stated_axis, int most_threads)
    : log(axis_log),
      stated(stated_axis),
      threads(std::max(1, most_threads)),
      nominal(ModelOf(stated_axis)),
      signals(std::make_shared<Signals>(MakeSignals(axis_log, stated_axis))) {
  nominal.rows = log.size();
  AddExtras(stated.extras, *signals, nominal);
  setup.log = &log;
  setup.full = has_scale();
  setup.valid = ValidRows(log, *signals, stated, quality);
  Begin();
  Observe(kNoise.observer_bandwidth_Hz);
  ChooseSubsteps();
  terms = MakeBaseTerms(stated, nominal);
  CountRows();
}

void Problem::Observe(double bandwidth_Hz) {
  setup.gain_two = SteadyObserverGain(nominal, log.period_s, bandwidth_Hz);
  AxisModel rigid = nominal;
  rigid.two_inertia = false;
  setup.gain = SteadyObserverGain(rigid, log.period_s, bandwidth_Hz);
  if (!nominal.two_inertia) setup.gain_two = {setup.gain[0], setup.gain[1], setup.gain[0], setup.gain[1]};
}

void Problem::FollowReading(const Point& point) {
  LearnNoise(point);
  Observe(std::max(kNoise.observer_bandwidth_Hz, noise.ObserverBandwidth_Hz(log.period_s)));
  LearnNoise(point);
}

void Problem::Begin() {
  const auto reach = std::max<std::size_t>(1, static_cast<std::size_t>(kStart_s / log.period_s + 0.5));
  const std::vector<std::size_t>& begins = signals->begins;
  for (std::size_t b = 0; b < begins.size(); ++b) {
    const std::size_t from = begins[b], to = b + 1 < begins.size() ? begins[b + 1] : rows();
    const std::size_t n = std::min(reach, to - from - 1);
    const double q = signals->position[from];
    const double w =
        n > 0 ? (signals->position[from + n] - q) / (static_cast<double>(n) * log.period_s) : 0.0;
    if (b == 0) setup.start = {q, w};
    if (begins.size() > 1) setup.pieces.push_back({from, to - from, from, q, w});
  }
}

void Problem::ChooseSubsteps() {
  // The leapfrog is off by (w h)^2 / 24 in the frequency of what moves on the bristles alone. A coupling
  // moves exactly, under forces that are held.
  const StatedFriction& f = nominal.friction;
  const double carried =
      nominal.two_inertia && nominal.friction_on_load ? nominal.load_inertia : nominal.motor_inertia;
  // A stiffness that is hardly known may come out as much larger.
  const double stiffer = std::exp(2.0 * std::max(0.0, StatedSigma(stated, "s0") - kPriors.s0_rel));
  const double presliding = std::sqrt(2.0 * f.s0 * stiffer / carried);
  const double damped = 2.0 * f.s1 / carried;
  // What is fitted to a rigid axis is compared with runs of the rigid one's sub-steps.
  double coupling = 0.0;
  if (nominal.two_inertia)
    coupling = std::sqrt(nominal.stiffness * (1.0 / nominal.motor_inertia + 1.0 / nominal.load_inertia));
  const auto steps = [&](double mode) {
    int s = 4;
    while (s < kMostSubsteps && (presliding * log.period_s / s > 0.36 || damped * log.period_s / s > 0.3 ||
                                 mode * log.period_s / s > 0.65))
      s *= 2;
    return s;
  };
  setup.substeps_rigid = steps(0.0);
  setup.substeps_two = steps(coupling);
}

void Problem::CountRows() {
  const std::size_t n = rows();
  counted.assign(n, 1);
  const auto settled = std::min(n, static_cast<std::size_t>(kRows.settling_s / log.period_s));
  for (const std::size_t begin : signals->begins)
    std::fill_n(counted.begin() + static_cast<std::ptrdiff_t>(begin), std::min(settled, n - begin),
                std::uint8_t{0});
  for (std::size_t k = 0; k < n; ++k) {
    if (setup.valid[k] != 0) continue;
    for (std::size_t i = k > 2 ? k - 2 : 0; i < std::min(n, k + 3); ++i) counted[i] = 0;
  }
}

AxisModel Problem::Build(const Point& point) const {
  AxisModel m = nominal;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const BaseTerm& t = terms[i];
    const double x = point.base[i];
    if (t.additive) {
      *t.field(m) += x;
      continue;
    }
    const double factor = std::exp(std::clamp(x, -3.0, 3.0));
    *t.field(m) *= factor;
    if (t.name == "Fc") m.friction.Fc_minus *= factor;
    if (t.name == "Fs") m.friction.Fs_minus *= factor;
  }
  // Without a Stribeck term of its own, the break-away level goes with the Coulomb level.
  const bool has_stribeck =
      std::any_of(terms.begin(), terms.end(), [](const BaseTerm& t) { return t.name == "Fs"; });
  if (!has_stribeck) {
    const double factor = m.friction.Fc_plus / nominal.friction.Fc_plus;
    m.friction.Fs_plus = nominal.friction.Fs_plus * factor;
    m.friction.Fs_minus = nominal.friction.Fs_minus * factor;
  }
  for (std::size_t i = 0; i < point.effects.size(); ++i) point.effects[i]->apply(point.amplitudes[i], m);
  return m;
}

std::vector<std::vector<double>> Problem::Raw(std::span<const Point> points, Extent extent) const {
  std::vector<AxisModel> models;
  models.reserve(points.size());
  for (const Point& p : points) models.push_back(Build(p));
  return Raw(std::span<const AxisModel>(models), extent);
}

std::vector<std::vector<double>> Problem::Raw(std::span<const AxisModel> models, Extent extent) const {
  FilterSetup partly = setup;
  if (extent == Extent::kExcerpt) partly.segments = excerpt.segments;
  std::vector<FilterRun> runs = RunFilter(partly, models, threads);
  std::vector<std::vector<double>> raw(models.size());
  for (std::size_t i = 0; i < models.size(); ++i) {
    raw[i] = std::move(runs[i].innovation);
    if (!has_scale()) continue;
    AddScale(runs[i].table_position, models[i].two_inertia, DataOf(models[i].scale_error_m),
             log.table_position_m.data(), raw[i], extent);
    setup.spare->Give(std::move(runs[i].table_position));
  }
  return raw;
}

double Problem::ExplainedByExtras(const Point& point) const {
  const AxisModel with = Build(point);
  AxisModel without = with;
  without.motor_force = without.load_force = without.level = without.viscous = without.scale_error_m =
      nullptr;
  if (with == without) return 0.0;
  const AxisModel both[] = {with, without};
  const std::vector<std::vector<double>> white = White(Raw(std::span<const AxisModel>(both), Extent::kWhole));
  const auto squares = [](const std::vector<double>& r) {
    return std::inner_product(r.begin(), r.end(), r.begin(), 0.0);
  };
  return squares(white[1]) - squares(white[0]);
}

std::vector<std::vector<double>> Problem::White(std::span<const std::vector<double>> raw,
                                                Extent extent) const {
  std::vector<std::vector<double>> white(raw.size());
  std::vector<std::span<const double>> in;
  std::vector<std::span<double>> out;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    white[i] = setup.spare->Take(raw[i].size());
    in.emplace_back(raw[i]);
    out.emplace_back(white[i]);
  }
  WhitenInto(in, out, extent);
  return white;
}

void Problem::WhitenInto(std::span<const std::span<const double>> raw,
                         std::span<const std::span<double>> white, Extent extent) const {
  const bool whole = extent == Extent::kWhole;
  const std::size_t n = whole ? rows() : excerpt.row.size();
  const std::vector<double>& weight = whole ? root_weight : excerpt_weight_;
  const std::span<const Segment> segments =
      whole ? std::span<const Segment>() : std::span<const Segment>(excerpt.segments);
  std::vector<const double*> in;
  std::vector<double*> out;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    in.push_back(raw[i].data());
    out.push_back(white[i].data());
  }
  noise.Apply(in, out, counted, weight.data(), segments);
  if (!has_scale()) return;
  for (const double*& p : in) p += n;
  for (double*& p : out) p += n;
  ApplyColourFilter(scale_noise, in, out, counted, weight.data() + n, segments);
  std::vector<std::size_t> begins;
  for (const Segment& s : segments) begins.push_back(s.at);
  TakeOutWander(scale_wander, std::span(weight).subspan(n), whole ? signals->begins : begins,
                whole ? 1.0 : excerpt.per_row, out);
}

std::vector<std::vector<double>> Problem::Residuals(std::span<const Point> points, Extent extent) const {
  std::vector<std::vector<double>> raw = Raw(points, extent), white = White(raw, extent);
  setup.spare->Give(std::move(raw));
  return white;
}

std::vector<std::vector<double>> Problem::LinearResponses(const Point& point,
                                                          std::span<const SharedEffect> effects) const {
  const AxisModel without = Build(point);
  std::vector<LinearInput> inputs;
  std::vector<SharedSignal> errors;
  for (const SharedEffect& e : effects) {
    for (std::size_t i = 0; i < e->tested; ++i) {
      std::vector<double> amplitudes(e->steps.size(), 0.0);
      amplitudes[i] = e->steps[i];
      AxisModel with = without;
      e->apply(amplitudes, with);
      LinearInput input;
      SharedSignal error;
      if (!SignalsOnly(noise.linear(), without, with, 1.0 / e->steps[i], input, error))
        throw std::logic_error(e->kind + ": more than a signal");
      inputs.push_back(std::move(input));
      errors.push_back(std::move(error));
    }
  }
  std::vector<FilterRun> runs = LinearColumns(noise.linear(), inputs, has_scale());
  std::vector<std::vector<double>> raw(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    raw[i] = std::move(runs[i].innovation);
    if (has_scale())
      AddScale(runs[i].table_position, without.two_inertia, DataOf(errors[i]), nullptr, raw[i]);
  }
  return White(raw);
}

FilterRun Problem::Trace(const Point& point) const {
  FilterSetup traced = setup;
  traced.full = traced.trace = true;
  const AxisModel m = Build(point);
  return std::move(RunFilter(traced, std::span(&m, 1), 1)[0]);
}

void Problem::Lower(const double* r, std::size_t half, double largest_by_chance, double* w) const {
  const std::size_t n = rows();
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < n + half; ++k) {
    if (k < n && counted[k] != 0) {
      sum += r[k] * r[k];
      count += 1.0;
    }
    if (k >= 2 * half + 1 && counted[k - 2 * half - 1] != 0) {
      sum -= r[k - 2 * half - 1] * r[k - 2 * half - 1];
      count -= 1.0;
    }
    if (k < half) continue;
    const double mean = count > 0.5 ? sum / count : 1.0;
    if (mean > largest_by_chance) w[k - half] = std::min(w[k - half], 1.0 / std::sqrt(mean));
  }
}

void Problem::LearnNoise(const Point& point) {
  const std::size_t n = rows();
  const AxisModel model = Build(point);
  const NoiseSetup known{model.motor_inertia + (model.two_inertia ? model.load_inertia : 0.0), log.period_s,
                         stated.position_step, slow_torque && Plausible(*this, point)};
  noise = NoiseFilter(std::make_shared<const LinearModel>(Linearise(setup, model)), counted, known,
                      noise.learnt() ? &noise : nullptr);
  std::vector<double> raw = noise.linear().innovation;
  if (has_scale())
    AddScale(noise.linear().table, model.two_inertia, DataOf(model.scale_error_m),
             log.table_position_m.data(), raw);
  root_weight.assign(data_size(), 1.0);
  if (has_scale()) LearnScaleNoise(raw);
  const std::vector<double> white = White(std::span(&raw, 1))[0];
  const std::vector<double> weights = std::exchange(root_weight, std::vector<double>(data_size(), 1.0));
  for (std::size_t base = 0; base < data_size(); base += n) {
    const double* r = &white[base];
    double* w = &root_weight[base];
    // Stuck, torque has another spectrum: levels in short, longer and slow windows, the largest counts.
    std::vector<double> slow(n, 0.0);
    double sum = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
      sum += r[k] - (k >= kSlowRows ? r[k - kSlowRows] : 0.0);
      if (k + 1 >= kSlowRows)
        slow[k + 1 - kSlowRows / 2 - 1] = sum / std::sqrt(static_cast<double>(kSlowRows));
    }
    Lower(r, kRows.short_window_rows, kRows.short_by_chance, w);
    Lower(r, kRows.long_window_rows, kRows.long_by_chance, w);
    Lower(slow.data(), kRows.slow_window_rows, kRows.slow_by_chance, w);
  }
  for (std::size_t k = 0; k < data_size(); ++k) root_weight[k] *= counted[k % n] != 0 ? weights[k] : 0.0;
  WeighExcerpt();
}

void Problem::Take(LearntNoise learnt) {
  noise = std::move(learnt.filter);
  scale_noise = std::move(learnt.scale);
  scale_wander = learnt.wander;
  root_weight = std::move(learnt.root_weight);
  excerpt_weight_ = std::move(learnt.excerpt_weight);
}

double Problem::LogNoise() const {
  const std::size_t n = rows();
  double sum = noise.LogVariances(counted);
  for (std::size_t k = 0; k < data_size(); ++k) {
    if (root_weight[k] <= 0.0) continue;
    sum -= 2.0 * std::log(root_weight[k] * (k < n ? 1.0 : scale_noise.taps()[0]));
  }
  if (has_scale()) sum += LogVariances(scale_wander, std::span(root_weight).subspan(n), signals->begins);
  return sum;
}

void Problem::WeighExcerpt() {
  const std::size_t m = excerpt.row.size(), n = rows();
  excerpt_weight_.assign(data_size(Extent::kExcerpt), 0.0);
  const double root = std::sqrt(excerpt.per_row);
  for (std::size_t i = 0; i < excerpt_weight_.size(); ++i)
    if (excerpt.counts[i % m] != 0) excerpt_weight_[i] = root * root_weight[i / m * n + excerpt.row[i % m]];
}

void Problem::LearnSignals(const Point& point) {
  auto renewed = std::make_shared<Signals>(*signals);
  const AxisModel m = Build(point);
  const Delivered delivered =
      DeliveredMeans(log, m.delay_s - m.lag_for_delay_s, m.lag_s + m.lag_for_delay_s, 1);
  UpdateFromTrace(m, Trace(point), delivered.mean, *renewed);
  signals = renewed;
}

void Problem::LearnOutliers(const Point& point) {
  const AxisModel m = Build(point);
  const FilterRun run = std::move(RunFilter(setup, std::span(&m, 1), 1)[0]);
  MarkOutliers(run.innovation, stated.position_step, setup.valid, quality);
  CountRows();
  // Over a gap nothing stands for what was before it.
  std::vector<std::uint8_t> valid = setup.valid;
  const auto length = static_cast<std::size_t>(kExcerpts.segment_s / log.period_s);
  for (const std::size_t begin : signals->begins)
    std::fill(valid.begin() + static_cast<std::ptrdiff_t>(begin - std::min(begin, length)),
              valid.begin() + static_cast<std::ptrdiff_t>(begin), std::uint8_t{0});
  excerpt = ChooseExcerpt(signals->position, signals->velocity, valid, counted, log.period_s,
                          nominal.friction.Fc_plus / nominal.friction.s0);
}

}  // namespace contour::diagnosis
