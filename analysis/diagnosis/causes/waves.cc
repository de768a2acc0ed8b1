#include "analysis/diagnosis/causes/waves.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/prediction_error/wave_signals.h"

namespace contour::diagnosis {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

const CauseDefinition& CauseOf(Wave wave, double order) {
  for (const CauseDefinition* c : AllCandidates()) {
    const WaveSource* source = c->wave;
    if (source != nullptr && *source->wave == wave && (*source->has_order)(order)) return *c;
  }
  throw std::logic_error("no cause is a wave of this kind and order");
}

struct Entrance {
  Input input = Input::kMotorForce;
  double step = 0.0;
};

Entrance EntranceOf(Wave wave, const Problem& p) {
  const double torque = 0.01 * p.signals->ForceScale();
  switch (wave) {
    case Wave::kFrictionOfAngle:
      return {Input::kLevel, 5e-3};
    case Wave::kReadingOfAngle:
      return {Input::kReading, p.stated.position_step > 0.0 ? p.stated.position_step : 1e-6};
    case Wave::kForceOfTime:
      return {Input::kLoadForce, torque};
    case Wave::kTorqueOfAngle:
    case Wave::kGainOfAngle:
      break;
  }
  return {Input::kMotorForce, torque};
}

/// By how much the angle is read too large where it is read, with X and Y the error and its slope as if the
/// angle were the true one: x = X cos x - Y sin x, by a Newton step from where the sine is straight.
double AtTheAngleAsRead(double X, double Y) {
  const double x = X / (1.0 + Y);
  return x - x * x * (X - Y * x / 3.0) / (2.0 * (1.0 + Y + X * x));
}

/// An error of the reading is a wave of the true angle: over the angle as read it has waves of twice and
/// three times the order, too.
void EnterAsRead(const std::vector<SharedSignal>& basis, double phase_per_q, const std::vector<double>& a,
                 AxisModel& m) {
  const double slope = phase_per_q * std::hypot(a[0], a[1]);
  // At 1 the reading stands still once a period, and tells no angle.
  if (!(slope < 1.0)) return Enter(m, Input::kReading, basis, a);
  const Signal &sine = *basis[0], &cosine = *basis[1];
  const SharedSignal error = Make(sine.size(), [&](std::size_t k) {
    const double X = phase_per_q * (a[0] * sine[k] + a[1] * cosine[k]);
    const double Y = phase_per_q * (a[0] * cosine[k] - a[1] * sine[k]);
    return AtTheAngleAsRead(X, Y) / phase_per_q;
  });
  Enter(m, Input::kReading, {error}, {1.0});
}

/// At an order that stays.
SharedEffect FixedOrder(const Problem& p, Wave wave, double order, double grid, std::string kind) {
  const Signals& s = *p.signals;
  const std::size_t n = p.rows();
  std::vector<double> phases(n);
  for (std::size_t k = 0; k < n; ++k) phases[k] = order * s.angle_rad[k];
  std::vector<SharedSignal> basis;
  if (wave == Wave::kReadingOfAngle)
    basis = {Make(n, [&](std::size_t k) { return std::sin(phases[k]); }),
             Make(n, [&](std::size_t k) { return std::cos(phases[k]); })};
  else
    basis = WaveSignals(phases, wave == Wave::kGainOfAngle ? s.model_torque : std::vector<double>());
  const Entrance at = EntranceOf(wave, p);
  auto e = std::make_shared<Effect>(
      *LinearEffect({std::move(kind), std::to_string(order), grid}, at.input, basis, at.step));
  e->order = order;
  e->wave = true;
  // Faster waves the smoothed angle does not have.
  if (wave == Wave::kReadingOfAngle && order == 1.0)
    e->apply = [basis, per_q = s.angle_per_q](const std::vector<double>& a, AxisModel& m) {
      EnterAsRead(basis, per_q, a, m);
    };
  return e;
}

SharedEffect FreeOrder(const Problem& p, Wave wave, double order, double grid, std::string kind) {
  const Signals& s = *p.signals;
  const std::size_t n = p.rows();
  const auto x = wave == Wave::kForceOfTime
                     ? Make(n,
                            [&](std::size_t k) {
                              return 2.0 * std::numbers::pi * static_cast<double>(k) * p.log.period_s;
                            })
                     : std::make_shared<const Signal>(s.angle_rad);
  const auto [least, most] = std::minmax_element(x->begin(), x->end());
  const double middle = 0.5 * (*least + *most), span = *most - *least;
  const auto [input, step] = EntranceOf(wave, p);
  auto e = std::make_shared<Effect>();
  e->kind = std::move(kind);
  e->label = std::to_string(order);
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
  e->apply = [x, order, middle, into = input, n, made = p.signal_cache, owner = p.signal_cache->NewOwner()](
                 const std::vector<double>& a, AxisModel& m) {
    if (a[0] == 0.0 && a[1] == 0.0) return;
    const auto make = [&] {
      std::vector<double> at(n);
      for (std::size_t k = 0; k < n; ++k) at[k] = order * (*x)[k] + a[2] * ((*x)[k] - middle);
      return WaveSignals(at, {});
    };
    Enter(m, into, made->For(owner, a[2], make), {a[0], a[1]});
  };
  e->middle = middle;
  return e;
}

}  // namespace

bool IsWholeOrder(double order) { return std::fabs(order - std::round(order)) < 1e-6; }
bool AnyOrder(double) { return true; }

SharedEffect WaveEffect(const Problem& problem, Wave wave, double order, double grid) {
  const CauseDefinition& cause = CauseOf(wave, order);
  std::string kind(*cause.name);
  return cause.wave->free_order ? FreeOrder(problem, wave, order, grid, std::move(kind))
                                : FixedOrder(problem, wave, order, grid, std::move(kind));
}

bool ReadsWithMoreSlope(const Problem& problem, const Effect& effect, const std::vector<double>& a,
                        double most_slope) {
  return std::hypot(a[0], a[1]) * problem.signals->angle_per_q * effect.order > most_slope;
}

NamedValues WaveParameters(const FittedEffect& fitted, const char* amplitude, const char* order,
                           double scale) {
  const std::vector<double>& a = fitted.amplitudes();
  NamedValues v{{amplitude, std::hypot(a[0], a[1]) * scale}};
  const double shift = a.size() > 2 ? a[2] : 0.0;
  if (order != nullptr) v[order] = fitted.effect().order + shift;
  const double phase = std::atan2(a[1], a[0]) - shift * fitted.effect().middle;
  v["phase_rad"] = std::remainder(phase, kTwoPi);
  return v;
}

}  // namespace contour::diagnosis
