#include "analysis/diagnosis/causes/effect_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/prediction_error/wave_signals.h"

namespace contour::diagnosis {
namespace {

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

}  // namespace

bool IsForce(Input input) { return input == Input::kMotorForce || input == Input::kLoadForce; }

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

std::vector<SharedSignal> HatsOverTime(std::size_t rows, int count) {
  std::vector<SharedSignal> out;
  const double width = static_cast<double>(rows) / (count - 1);
  for (int j = 0; j < count; ++j)
    out.push_back(Make(rows, [&](std::size_t k) {
      return std::max(0.0, 1.0 - std::fabs(static_cast<double>(k) / width - j));
    }));
  return out;
}

SharedEffect Custom(GridPlace place, Amplitudes amplitudes,
                    std::function<void(const std::vector<double>&, AxisModel&)> apply) {
  auto e = std::make_shared<Effect>();
  e->kind = std::move(place.kind);
  e->label = std::move(place.label);
  e->grid = place.places;
  e->steps = std::move(amplitudes.steps);
  e->apply = std::move(apply);
  e->start = std::move(amplitudes.start);
  e->low = std::move(amplitudes.low);
  e->high = std::move(amplitudes.high);
  e->tested = e->start.empty() ? e->steps.size() : 1;
  return e;
}

bool AtItsBound(const Problem& /*problem*/, const Effect& effect, const std::vector<double>& amplitudes) {
  const double size = amplitudes[0], step = effect.steps[0];
  return size > effect.high[0] - step || size < effect.low[0] + step;
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

SharedEffect LinearEffect(GridPlace place, Input input, std::vector<SharedSignal> basis, double step) {
  std::vector<double> steps(basis.size());
  for (std::size_t i = 0; i < basis.size(); ++i) {
    double largest = 0.0;
    for (const double v : *basis[i]) largest = std::max(largest, std::fabs(v));
    steps[i] = step / std::max(largest, 1e-12);
    if (input == Input::kReading || input == Input::kScale || largest <= 1e-12) steps[i] = step;
  }
  auto shared = std::make_shared<const std::vector<SharedSignal>>(std::move(basis));
  const SharedEffect e =
      Custom(std::move(place), {.steps = std::move(steps)},
             [shared, input](const auto& a, AxisModel& m) { Enter(m, input, *shared, a); });
  return AsSignals(IsForce(input) ? WithForce(e, std::vector<int>(shared->size(), 1)) : e);
}

SharedEffect ShapedEffect(const Problem& p, GridPlace place, Input input, double step,
                          std::array<double, 2> range, std::function<double(std::size_t, double)> shape) {
  auto e = std::make_shared<Effect>();
  e->kind = std::move(place.kind);
  e->label = std::move(place.label);
  e->grid = place.places;
  e->steps = {step, 0.01};
  e->low = {-1e30, range[0]};
  e->high = {1e30, range[1]};
  e->tested = 1;
  e->signals = true;
  if (IsForce(input)) e->force = {1, 0};
  e->apply = [shape = std::move(shape), input, made = p.signal_cache, owner = p.signal_cache->NewOwner()](
                 const std::vector<double>& a, AxisModel& m) {
    if (a[0] == 0.0) return;
    const auto make = [&]() -> std::vector<SharedSignal> {
      return {Make(m.rows, [&](std::size_t k) { return shape(k, a[1]); })};
    };
    Enter(m, input, made->For(owner, a[1], make), {a[0]});
  };
  return e;
}

}  // namespace contour::diagnosis
