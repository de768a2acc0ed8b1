#include "analysis/diagnosis/report/diagnosis_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "tests/analysis/diagnosis/report/example_diagnosis.h"

namespace contour::diagnosis {
namespace {

using test::Example;

TEST(DiagnosisJson, JsonHasTheKeysOfTheInterface) {
  const auto json = nlohmann::json::parse(DiagnosisJson(Example(), "out/model.yaml"));
  EXPECT_EQ(json["verdict"], "ambiguous");
  const auto& cause = json["causes"][0];
  EXPECT_EQ(cause["kind"], "cogging");
  EXPECT_EQ(cause["parameters"]["amplitude_Nm"]["value"], 0.0191);
  EXPECT_EQ(cause["parameters"]["amplitude_Nm"]["ci95"], nlohmann::json::array({0.0185, 0.0197}));
  EXPECT_EQ(cause["heldout_gain_ci95"][0], 0.45);
  EXPECT_TRUE(cause["heldout_gain_ci95"][1].is_null());
  for (const char* key : {"log_evidence_gain", "heldout_rms_before", "heldout_rms_after", "heldout_gain",
                          "unit", "indistinguishable_from", "deciding_experiment"})
    EXPECT_TRUE(cause.contains(key)) << key;
  EXPECT_EQ(json["not_excited"].size(), 2u);
  EXPECT_EQ(json["smallest_detectable"]["cogging"]["amplitude_Nm"], 0.001);
  EXPECT_EQ(json["false_alarm_rate"], 0.01);
  EXPECT_EQ(json["data_quality"],
            nlohmann::json({{"rows", 100}, {"missing", 1}, {"stale", 2}, {"outliers", 3}}));
  EXPECT_EQ(json["extended_model"], "out/model.yaml");
}

// Before: a linear axis had stiffness_Nm_rad, with a number in N/m.
TEST(DiagnosisJson, KeysOfALinearAxisAreInItsUnits) {
  Diagnosis d = Example();
  d.fitted.emplace();
  d.fitted->linear = true;
  d.causes[0].parameters["stiffness_Nm_rad"] = {4e6, 3e6, 5e6};
  const auto json = nlohmann::json::parse(DiagnosisJson(d, ""));
  const auto& told = json["causes"][0]["parameters"];
  EXPECT_EQ(told["stiffness_N_m"]["value"], 4e6);
  EXPECT_EQ(told["amplitude_N"]["value"], 0.0191);
  EXPECT_FALSE(told.contains("stiffness_Nm_rad"));
  EXPECT_EQ(json["smallest_detectable"]["cogging"]["amplitude_N"], 0.001);
}

TEST(DiagnosisJson, WithoutAnExtendedModelAndAContourThereIsNull) {
  const auto json = nlohmann::json::parse(DiagnosisJson(Example(), ""));
  EXPECT_TRUE(json["extended_model"].is_null());
  EXPECT_TRUE(json["contour_gain"].is_null());
}

TEST(DiagnosisJson, TheContourGainIsRelative) {
  const auto json = nlohmann::json::parse(DiagnosisJson(Example(), "", ContourGain{"circle.yaml", 8.0, 2.0}));
  EXPECT_EQ(json["contour_gain"]["program"], "circle.yaml");
  EXPECT_EQ(json["contour_gain"]["peak_before_um"], 8.0);
  EXPECT_EQ(json["contour_gain"]["peak_after_um"], 2.0);
  EXPECT_EQ(json["contour_gain"]["gain"], 0.75);
}

TEST(DiagnosisJson, EveryVerdictHasAName) {
  std::set<std::string> names;
  for (const Verdict v : {Verdict::kCauseFound, Verdict::kAmbiguous, Verdict::kNothingFound,
                          Verdict::kUnexplained, Verdict::kInsufficientData})
    names.insert(VerdictName(v));
  EXPECT_EQ(names, (std::set<std::string>{"cause_found", "ambiguous", "nothing_found", "unexplained",
                                          "insufficient_data"}));
}

}  // namespace
}  // namespace contour::diagnosis
