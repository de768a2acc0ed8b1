#include "analysis/diagnosis/quantification/stated_off.h"

#include <cmath>
#include <cstddef>
#include <string>

#include "analysis/diagnosis/tuning/decision_tuning.h"
#include "config/number_text.h"

namespace contour::diagnosis {

void TellStatedOff(const Problem& problem, const Point& fitted, Diagnosis& out) {
  std::string numbers;
  for (std::size_t i = 0; i < problem.terms.size(); ++i) {
    const BaseTerm& t = problem.terms[i];
    if (t.nuisance || t.additive) continue;
    if (std::pow(fitted.base[i] / t.sigma, 2) < kAcceptance.no_chance_score) continue;
    numbers += (numbers.empty() ? "" : ", ") + t.name + " " + RoundedText(std::exp(fitted.base[i])) +
               " times what is stated (to " + RoundedText(100.0 * t.sigma) + " %)";
  }
  if (numbers.empty()) return;
  out.notes.push_back(
      "The log fits the model with other numbers than are stated only: " + numbers +
      ". Correct them, or their uncertainty, and diagnose again; a wrong torque constant makes "
      "all of them wrong by one factor.");
}

}  // namespace contour::diagnosis
