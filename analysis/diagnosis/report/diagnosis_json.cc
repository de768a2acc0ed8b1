#include "analysis/diagnosis/report/diagnosis_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/axis_model/extension_keys.h"
#include "analysis/diagnosis/report/diagnosis_text.h"

namespace contour::diagnosis {
namespace {

using Json = nlohmann::ordered_json;

Json Number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json ContourJson(const ContourGain& c) {
  return {{"program", c.program},
          {"peak_before_um", Number(c.before_um)},
          {"peak_after_um", Number(c.after_um)},
          {"gain", Number(c.gain())}};
}

Json CauseJson(const Cause& cause, ExtensionUnits units) {
  Json parameters = Json::object();
  for (const auto& [name, p] : cause.parameters)
    parameters[RenamedToFile(units, name)] = {{"value", Number(p.value)},
                                              {"ci95", {Number(p.low), Number(p.high)}}};
  return {{"kind", cause.kind},
          {"part_of_it", cause.part_of_it},
          {"parameters", parameters},
          {"log_evidence_gain", Number(cause.log_evidence_gain)},
          {"heldout_rms_before", Number(cause.heldout_rms_before)},
          {"heldout_rms_after", Number(cause.heldout_rms_after)},
          {"heldout_gain", Number(cause.heldout_gain)},
          {"heldout_gain_ci95", {Number(cause.heldout_gain_low), Number(cause.heldout_gain_high)}},
          {"unit", cause.unit},
          {"indistinguishable_from", cause.indistinguishable_from},
          {"deciding_experiment", cause.deciding_experiment}};
}

Json BaseJson(const Diagnosis& d) {
  Json out = Json::object();
  for (const BaseParameter& p : d.base)
    out[p.name] = {{"stated", Number(p.stated)}, {"fitted", Number(p.fitted)}, {"sigma", Number(p.sigma)}};
  return out;
}

Json ErrorsJson(const Diagnosis& d) {
  if (d.model_errors.empty() || !d.fitted) return nullptr;
  Json out = {{"unit", d.fitted->linear ? "m" : "rad"}, {"free_run_s", d.free_run_s}};
  for (const ForecastError& e : d.model_errors)
    out[e.model] = {{"one_step", {{"used", Number(e.one_step_used)}, {"unseen", Number(e.one_step_unseen)}}},
                    {"free_run", {{"used", Number(e.free_run_used)}, {"unseen", Number(e.free_run_unseen)}}}};
  return out;
}

}  // namespace

std::string VerdictName(Verdict verdict) {
  switch (verdict) {
    case Verdict::kCauseFound:
      return "cause_found";
    case Verdict::kAmbiguous:
      return "ambiguous";
    case Verdict::kNothingFound:
      return "nothing_found";
    case Verdict::kUnexplained:
      return "unexplained";
    case Verdict::kInsufficientData:
      break;
  }
  return "insufficient_data";
}

std::string DiagnosisJson(const Diagnosis& d, const std::string& extended_model,
                          const std::optional<ContourGain>& contour) {
  const ExtensionUnits units = UnitsIn(d);
  Json causes = Json::array();
  for (const Cause& cause : d.causes) causes.push_back(CauseJson(cause, units));
  Json detectable = Json::object();
  for (const auto& [kind, sizes] : d.smallest_detectable) {
    detectable[kind] = Json::object();
    for (const auto& [name, size] : sizes) detectable[kind][RenamedToFile(units, name)] = Number(size);
  }
  const Json json = {{"verdict", VerdictName(d.verdict)},
                     {"causes", causes},
                     {"not_excited", d.not_excited},
                     {"smallest_detectable", detectable},
                     {"false_alarm_rate", d.false_alarm_rate},
                     {"bootstrap_runs", d.bootstrap_runs},
                     {"data_quality",
                      {{"rows", d.data_quality.rows},
                       {"missing", d.data_quality.missing},
                       {"stale", d.data_quality.stale},
                       {"outliers", d.data_quality.outliers}}},
                     {"base_model", BaseJson(d)},
                     {"model_errors", ErrorsJson(d)},
                     {"extended_model", extended_model.empty() ? Json(nullptr) : Json(extended_model)},
                     {"contour_gain", contour ? ContourJson(*contour) : Json(nullptr)},
                     {"notes", d.notes}};
  return json.dump(2) + "\n";
}

}  // namespace contour::diagnosis
