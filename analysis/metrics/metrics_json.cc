#include "analysis/metrics/metrics_json.h"

#include <nlohmann/json.hpp>

#include "config/whole_file.h"

namespace contour {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json OrNull(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json ContourJson(const ContourMetrics& m) {
  return {{"rms_um", OrNull(m.rms_um)},
          {"peak_um", OrNull(m.peak_um)},
          {"circular_deviation_um", OrNull(m.circular_deviation_um)},
          {"quadrant_peak_um", OrNull(m.quadrant_peak_um)}};
}

template <class Field>
Json PerAxisJson(const RunMetrics& metrics, Field field) {
  Json object = Json::object();
  for (const AxisMetrics& axis : metrics.axes) object[axis.axis] = field(axis);
  return object;
}

}  // namespace

std::string MetricsJson(const RunFacts& facts, const RunMetrics& metrics) {
  Json json;
  json["controller"] = facts.controller;
  json["program"] = facts.program;
  json["seed"] = OrNull(facts.seed);
  json["cycle_us"] = facts.cycle_us;
  json["cycles"] = facts.cycles;
  json["late_cycles"] = OrNull(facts.late_cycles);
  json["stale_cycles"] = facts.stale_cycles;
  json["contour"] = {{"encoder", ContourJson(metrics.encoder)}, {"table", ContourJson(metrics.table)}};
  json["friction_estimate_error_rms_N"] =
      PerAxisJson(metrics, [](const AxisMetrics& a) { return OrNull(a.friction_estimate_error_rms_N); });
  json["torque_saturated_fraction"] =
      PerAxisJson(metrics, [](const AxisMetrics& a) { return Json(a.torque_saturated_fraction); });
  json["encoder_pp_counts"] = OrNull(metrics.encoder_pp_counts);
  json["following_error"] = PerAxisJson(metrics, [](const AxisMetrics& a) {
    return Json{{"rms_um", OrNull(a.following_error_rms_um)}, {"peak_um", OrNull(a.following_error_peak_um)}};
  });
  json["scored_cycles"] = metrics.scored_cycles;
  return json.dump(2) + "\n";
}

void WriteMetrics(const std::filesystem::path& file, const RunFacts& facts, const RunMetrics& metrics) {
  WriteWholeFile(file, MetricsJson(facts, metrics));
}

}  // namespace contour
