#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/tuning/model_error.h"
#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

/// Rows sorted into bins of some quantity; rows that say nothing have none.
struct BinnedRows {
  std::string over;          ///< in plain words: "the position and the direction"
  std::vector<int> bin;      ///< per row; negative: none
  std::vector<double> size;  ///< per row: what a unit in the bin does there; empty: 1 everywhere
  int count = 0;
  std::function<std::string(int)> place;  ///< of a bin, in plain words
  Quantity quantity = Quantity::kTime;
  /// Causes of it come as a series, order by order: what is left are further orders, which make no name
  /// wrong.
  bool series = false;
  std::string_view structure_class = kUnexplainedAll;  ///< whose model-error allowance it has
};

/// What a residual still has of one quantity, whatever its shape: the drop of chi^2 by a torque (or a level
/// of friction) that is free in every bin.
struct RemainingStructure {
  std::string over;
  Quantity quantity = Quantity::kTime;
  bool series = false;
  std::string_view structure_class = kUnexplainedAll;
  double asked = 0.0;  ///< the score that something unknown must exceed
  double drop = 0.0;
  double bins = 0.0;    ///< that the drop is of by chance: those that what was taken out left free
  double score = 0.0;   ///< -2 ln of how probable that drop is by chance
  std::string at;       ///< where most of it is
  double amount = 0.0;  ///< there, missing from the model: a torque (force)
};

/// `gradient` of |r|^2 / 2 by a torque at each row, `response` of the white residual to a pulse of one,
/// `weight` per row of that residual. What is constant in each bin of `known` is taken out first.
RemainingStructure TestBins(const BinnedRows& rows, const BinnedRows& known, std::vector<double> gradient,
                            const std::vector<double>& response, const std::vector<double>& weight);

/// Of the residual of a fit, for every quantity, the one that is furthest beyond what is asked of it first.
/// To first order and of slides only; base and effects are not fitted again in addition to the bins, which
/// makes the drop a little less than it could be.
std::vector<RemainingStructure> FindStructure(const Problem& problem, const Fit& fit,
                                              double false_alarm_rate);

}  // namespace contour::diagnosis
