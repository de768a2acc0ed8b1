#pragma once

#include <algorithm>
#include <string>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/prediction_error/fit.h"
#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis::test {

/// A short log of a made axis that is as stated but for its effects, and the nominal fit to it.
struct FittedAxis {
  static HiddenOptions Short(std::vector<HiddenEffect> effects, std::uint64_t seed = 4) {
    HiddenOptions o;
    o.seed = seed;
    o.duration_s = 8.0;
    o.parameter_spread = 0.0;
    o.scale = o.temperature = o.axis2 = false;
    o.effects = std::move(effects);
    return o;
  }

  explicit FittedAxis(const HiddenOptions& options)
      : made(MakeHiddenAxis(options)), base(FitPoint(made.problem, made.point)) {}
  explicit FittedAxis(std::vector<HiddenEffect> effects = {}) : FittedAxis(Short(std::move(effects))) {}

  /// The first of a kind on its grid.
  [[nodiscard]] SharedEffect Of(const std::string& kind) const {
    const std::vector<SharedEffect> all = CatalogueEffects(made.problem);
    return *std::find_if(all.begin(), all.end(), [&](const SharedEffect& e) { return e->kind == kind; });
  }

  /// The base and one effect, fitted together.
  [[nodiscard]] Fit With(const SharedEffect& effect) const {
    Point point = base.point;
    point.effects.push_back(effect);
    point.amplitudes.emplace_back(effect->steps.size(), 0.0);
    return FitPoint(made.problem, point);
  }

  LearntProblem made;
  const Problem& problem = made.problem;
  Fit base;
};

}  // namespace contour::diagnosis::test
