#pragma once

#include <vector>

#include "analysis/identification/measured.h"
#include "analysis/identification/table_axis.h"

namespace contour::identify {

/// What a drive that closes its own loop adds to the offset that it is sent, over each period of a record. It
/// reports its torque once a period; between two reports its loop goes on, and answers what the offset's step
/// sets off at once.
struct OwnForce {
  std::vector<double> at_N;      ///< at each row's instant: the report less what the offset gives by then
  std::vector<double> mean_N;    ///< from each row to the next
  std::vector<double> offset_N;  ///< at each row's instant, behind delay and lag
};

/// `data` has reports (Measured::reported_N). The mean is that of a band-limited force through the reports,
/// and what the drive answers to the offset's steps within a period (TableAxis::answer).
OwnForce OwnForceOf(const TableAxis& axis, const Measured& data);

/// Whether the drive's own force is the same for both axes, of the same record.
bool SameOwnForce(const TableAxis& a, const TableAxis& b);

/// Mean of a force over a share of the period, from its values at both ends of the period and its mean.
double PartOfPeriod_N(double from_N, double to_N, double mean_N, double begin, double end);

}  // namespace contour::identify
