#include "analysis/diagnosis/causes/effects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "analysis/prediction_error/wave_signals.h"

namespace contour::diagnosis {
namespace {

constexpr double kPi = std::numbers::pi;
// Logarithm of how far a coupling's damping ratio may be from 0.04.
constexpr double kDampingReach = 2.0;
constexpr double kLeastWarming_K = 0.1;
// As if so many places had been looked at.
constexpr double kKneeShows = 300.0;

SharedSignal Add(const SharedSignal& before, const std::vector<SharedSignal>& basis,
                 const std::vector<double>& a) {
  auto sum = before ? std::make_shared<Signal>(*before) : std::make_shared<Signal>(basis[0]->size(), 0.0);
  for (std::size_t i = 0; i < basis.size(); ++i) {
    if (a[i] == 0.0) continue;
    if (sum->size() < basis[i]->size()) *sum = Doubled(*sum);
    const Signal doubled = sum->size() > basis[i]->size() ? Doubled(*basis[i]) : Signal();
    const Signal& b = doubled.empty() ? *basis[i] : doubled;
    for (std::size_t k = 0; k < sum->size(); ++k) (*sum)[k] += a[i] * b[k];
  }
  return sum;
}

template <class F>
SharedSignal Make(std::size_t n, F&& f) {
  auto s = std::make_shared<Signal>(n);
  for (std::size_t k = 0; k < n; ++k) (*s)[k] = f(k);
  return s;
}

std::vector<SharedSignal> Cosines(const Signals& s, int first, int last) {
  std::vector<SharedSignal> out;
  const double half = std::max(s.half_stroke_m, 1e-9);
  for (int j = first; j <= last; ++j)
    out.push_back(Make(s.table_m.size(), [&](std::size_t k) {
      return std::cos(j * kPi * 0.5 * (std::clamp(s.table_m[k] / half, -1.0, 1.0) + 1.0));
    }));
  return out;
}

std::vector<SharedSignal> Legendre(const Signals& s, int last) {
  std::vector<SharedSignal> out;
  const double half = std::max(s.half_stroke_m, 1e-9);
  for (int j = 1; j <= last; ++j)
    out.push_back(Make(s.table_m.size(), [&](std::size_t k) {
      return std::legendre(static_cast<unsigned>(j), std::clamp(s.table_m[k] / half, -1.0, 1.0));
    }));
  return out;
}

/// A thermometer that stands still, to its own resolution, tells nothing.
bool Varies(const Signal& temperature_K) {
  if (temperature_K.empty()) return false;
  const auto [low, high] = std::minmax_element(temperature_K.begin(), temperature_K.end());
  return *high - *low > kLeastWarming_K;
}

// Hats over the log's time.
std::vector<SharedSignal> Hats(std::size_t n, int count) {
  std::vector<SharedSignal> out;
  const double width = static_cast<double>(n) / (count - 1);
  for (int j = 0; j < count; ++j)
    out.push_back(Make(n, [&](std::size_t k) {
      return std::max(0.0, 1.0 - std::fabs(static_cast<double>(k) / width - j));
    }));
  return out;
}

SharedEffect Custom(std::string kind, std::string label, double grid, std::vector<double> steps,
                    std::function<void(const std::vector<double>&, AxisModel&)> apply,
                    std::vector<double> start = {}, std::vector<double> low = {},
                    std::vector<double> high = {}) {
  auto e = std::make_shared<Effect>();
  e->kind = std::move(kind);
  e->label = std::move(label);
  e->grid = grid;
  e->steps = std::move(steps);
  e->apply = std::move(apply);
  e->start = std::move(start);
  e->low = std::move(low);
  e->high = std::move(high);
  e->tested = e->start.empty() ? e->steps.size() : 1;
  return e;
}

SharedEffect AsSignals(const SharedEffect& e) {
  auto copy = std::make_shared<Effect>(*e);
  copy->signals = true;
  return copy;
}

SharedEffect WithShorter(const SharedEffect& e, SharedEffect shorter) {
  auto copy = std::make_shared<Effect>(*e);
  copy->shorter = std::move(shorter);
  return copy;
}

SharedEffect WithOrder(const SharedEffect& e, double order) {
  auto copy = std::make_shared<Effect>(*e);
  copy->order = order;
  return copy;
}

SharedEffect WithForce(const SharedEffect& e, std::vector<int> force) {
  auto copy = std::make_shared<Effect>(*e);
  copy->force = std::move(force);
  return copy;
}

bool IsForce(Input input) { return input == Input::kMotorForce || input == Input::kLoadForce; }

SharedSignal& TargetOf(AxisModel& m, Input input) {
  switch (input) {
    case Input::kMotorForce:
      return m.motor_force;
    case Input::kLoadForce:
      return m.load_force;
    case Input::kLevel:
      return m.level;
    case Input::kViscous:
      return m.viscous;
    case Input::kReading:
      return m.reading_error;
    case Input::kScale:
      break;
  }
  return m.scale_error_m;
}

/// Into one of the model's inputs. Levels multiply: what is there already has the effect in its proportion.
void Enter(AxisModel& m, Input input, const std::vector<SharedSignal>& basis, const std::vector<double>& a) {
  SharedSignal& target = TargetOf(m, input);
  if (input != Input::kLevel || !target) {
    target = Add(target, basis, a);
    return;
  }
  const SharedSignal own = Add(nullptr, basis, a);
  const Signal before = target->size() < own->size() ? Doubled(*target) : *target;
  auto sum = std::make_shared<Signal>(own->size() < before.size() ? Doubled(*own) : *own);
  for (std::size_t k = 0; k < sum->size(); ++k) (*sum)[k] += before[k] * (1.0 + (*sum)[k]);
  target = sum;
}

// A signal times an amplitude, its shape by a second number that is 0 at the grid's place and fitted with the
// rest.
SharedEffect ShapedEffect(const Problem& p, std::string kind, std::string label, double grid, Input input,
                          double step, std::array<double, 2> range,
                          std::function<double(std::size_t, double)> shape);

void AddFriction(const Problem& p, std::vector<SharedEffect>& out) {
  const Signals& s = *p.signals_;
  const std::size_t n = p.rows();
  const double Fc = s.coulomb;
  const SharedEffect levels = Custom("asymmetric_coulomb", "", 1, {2e-3},
                                     [](const auto& a, AxisModel& m) {
                                       m.friction.Fc_plus *= 1.0 + 0.5 * a[0];
                                       m.friction.Fs_plus *= 1.0 + 0.5 * a[0];
                                       m.friction.Fc_minus *= 1.0 - 0.5 * a[0];
                                       m.friction.Fs_minus *= 1.0 - 0.5 * a[0];
                                     },
                                     {}, {-1.8}, {1.8});
  // Guides and wipers that drag one way do so at speed, too: a viscous term that differs with them.
  const auto way = Make(n, [&](std::size_t k) {
    return s.velocity[k] > 0.0 ? 1.0 : s.velocity[k] < 0.0 ? -1.0 : 0.0;
  });
  out.push_back(WithShorter(Custom("asymmetric_coulomb", "and viscous", 1, {2e-3, 5e-3},
                                   [way](const auto& a, AxisModel& m) {
                                     m.friction.Fc_plus *= 1.0 + 0.5 * a[0];
                                     m.friction.Fs_plus *= 1.0 + 0.5 * a[0];
                                     m.friction.Fc_minus *= 1.0 - 0.5 * a[0];
                                     m.friction.Fs_minus *= 1.0 - 0.5 * a[0];
                                     m.viscous = Add(m.viscous, {way}, {0.5 * a[1]});
                                   },
                                   {}, {-1.8, -1.8}, {1.8, 1.8}),
                            levels));
  out.push_back(WithForce(
      Custom("constant_torque", "", 1, {0.01 * Fc}, [](const auto& a, AxisModel& m) { m.offset += a[0]; }),
      {1}));
  const StatedFriction& f = p.nominal_.friction;
  if (f.Fs_plus + f.Fs_minus > 1.05 * (f.Fc_plus + f.Fc_minus)) {
    out.push_back(Custom("stribeck", "", 1, {2e-3, 5e-3},
                         [](const auto& a, AxisModel& m) {
                           m.friction.Fs_plus *= std::exp(a[0]);
                           m.friction.Fs_minus *= std::exp(a[0]);
                           m.friction.vs *= std::exp(a[1]);
                         },
                         {}, {-0.4, -1.5}, {1.0, 1.5}));
  } else {
    for (const double part : {0.003, 0.012, 0.05}) {
      const double vs = part * s.max_speed;
      out.push_back(Custom("stribeck", "vs " + std::to_string(vs), 3, {5e-3, 1e-2},
                           [vs](const auto& a, AxisModel& m) {
                             m.friction.Fs_plus = m.friction.Fc_plus * (1.0 + a[0]);
                             m.friction.Fs_minus = m.friction.Fc_minus * (1.0 + a[0]);
                             m.friction.vs = vs * std::exp(a[1]);
                           },
                           {0.1, 0.0}, {-0.8, -2.5}, {4.0, 2.5}));
    }
  }
  out.push_back(
      WithShorter(LinearEffect("position_friction", "", 3, Input::kLevel, Cosines(s, 1, 8), 5e-3),
                  LinearEffect("position_friction", "smooth", 3, Input::kLevel, Cosines(s, 1, 3), 5e-3)));
  out.push_back(
      WithShorter(LinearEffect("cable_spring", "", 3, Input::kLoadForce, Legendre(s, 4), 0.01 * Fc),
                  LinearEffect("cable_spring", "linear", 3, Input::kLoadForce, Legendre(s, 1), 0.01 * Fc)));
  const double top = std::max(s.max_speed, 1e-12);
  const auto speed = std::make_shared<const Signal>(s.velocity);
  const Input drag = p.nominal_.friction_on_load ? Input::kLoadForce : Input::kMotorForce;
  for (const double power : {1.5, 2.0, 3.0})
    out.push_back(WithOrder(ShapedEffect(p, "viscous_nonlinear", "power " + std::to_string(power), 3, drag,
                                         0.02 * Fc, {-0.45, 0.4},
                                         [speed, top, power](std::size_t k, double x) {
                                           const double y = (*speed)[k] / top;
                                           return -std::copysign(std::pow(std::fabs(y), power * std::exp(x)),
                                                                 y);
                                         }),
                            power));
  // Drag that gives way beyond a knee; what grows faster than the speed bends with a power, and so does what
  // the log cannot tell from it: a knee must show for itself, since its torque is told beside another linear
  // term.
  for (const double knee : {0.1, 0.3}) {
    auto shape = std::make_shared<Effect>(
        *ShapedEffect(p, "viscous_nonlinear", "knee " + std::to_string(knee), kKneeShows, drag, 0.02 * Fc,
                      {-1.0, 1.0}, [speed, top, knee](std::size_t k, double x) {
                        const double y = (*speed)[k] / top, bend = knee * std::exp(x);
                        return -y * (1.0 + bend) / (std::fabs(y) + bend);
                      }));
    shape->low[0] = 0.0;
    out.push_back(WithOrder(std::move(shape), knee));
  }
  if (Varies(s.temperature_K)) {
    const auto T = std::make_shared<const Signal>(s.temperature_K);
    out.push_back(WithShorter(AsSignals(Custom("temperature_viscosity", "and level", 2, {2e-3, 1e-3},
                                               [T](const auto& a, AxisModel& m) {
                                                 m.viscous = Add(m.viscous, {T}, {a[0]});
                                                 Enter(m, Input::kLevel, {T}, {a[1]});
                                               })),
                              LinearEffect("temperature_viscosity", "", 2, Input::kViscous, {T}, 2e-3)));
  }
  out.push_back(LinearEffect(
      "friction_drift", "linear", 3, Input::kLevel,
      {Make(n, [&](std::size_t k) { return static_cast<double>(k) / static_cast<double>(n) - 0.5; })}, 5e-3));
  for (const double tau : {0.08, 0.25})
    out.push_back(WithOrder(
        ShapedEffect(
            p, "friction_drift", "exponential " + std::to_string(tau), 3, Input::kLevel, 5e-3, {-1.2, 1.0},
            [n, tau](std::size_t k, double x) {
              return 0.5 - std::exp(-static_cast<double>(k) / static_cast<double>(n) / (tau * std::exp(x)));
            }),
        tau));
  // Over the whole band, which the smoothed acceleration does not have; constant over each row.
  out.push_back(LinearEffect(
      "load_friction", "", 1, Input::kLevel,
      {Make(2 * n, [&](std::size_t k) { return std::fabs(s.net_force[k < n ? k : k - n]) / Fc; })}, 5e-3));
  for (const double ratio : {0.03, 0.1, 0.3})
    out.push_back(Custom("presliding_hysteresis", "ratio " + std::to_string(ratio), 3, {0.03, 0.02},
                         [ratio](const auto& a, AxisModel& m) {
                           m.soft_share = std::max(0.0, a[0]);
                           m.soft_ratio = ratio * std::exp(a[1]);
                         },
                         {0.1, 0.0}, {0.0, -2.0}, {0.9, 2.0}));
}

SharedEffect ShapedEffect(const Problem& p, std::string kind, std::string label, double grid, Input input,
                          double step, std::array<double, 2> range,
                          std::function<double(std::size_t, double)> shape) {
  auto e = std::make_shared<Effect>();
  e->kind = std::move(kind);
  e->label = std::move(label);
  e->grid = grid;
  e->steps = {step, 0.01};
  e->low = {-1e30, range[0]};
  e->high = {1e30, range[1]};
  e->tested = 1;
  e->signals = true;
  if (IsForce(input)) e->force = {1, 0};
  e->apply = [shape = std::move(shape), input, made = p.made_, owner = p.made_->NewOwner()](
                 const std::vector<double>& a, AxisModel& m) {
    if (a[0] == 0.0) return;
    const auto make = [&]() -> std::vector<SharedSignal> {
      return {Make(m.rows, [&](std::size_t k) { return shape(k, a[1]); })};
    };
    Enter(m, input, made->For(owner, a[1], make), {a[0]});
  };
  return e;
}

void AddDrive(const Problem& p, std::vector<SharedEffect>& out) {
  const double rated = std::max(p.stated_.rated, 1e-12);
  out.push_back(Custom("torque_constant", "", 1, {1e-3},
                       [](const auto& a, AxisModel& m) { m.torque_gain *= 1.0 + a[0]; }, {}, {-0.7}, {2.0}));
  out.push_back(
      WithForce(Custom("torque_saturation", "", 1, {5e-3},
                       [rated](const auto& a, AxisModel& m) { m.saturation += a[0] / (rated * rated); }, {},
                       {-0.3}, {0.5}),
                {1}));
  out.push_back(Custom("input_delay", "", 1, {2e-6}, [](const auto& a, AxisModel& m) { m.delay_s += a[0]; }));
  out.push_back(Custom("current_lag", "", 1, {2e-6},
                       [](const auto& a, AxisModel& m) { m.lag_s = std::max(0.0, m.lag_s + a[0]); }));
}

void AddMechanics(const Problem& p, std::vector<SharedEffect>& out) {
  const Signals& s = *p.signals_;
  const std::size_t n = p.rows();
  const double J = p.nominal_.motor_inertia + p.nominal_.load_inertia;
  for (int i = 1; i < 20; ++i) {
    const std::size_t row = n * static_cast<std::size_t>(i) / 20;
    // The instant moves with the rest, by rows.
    const double reach_s = p.log_.period_s * static_cast<double>(n) / 30.0, period_s = p.log_.period_s;
    auto step = std::make_shared<Effect>(*Custom(
        "payload_step", "row " + std::to_string(row), 20, {2e-3, 0.05},
        [J, row, period_s](const auto& a, AxisModel& m) {
          m.payload = a[0] * J;
          m.payload_row = static_cast<std::size_t>(static_cast<double>(row) + std::round(a[1] / period_s));
        },
        {}, {-0.8, -reach_s}, {5.0, reach_s}));
    step->tested = 1;
    step->force = {1, 0};
    step->as_term = p.nominal_.two_inertia ? "load_inertia" : "inertia";
    step->from_row = row;
    step->order = p.log_.period_s * static_cast<double>(row);
    out.push_back(step);
  }
  const double R = p.stated_.table_per_q;
  if (p.nominal_.two_inertia) {
    // A resonance far from where it is stated cannot be reached step by step: full-size starts both ways.
    for (const double start : {-0.5, 0.4})
      out.push_back(Custom("compliance", start < 0.0 ? "softer" : "stiffer", 8, {5e-4, 5e-3},
                           [](const auto& a, AxisModel& m) {
                             m.stiffness *= std::exp(a[0]);
                             m.damping *= std::exp(a[1]);
                           },
                           {start, 0.0}, {-4.0, -3.0}, {3.0, 4.0}));
    for (const double gap_um : {2.0, 10.0, 40.0})
      out.push_back(Custom("backlash", std::to_string(gap_um) + " um", 3, {gap_um * 1e-6 / R},
                           [](const auto& a, AxisModel& m) { m.gap = std::max(0.0, a[0]); },
                           {gap_um * 1e-6 / R}, {0.0}, {1e-3 / R}));
  } else {
    // The stiffest are those of any screw, no fault of a model that is stated as rigid: they stand beside the
    // others so that these do not have to stand for them.
    for (const double f :
         {15.0, 25.0, 40.0, 65.0, 100.0, 140.0, 180.0, 220.0, 270.0, 340.0, 430.0, 560.0, 750.0, 1000.0})
      out.push_back(WithOrder(Custom("compliance", std::to_string(f) + " Hz", 14, {0.02, 0.02, 0.1},
                                     [f](const auto& a, AxisModel& m) {
                                       if (a[0] <= 1e-6) return;
                                       const double all = m.motor_inertia, share = std::min(a[0], 0.95);
                                       m.two_inertia = true;
                                       m.load_inertia = share * all;
                                       m.motor_inertia = (1.0 - share) * all;
                                       const double w = 2.0 * kPi * f * std::exp(a[1]);
                                       m.stiffness = m.load_inertia * w * w;
                                       m.damping = 2.0 * 0.04 * std::exp(a[2]) * w * m.load_inertia;
                                       m.friction_on_load = false;
                                     },
                                     {0.3, 0.0, 0.0}, {0.0, -0.7, -kDampingReach}, {0.9, 0.7, kDampingReach}),
                              f));
    for (const double gap_um : {2.0, 10.0, 40.0})
      out.push_back(Custom("backlash", std::to_string(gap_um) + " um", 3, {gap_um * 1e-6 / R},
                           [](const auto& a, AxisModel& m) {
                             if (a[0] <= 0.0) return;
                             const double all = m.motor_inertia;
                             m.two_inertia = true;
                             m.load_inertia = 0.4 * all;
                             m.motor_inertia = 0.6 * all;
                             const double w = 2.0 * kPi * 400.0;
                             m.stiffness = m.load_inertia * w * w;
                             m.damping = 0.1 * w * m.load_inertia;
                             m.friction_on_load = false;
                             m.gap = a[0];
                           },
                           {gap_um * 1e-6 / R}, {0.0}, {1e-3 / R}));
  }
  if (!s.axis2_m_s2.empty())
    out.push_back(LinearEffect("cross_coupling", "", 1, Input::kLoadForce,
                               {std::make_shared<const Signal>(s.axis2_m_s2)}, 0.01 * s.coulomb));
  out.push_back(WaveEffect(p, Wave::kReadingOfAngle, 1.0, 1.0));
  if (p.has_scale()) out.push_back(LinearEffect("pitch_error", "", 1, Input::kScale, Cosines(s, 1, 8), 1e-7));
  out.push_back(LinearEffect(std::string(kOutside) + "force of time", "", 1, Input::kLoadForce, Hats(n, 16),
                             0.01 * s.coulomb));
  out.push_back(LinearEffect(kFrictionOfTime, "", 1, Input::kLevel, Hats(n, 16), 5e-3));
}

}  // namespace

SharedEffect LinearEffect(std::string kind, std::string label, double grid, Input input,
                          std::vector<SharedSignal> basis, double step) {
  std::vector<double> steps(basis.size());
  for (std::size_t i = 0; i < basis.size(); ++i) {
    double largest = 0.0;
    for (const double v : *basis[i]) largest = std::max(largest, std::fabs(v));
    steps[i] = step / std::max(largest, 1e-12);
    if (input == Input::kReading || input == Input::kScale || largest <= 1e-12) steps[i] = step;
  }
  auto shared = std::make_shared<const std::vector<SharedSignal>>(std::move(basis));
  const SharedEffect e =
      Custom(std::move(kind), std::move(label), grid, std::move(steps),
             [shared, input](const auto& a, AxisModel& m) { Enter(m, input, *shared, a); });
  return AsSignals(IsForce(input) ? WithForce(e, std::vector<int>(shared->size(), 1)) : e);
}

std::vector<SharedEffect> CatalogueEffects(const Problem& problem) {
  std::vector<SharedEffect> out;
  AddFriction(problem, out);
  AddDrive(problem, out);
  AddMechanics(problem, out);
  return out;
}

SharedEffect WaveEffect(const Problem& p, Wave wave, double order, double grid) {
  const Signals& s = *p.signals_;
  const std::size_t n = p.rows();
  const bool of_time = wave == Wave::kForceOfTime;
  const double per = of_time ? 2.0 * kPi * order * p.log_.period_s : order;
  const auto phase = [&](std::size_t k) {
    return of_time ? per * static_cast<double>(k) : per * s.angle_rad[k];
  };
  std::vector<double> phases(n);
  for (std::size_t k = 0; k < n; ++k) phases[k] = phase(k);
  const std::vector<double> sizes = wave == Wave::kGainOfAngle ? s.model_torque : std::vector<double>();
  std::vector<SharedSignal> basis;
  if (wave == Wave::kReadingOfAngle)
    basis = {Make(n, [&](std::size_t k) { return std::sin(phases[k]); }),
             Make(n, [&](std::size_t k) { return std::cos(phases[k]); })};
  else
    basis = WaveSignals(phases, sizes);
  const std::string label = std::to_string(order);
  std::string kind;
  Input input = Input::kMotorForce;
  double step = 0.01 * s.coulomb;
  switch (wave) {
    case Wave::kFrictionOfAngle:
      kind = std::fabs(order - std::round(order)) < 1e-6 ? "friction_ripple" : "ball_ripple";
      input = Input::kLevel;
      step = 5e-3;
      break;
    case Wave::kTorqueOfAngle:
      kind = "cogging";
      break;
    case Wave::kReadingOfAngle:
      kind = order == 1.0 ? "encoder_eccentricity" : "encoder_subdivision";
      input = Input::kReading;
      step = p.stated_.position_step > 0.0 ? p.stated_.position_step : 1e-6;
      break;
    case Wave::kForceOfTime:
      kind = "periodic_force";
      input = Input::kLoadForce;
      break;
    case Wave::kGainOfAngle:
      kind = std::string(kOutside) + "torque constant of angle";
      break;
  }
  const bool free_order = of_time || kind == "ball_ripple";
  if (!free_order) {
    auto e = std::make_shared<Effect>(*LinearEffect(kind, label, grid, input, std::move(basis), step));
    e->order = order;
    e->wave = true;
    return e;
  }
  // The order is found to a part of a turn over the travel (of a cycle over the log), and fitted with the
  // rest.
  const auto x =
      of_time ? Make(n, [&](std::size_t k) { return 2.0 * kPi * static_cast<double>(k) * p.log_.period_s; })
              : std::make_shared<const Signal>(s.angle_rad);
  const auto [least, most] = std::minmax_element(x->begin(), x->end());
  const double middle = 0.5 * (*least + *most), span = *most - *least;
  auto e = std::make_shared<Effect>();
  e->kind = kind;
  e->label = label;
  e->grid = grid;
  e->order = order;
  e->wave = true;
  e->steps = {step, step, 0.05 / span};
  if (IsForce(input)) e->force = {1, 1, 0};
  e->tested = 2;
  e->signals = true;
  e->low = {-1e30, -1e30, -6.0 / span};
  e->high = {1e30, 1e30, 6.0 / span};
  // About the middle, so that order and phase are not the same direction; the phase is reported at zero.
  e->apply = [x, order, middle, input, n, made = p.made_, owner = p.made_->NewOwner()](
                 const std::vector<double>& a, AxisModel& m) {
    if (a[0] == 0.0 && a[1] == 0.0) return;
    const auto make = [&] {
      std::vector<double> at(n);
      for (std::size_t k = 0; k < n; ++k) at[k] = order * (*x)[k] + a[2] * ((*x)[k] - middle);
      return WaveSignals(at, {});
    };
    Enter(m, input, made->For(owner, a[2], make), {a[0], a[1]});
  };
  e->middle = middle;
  return e;
}

}  // namespace contour::diagnosis
