#include "analysis/diagnosis/quantification/slow_torque.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "analysis/prediction_error/stands_out.h"
#include "config/number_text.h"

namespace contour::diagnosis {

void TellSlowTorque(const Problem& problem, Diagnosis& out) {
  const Signal& left = out.traces.residual_after;
  const double period_s = problem.log.period_s;
  // Windows that overlap by half.
  const auto step = static_cast<std::size_t>(0.5 * out.free_run_s / period_s);
  if (step == 0) return;
  const auto window = static_cast<std::ptrdiff_t>(2 * step);
  std::vector<double> means;
  for (std::size_t from = 0; from + 2 * step <= left.size(); from += step) {
    const auto counted = problem.counted.begin() + static_cast<std::ptrdiff_t>(from);
    // What an encoder that jumps leaves is no torque.
    if (std::count(counted, counted + window, std::uint8_t{0}) != 0) {
      means.push_back(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    const auto begin = left.begin() + static_cast<std::ptrdiff_t>(from);
    means.push_back(std::accumulate(begin, begin + window, 0.0) / static_cast<double>(2 * step));
  }
  // What wanders all the time stands out nowhere, and friction may be off by so much as it is.
  const StatedFriction& friction = problem.nominal.friction;
  const double level = 0.5 * (friction.Fc_plus + friction.Fc_minus);
  const double least = StatedSigma(problem.stated, "Fc") * level;
  StandsOut stands_out(means, 0.0);
  std::size_t count = 0, at = 0;
  for (std::size_t i = 0; i < means.size(); ++i) {
    if (!(std::fabs(means[i]) > least) || !stands_out(i)) continue;
    if (count++ == 0 || std::fabs(means[i]) > std::fabs(means[at])) at = i;
  }
  if (count == 0) return;
  const bool linear = problem.log.linear;
  const double begin_s = period_s * static_cast<double>(at * step);
  out.notes.push_back(std::string("The ") + (linear ? "force" : "torque") +
                      " that the model does not have, averaged over " + RoundedText(out.free_run_s) +
                      " s, goes up to " + RoundedText(means[at]) + (linear ? " N" : " Nm") + " from " +
                      RoundedText(begin_s) + " s on (" + RoundedText(100.0 * std::fabs(means[at]) / level) +
                      " % of Coulomb friction), far beyond what it is most of the time: a force from outside "
                      "(a cut, a hand, a cable that catches)? The fit has taken it for noise.");
}

}  // namespace contour::diagnosis
