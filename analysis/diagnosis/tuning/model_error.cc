#include "analysis/diagnosis/tuning/model_error.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace contour::diagnosis {
namespace {

// The first line is that of all kinds that have none of their own, together. Made by
//   contour_hidden --judge cases --only clean,clear --fit-above-chance --evidence scores.csv
//   contour_hidden --calibrate scores.csv > analysis/diagnosis/tuning/model_error_table.inc
constexpr ErrorScore kTable[] = {
#include "analysis/diagnosis/tuning/model_error_table.inc"
};

const ErrorScore& Of(std::string_view kind) {
  const auto* const it =
      std::find_if(std::begin(kTable), std::end(kTable), [&](const ErrorScore& e) { return e.kind == kind; });
  return it == std::end(kTable) ? kTable[0] : *it;
}

double AllShares() {
  double sum = 0.0;
  for (const ErrorScore& e : kTable)
    if (!IsStructureClass(e.kind)) sum += e.share;
  return sum;
}

}  // namespace

double AllowancePerRow(std::string_view kind, double false_alarm_rate) {
  // Have parts of the rate for themselves.
  if (IsStructureClass(kind))
    return 1e-5 * Of(kind).scale * std::max(0.0, std::log(Of(kind).share / false_alarm_rate));
  // Each kind alarms in proportion to how often it exceeds: exp(-allowance / scale) is the same for all.
  static const double all = AllShares();
  return 1e-5 * Of(kind).scale * std::max(0.0, std::log(all / false_alarm_rate));
}

double LeakageShare(std::string_view kind) { return Of(kind).leakage; }

double LeakageShareOfItsKind(std::string_view kind) { return Of(kind).leakage_of_its_kind; }

}  // namespace contour::diagnosis
