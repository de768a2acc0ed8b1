#pragma once

#include <Eigen/Core>
#include <vector>

#include "analysis/identification/simulation.h"

namespace contour::identify {

/// Short windows of all records, one after the other, and what each stands for. What a model has not comes
/// again wherever the axis does the same: at one frequency of the force, at one speed. The gradients of such
/// windows do not scatter about zero by chance, however far apart in time they are.
struct SpreadWindows {
  Eigen::Index length = 1;        ///< rows
  std::vector<double> quickness;  ///< grows with the frequency of the force
  std::vector<double> velocity_m_s;
};
SpreadWindows WindowsOf(const std::vector<Measured>& records);

/// Variance of each parameter by the scatter of what windows contribute (one a row), in groups of those that
/// are alike in `key`: the widest of several numbers of groups.
Eigen::VectorXd ScatterOverGroups(const Eigen::MatrixXd& contributions, const std::vector<double>& key);

/// How far two halves of a record disagree about each parameter, those windows whose `key` is below the
/// middle one's and the others: the difference of the steps that each half alone would take.
struct HalvesApart {
  Eigen::VectorXd distance;
  /// In its standard deviations (`noise` is the variance of a residual): about one where the model is the
  /// axis.
  Eigen::VectorXd deviations;
};
HalvesApart Disagreement(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residual,
                         const Eigen::VectorXd& prior_sigma, double noise, const SpreadWindows& windows,
                         const std::vector<double>& key);

/// So few groups say little of how far they scatter: Student's 95 % interval over that of a normal
/// distribution, to first order, squared.
double FewGroupsFactor(double groups);

}  // namespace contour::identify
