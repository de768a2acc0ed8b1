#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "analysis/diagnosis/tuning/screening_tuning.h"
#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

/// Blocks of time for sign flips and held-out figures.
inline constexpr Eigen::Index kBlocks = kScreening.blocks;

/// A candidate against the residual of a fit: what its amplitudes would explain beyond the base parameters,
/// to first order (score test; partial regression with the base's priors).
struct Scored {
  SharedEffect effect;
  double drop = 0.0;         ///< of chi^2 and prior
  double score = 0.0;        ///< less a penalty per amplitude and 2 ln(grid)
  double consistency = 0.0;  ///< sum over root of sum of squares of the drop per block
  Eigen::VectorXd amplitude;
  Eigen::MatrixXd covariance;  ///< of the amplitudes
  Eigen::MatrixXd per_block;   ///< projected gradient, amplitudes x blocks
  /// How much larger than white noise would make them the drops are by chance, from the scatter of the blocks
  /// and from how neighbours go together; at least 1. A residual that is not quite white, or not quite
  /// stationary, shows here, a scale that wanders from block to block too.
  double overdispersion = 1.0;
  /// The same of blocks that had nothing to do with each other: what random signs make of them.
  double within_blocks = 1.0;
};

double Penalty(const Effect& effect);

/// A coupling above half the rate of the rows cannot be told from a delay: it is one that every screw has.
double NoFault_Hz(const Problem& problem);

/// Whether the kind is a number of the base model: its evidence is in the priors.
bool InBase(const Problem& problem, const std::string& kind);

/// Of such a kind, the base terms that it frees, in the order of its amplitudes.
std::vector<std::size_t> FreedTerms(const Problem& problem, const std::string& kind);

/// Tests effects at zero amplitude in addition to whatever `fit` holds.
std::vector<Scored> ScoreEffects(const Problem& problem, const Fit& fit, std::vector<SharedEffect> effects);

/// Of the last effect of a fit, from the fit's own residual: free of what the effect explains.
double OverdispersionOfLast(const Problem& problem, const Fit& fit);

/// White innovation after a pulse of one row of motor torque (or of the reading) while the axis slides.
std::vector<double> PulseResponse(const Problem& problem, bool reading);

/// Effects that the scans over orders and frequencies propose.
std::vector<SharedEffect> ScanWaves(const Problem& problem, const Fit& fit);

/// An axis that sticks and hardly breaks away moves much later for a little less force: to first order the
/// rows of one place there have nearly all of what a column says, and none of it is to be had beyond first
/// order. No row may say as much as a block does on the average; those that do say nothing, as long as they
/// are in two places of two blocks each at most. What acts at more places, at a few reversals say, stays, and
/// so does what acts nowhere else. `rows` of every output, one output after the other.
void LeaveOutRunaways(std::vector<double>& column, std::size_t rows);

/// Of the drop of an effect of several columns, what comes from directions that the base can nearly do
/// itself: next to no information is left of them, so that what little a fit is short of its end by, divided
/// by it, is any number. `information`: of the columns once the base has taken its part; `square`: before.
double DropAlongBase(const Eigen::MatrixXd& information, const Eigen::MatrixXd& square,
                     const Eigen::VectorXd& gradient);

}  // namespace contour::diagnosis
