#include "analysis/diagnosis/quantification/column_lag.h"

#include <algorithm>
#include <string>

#include "analysis/diagnosis/causes/catalogue.h"
#include "config/number_text.h"

namespace contour::diagnosis {

void TellColumnLag(const Problem& problem, const Point& fitted, Diagnosis& out) {
  if (!problem.log.from_velocity) return;
  std::string text = "The log has no position: it was integrated from the velocity. ";
  if (std::any_of(fitted.effects.begin(), fitted.effects.end(),
                  [](const SharedEffect& e) { return *CauseNamed(e->kind).about_timing; })) {
    const AxisModel m = problem.Build(fitted);
    const double more_s = m.delay_s + m.lag_s - problem.nominal.delay_s - problem.nominal.lag_s;
    text += "The velocity comes " + RoundedText(1e6 * more_s) +
            " us later than the model's delay and lag say; the fit has it so. ";
  }
  out.notes.push_back(
      text +
      "A filter of that column looks like a delay, a lag, a coupling or a play of the axis: none of "
      "these is told. Record the position to see them.");
}

}  // namespace contour::diagnosis
