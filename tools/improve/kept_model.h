#pragma once

#include <string>
#include <vector>

namespace contour::improve {

/// The same program drawn again and again: its largest error in each pass, um.
struct Repeats {
  std::vector<double> before_um, after_um;
};

/// What two sets of repeats say of each other.
struct Comparison {
  double before_um = 0.0, after_um = 0.0;  ///< means
  double repeatability_um = 0.0;           ///< a difference of the means below it is chance
  double deviation_um = 0.0;               ///< standard deviation of that difference
  [[nodiscard]] bool better() const { return before_um - after_um > repeatability_um; }
  [[nodiscard]] bool worse() const { return after_um - before_um > repeatability_um; }
  /// By more than repeats usually differ: not proof, but reason enough to leave things as they are.
  [[nodiscard]] bool higher() const { return after_um - before_um > deviation_um; }
};

/// The value that Student's t exceeds with `probability`, at most one half.
double StudentQuantile(std::size_t freedom, double probability);

/// Student's test of two means with one scatter, one-sided at 2.5 % for all `candidates` that are to be
/// compared, and never below `resolution_um`, what the place of measurement tells apart. Two repeats on
/// either side at least: std::invalid_argument.
Comparison Compare(const Repeats& repeats, double resolution_um, std::size_t candidates = 1);

struct Judgement {
  bool keep = false;
  std::string why;  ///< a sentence
};

/// The new model is kept where the program that it was not fitted on is better and the other one not higher.
Judgement Judge(const Comparison& path, const Comparison& check);

}  // namespace contour::improve
