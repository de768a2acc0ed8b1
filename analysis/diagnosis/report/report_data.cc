#include "analysis/diagnosis/report/report_data.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "analysis/diagnosis/causes/kind_words.h"
#include "analysis/diagnosis/report/diagnosis_json.h"
#include "analysis/diagnosis/report/diagnosis_text.h"
#include "config/whole_file.h"

namespace contour::diagnosis {
namespace {

using Json = nlohmann::ordered_json;

Json Number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json Numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double v : values) list.push_back(Number(v));
  return list;
}

Json CauseJson(const Cause& c, ExtensionUnits units) {
  Json parameters = Json::array();
  for (const auto& [in_Nm, p] : c.parameters) {
    const std::string name = RenamedToFile(units, in_Nm);
    parameters.push_back({{"name", ParameterWords(name)},
                          {"value", ValueWords(name, p.value)},
                          {"low", ValueWords(name, p.low)},
                          {"high", ValueWords(name, p.high)}});
  }
  Json shapes = Json::array();
  for (const ShapeTable& t : c.shapes)
    shapes.push_back({{"abscissa", t.abscissa},
                      {"ordinate", t.ordinate},
                      {"x", Numbers(t.x)},
                      {"y", Numbers(t.y)},
                      {"sigma", Numbers(t.sigma)}});
  return {{"kind", c.kind},
          {"part_of_it", c.part_of_it},
          {"words", KindWords(c.kind)},
          {"advice", KindAdvice(c.kind)},
          {"parameters", parameters},
          {"evidence", Number(c.log_evidence_gain)},
          {"before", Number(c.heldout_rms_before)},
          {"after", Number(c.heldout_rms_after)},
          {"gain", Number(c.heldout_gain)},
          {"gain_low", Number(c.heldout_gain_low)},
          {"gain_high", Number(c.heldout_gain_high)},
          {"unit", c.unit},
          {"indistinguishable_from", c.indistinguishable_from},
          {"experiment", c.deciding_experiment},
          {"program", c.deciding_program},
          {"shapes", shapes}};
}

Json DetectableJson(const Diagnosis& d) {
  Json rows = Json::array();
  for (const auto& [kind, sizes] : d.smallest_detectable)
    for (const auto& [in_Nm, size] : sizes) {
      const std::string name = RenamedToFile(UnitsIn(d), in_Nm);
      rows.push_back({{"kind", kind}, {"name", ParameterWords(name)}, {"size", ValueWords(name, size)}});
    }
  return rows;
}

Json CandidatesJson(const Diagnosis& d) {
  Json rows = Json::array();
  for (const Candidate& c : d.candidates)
    rows.push_back({{"kind", c.kind},
                    {"score", Number(c.score)},
                    {"refitted", Number(c.refitted)},
                    {"accepted", c.accepted}});
  return rows;
}

Json BaseJson(const Diagnosis& d) {
  Json rows = Json::array();
  for (const BaseParameter& p : d.base)
    rows.push_back({{"name", p.name},
                    {"stated", Number(p.stated)},
                    {"fitted", Number(p.fitted)},
                    {"sigma", Number(p.sigma)}});
  return rows;
}

Json BlocksJson(const Diagnosis& d) {
  Json rows = Json::array();
  for (const BlockGain& b : d.blocks) rows.push_back({b.start_s, b.end_s, Number(b.gain)});
  return rows;
}

/// Signals into the binary file; their names and lengths in order.
Json WriteTraces(const std::filesystem::path& file, const Traces& t) {
  std::string bytes;
  Json list = Json::array();
  const std::pair<const char*, const std::vector<double>*> signals[] = {
      {"time_s", &t.time_s},
      {"position", &t.position},
      {"velocity", &t.velocity},
      {"acceleration", &t.acceleration},
      {"measured", &t.measured},
      {"simulated_before", &t.simulated_before},
      {"simulated_after", &t.simulated_after},
      {"residual_before", &t.residual_before},
      {"residual_after", &t.residual_after},
      {"scale_before", &t.scale_before},
      {"scale_after", &t.scale_after},
      {"temperature_degC", &t.temperature_degC}};
  for (const auto& [name, signal] : signals) {
    list.push_back({name, signal->size()});
    bytes.append(reinterpret_cast<const char*>(signal->data()), signal->size() * sizeof(double));
  }
  WriteWholeFile(file, bytes);
  return list;
}

}  // namespace

void WriteReportData(const std::filesystem::path& dir, const AxisLog& log, const StatedAxis& stated,
                     const Diagnosis& found, const std::string& extended_model,
                     const std::optional<ContourGain>& contour) {
  Json causes = Json::array();
  for (const Cause& c : found.causes) causes.push_back(CauseJson(c, UnitsIn(found)));
  Json gain = nullptr;
  if (contour)
    gain = {
        {"program", contour->program}, {"before_um", contour->before_um}, {"after_um", contour->after_um}};
  const Json json = {{"log", log.source},
                     {"model", stated.source},
                     {"linear", log.linear},
                     {"table_per_q", stated.table_per_q},
                     {"lead_m", stated.lead_m},
                     {"gear_ratio", stated.gear_ratio},
                     {"rated", stated.rated},
                     {"Fc", 0.5 * (stated.friction.Fc_plus + stated.friction.Fc_minus)},
                     {"verdict", VerdictName(found.verdict)},
                     {"verdict_text", VerdictText(found)},
                     {"causes", causes},
                     {"contour_gain", gain},
                     {"extended_model", extended_model},
                     {"false_alarm_rate", found.false_alarm_rate},
                     {"gate", Number(found.threshold)},
                     {"not_excited", found.not_excited},
                     {"detectable", DetectableJson(found)},
                     {"candidates", CandidatesJson(found)},
                     {"base", BaseJson(found)},
                     {"blocks", BlocksJson(found)},
                     {"notes", found.notes},
                     {"quality",
                      {{"rows", found.data_quality.rows},
                       {"missing", found.data_quality.missing},
                       {"stale", found.data_quality.stale},
                       {"outliers", found.data_quality.outliers}}},
                     {"traces", WriteTraces(dir / "report_traces.bin", found.traces)}};
  WriteWholeFile(dir / "report_data.json", json.dump() + "\n");
}

}  // namespace contour::diagnosis
