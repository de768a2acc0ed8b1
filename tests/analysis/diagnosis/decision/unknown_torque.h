#pragma once

#include <gtest/gtest.h>

#include <string>

#include "analysis/diagnosis/decision/hypotheses.h"
#include "analysis/diagnosis/screening/score.h"
#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis::test {

/// A log of an axis with a constant torque of 0.3 Fc that the model does not have, and what may explain it.
class UnknownTorque : public testing::Test {
 protected:
  [[nodiscard]] Hypothesis Of(const std::string& kind) const {
    Hypothesis h;
    h.fit = axis_.With(axis_.Of(kind));
    h.score = axis_.base.cost - h.fit.cost - Penalty(h.effect());
    return h;
  }

  FittedAxis axis_{{{"constant_torque", 0.3, 0.0, 0.0, 0.0}}};
};

}  // namespace contour::diagnosis::test
