#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "analysis/diagnosis/result/finding.h"
#include "tools/validation/hidden/hidden_case.h"

namespace contour::hidden {

/// Whether a kind is none of the catalogue: then `unexplained` without a name is right.
bool OutsideCatalogue(const std::string& kind);

/// A true parameter of a hidden effect, and what is told of it; NaN where nothing is.
struct ToldSize {
  std::string name;
  double truth = 0.0;
  diagnosis::Interval told;
  double smallest = 0.0;  ///< that would have been found, as the same answer has it
};

/// How an answer compares with what was hidden. Causes that only name how the plant differs from what a model
/// can express (Misfit) are left out before it is judged.
struct Judged {
  bool right = false;   ///< the hidden kind first, or in a set of at most two that is first; clean: no cause,
                        ///< and `unexplained` only where there is a misfit to be found; outside the
                        ///< catalogue: `unexplained`, and no cause
  bool both = false;    ///< of two: each is among the causes, or in a set of two that is
  bool itself = false;  ///< the hidden kind is a cause, not only in another one's set
  bool inside = false;  ///< every true parameter within its stated interval
  double gain = 0.0;    ///< held-out, of the cause that is right
  int extra = 0;        ///< accepted causes beyond what was hidden
  std::string answer;   ///< "cogging", "cogging|periodic_force", "nothing_found", ...
  double evidence = 0.0;  ///< that the cause which is right was accepted with; nats
  std::vector<ToldSize> sizes;
  std::string outside;  ///< parameters whose truth lies outside: "amplitude_Nm 0.01 not in [..]"
};

/// The kinds of a cause: itself and what it cannot be told from.
std::set<std::string> SetOf(const diagnosis::Cause& cause);

Judged Judge(const diagnosis::Diagnosis& answer, const std::vector<Hidden>& hidden, Misfit misfit);

/// Smallest count of successes among `n` that happens by chance less than `chance` of the time when each
/// succeeds with `p`: fewer than this fails a diagnoser that keeps to its specification at most so often.
int LowestCredible(int n, double p, double chance);

}  // namespace contour::hidden
