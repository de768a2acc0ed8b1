#pragma once

#include <cmath>
#include <memory>
#include <random>

#include "analysis/prediction_error/kalman_pass.h"
#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis::test {

/// An axis that slides and sticks for 40 s, made once.
inline const LearntProblem& SlidingAndStuck() {
  static const LearntProblem made([] {
    HiddenOptions o;
    o.seed = 5;
    o.duration_s = 40.0;
    o.parameter_spread = 0.0;
    o.scale = false;
    return MakeHiddenAxis(o);
  }());
  return made;
}

/// Of its reading: what rounding makes.
inline double ReadingVariance() { return std::pow(SlidingAndStuck().problem.stated.position_step, 2) / 12.0; }

/// Its linearised model with the innovations that noise alone makes.
inline std::shared_ptr<const LinearModel> MovedBy(const NoiseVariances& noise) {
  auto model = std::make_shared<LinearModel>(SlidingAndStuck().problem.noise.linear());
  const std::size_t n = model->rows;
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  const double white = std::sqrt(noise.torque), deviation = std::sqrt(noise.slow);
  auto torque = std::make_shared<Signal>(2 * n), reading = std::make_shared<Signal>(n);
  double slow = deviation * normal(random);
  for (std::size_t k = 0; k < n; ++k) {
    const double next =
        noise.keep * slow + deviation * std::sqrt(1.0 - noise.keep * noise.keep) * normal(random);
    const double over_row = white * normal(random);
    (*torque)[k] = over_row + slow;
    (*torque)[n + k] = over_row + next;
    slow = next;
    (*reading)[k] = std::sqrt(noise.reading) * normal(random);
  }
  LinearInput input;
  input.motor_force = torque;
  input.reading_error = reading;
  model->innovation = LinearColumns(*model, std::span(&input, 1), false)[0].innovation;
  return model;
}

}  // namespace contour::diagnosis::test
