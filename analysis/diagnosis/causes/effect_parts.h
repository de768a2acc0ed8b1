#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "analysis/prediction_error/problem.h"

// What effects are made of.
namespace contour::diagnosis {

/// Of an amplitude, to that side.
inline constexpr double kNoBound = std::numeric_limits<double>::infinity();

/// One of the model's inputs, which a signal scaled by an amplitude enters.
enum class Input { kMotorForce, kLoadForce, kLevel, kViscous, kReading, kScale };
bool IsForce(Input input);

template <class F>
SharedSignal Make(std::size_t rows, F&& at) {
  auto s = std::make_shared<Signal>(rows);
  for (std::size_t k = 0; k < rows; ++k) (*s)[k] = at(k);
  return s;
}

/// A signal and further ones, each times its amplitude.
SharedSignal Add(const SharedSignal& before, const std::vector<SharedSignal>& basis,
                 const std::vector<double>& a);

/// Into one of the model's inputs. Levels multiply: what is there already has the effect in its proportion.
void Enter(AxisModel& m, Input input, const std::vector<SharedSignal>& basis, const std::vector<double>& a);

/// A place of a cause's grid; `places`: so many were looked at to find this one.
struct GridPlace {
  std::string kind;
  std::string label;  ///< for people
  double places = 1.0;
};

/// The amplitudes of an effect: see Effect.
struct Amplitudes {
  std::vector<double> steps;
  std::vector<double> start = {}, low = {}, high = {};
};

SharedEffect Custom(GridPlace place, Amplitudes amplitudes,
                    std::function<void(const std::vector<double>&, AxisModel&)> apply);

/// A size as large, or as small, as it may become: the log says nothing of it.
bool AtItsBound(const Problem& problem, const Effect& effect, const std::vector<double>& amplitudes);

SharedEffect AsSignals(const SharedEffect& e);
SharedEffect WithShorter(const SharedEffect& e, SharedEffect shorter);
SharedEffect WithOrder(const SharedEffect& e, double order);
SharedEffect WithForce(const SharedEffect& e, std::vector<int> force);

/// Triangles of height 1 over the log's time, each from its neighbour's top to the other's.
std::vector<SharedSignal> HatsOverTime(std::size_t rows, int count);

/// Signals, each with an amplitude. `step`: of the largest element.
SharedEffect LinearEffect(GridPlace place, Input input, std::vector<SharedSignal> basis, double step);

/// A signal times an amplitude, its shape by a second number that is 0 at the grid's place and fitted with
/// the rest.
SharedEffect ShapedEffect(const Problem& p, GridPlace place, Input input, double step,
                          std::array<double, 2> range, std::function<double(std::size_t, double)> shape);

}  // namespace contour::diagnosis
