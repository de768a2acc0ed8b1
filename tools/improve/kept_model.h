#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace contour::improve {

/// The same program drawn again and again: its largest error in each pass, um.
struct Repeats {
  std::vector<double> before_um, after_um;
};

/// What two sets of repeats say of each other. Largest errors scatter in proportion to their size: what draws
/// ten times better repeats ten times better, and one scatter in micrometres would hide it.
struct Comparison {
  double before_um = 0.0, after_um = 0.0;  ///< means
  double repeatability_um = 0.0;           ///< lower than before by less than this is chance
  double log_ratio = 0.0;                  ///< mean logarithm after less the one before
  double log_chance = 0.0;                 ///< of that, what is chance
  double log_deviation = 0.0;              ///< its standard deviation
  double resolution_um = 0.0;              ///< a smaller difference is none
  [[nodiscard]] bool better() const {
    return -log_ratio > log_chance && before_um - after_um > resolution_um;
  }
  [[nodiscard]] bool worse() const { return log_ratio > log_chance && Rises(); }
  /// By more than repeats usually differ: not proof, but reason enough to leave things as they are.
  [[nodiscard]] bool higher() const { return log_ratio > log_deviation && Rises(); }
  /// The same as repeatability_um of an error that rises, with another limit of the logarithm.
  [[nodiscard]] double Rise_um(double log_limit) const {
    return std::max(resolution_um, before_um * std::expm1(log_limit));
  }

 private:
  [[nodiscard]] bool Rises() const { return after_um - before_um > resolution_um; }
};

/// The value that Student's t exceeds with `probability`, at most one half.
double StudentQuantile(std::size_t freedom, double probability);

/// Student's test of two mean logarithms with one scatter, one-sided at 2.5 % for all `candidates` that are
/// to be compared, and never below `resolution_um`, what the place of measurement tells apart. Two repeats on
/// either side at least: std::invalid_argument.
Comparison Compare(const Repeats& repeats, double resolution_um, std::size_t candidates = 1);

struct Judgement {
  bool keep = false;
  std::string why;  ///< a sentence
};

/// The new model is kept where the program that it was not fitted on is better and the other one not higher.
Judgement Judge(const Comparison& path, const Comparison& check);

}  // namespace contour::improve
