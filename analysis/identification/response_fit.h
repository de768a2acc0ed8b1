#pragma once

#include <optional>
#include <vector>

#include "analysis/identification/screw_response.h"
#include "analysis/identification/table_axis.h"

namespace contour::identify {

/// Motor, table, screw and a part of the table that swings, as the response of the sliding axis shows them:
/// where a fit of the time series may begin. Antiresonances stand apart in a response, whatever lies between
/// them, while the errors of a time series hardly tell a place from the next far from the end. Friction stays
/// as it is in `axis`. None where too little of the response is coherent, or nothing fits it.
std::optional<TableAxis> FitResponse(const TableAxis& axis, const std::vector<ResponsePoint>& response,
                                     double period_s);

}  // namespace contour::identify
