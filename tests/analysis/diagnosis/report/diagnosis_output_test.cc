#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/kind_words.h"
#include "analysis/diagnosis/report/diagnosis_json.h"
#include "analysis/diagnosis/report/diagnosis_text.h"

namespace contour::diagnosis {
namespace {

Diagnosis Example() {
  Diagnosis d;
  d.verdict = Verdict::kAmbiguous;
  Cause c;
  c.kind = "cogging";
  c.parameters["amplitude_Nm"] = {0.0191, 0.0185, 0.0197};
  c.parameters["order_per_rev"] = {12, 12, 12};
  c.log_evidence_gain = 345.6;
  c.heldout_rms_before = 0.02;
  c.heldout_rms_after = 0.01;
  c.heldout_gain = 0.5;
  c.heldout_gain_low = 0.45;
  c.heldout_gain_high = std::numeric_limits<double>::quiet_NaN();
  c.unit = "Nm";
  c.indistinguishable_from = {"friction_ripple"};
  c.deciding_experiment = "Sweep both ways.";
  d.causes = {c};
  d.not_excited = {"backlash", "temperature_viscosity"};
  d.smallest_detectable["cogging"]["amplitude_Nm"] = 0.001;
  d.false_alarm_rate = 0.01;
  d.data_quality = {100, 1, 2, 3};
  return d;
}

TEST(DiagnosisOutputTest, JsonHasTheKeysOfTheInterface) {
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

TEST(DiagnosisOutputTest, TextSaysWhatHowSureAndWhatNext) {
  const std::string text = DiagnosisText(Example());
  for (const char* part : {"cannot tell", "cogging: a torque", "0.0191 Nm", "345.6 nats", "50 % less",
                           "friction_ripple", "Sweep both ways.", "Next: Feed the torque forward.",
                           "3 outliers", "backlash and temperature_viscosity"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  for (std::size_t at = 0, end = 0; end != std::string::npos; at = end + 1) {
    end = text.find('\n', at);
    EXPECT_LE((end == std::string::npos ? text.size() : end) - at, 100u);
  }
}

TEST(DiagnosisOutputTest, EveryKindHasWords) {
  for (const CauseDefinition* cause : AllCauses()) {
    const std::string_view kind = cause->name;
    EXPECT_GT(KindWords(kind).size(), kind.size() + 5) << kind;
    EXPECT_FALSE(KindAdvice(kind).empty()) << kind;
  }
  EXPECT_EQ(ValueWords("amplitude_rel", 0.25), "25 %");
  EXPECT_EQ(ValueWords("stiffness_Nm_rad", 12.5), "12.5 Nm/rad");
  EXPECT_EQ(ParameterWords("torque_at_stroke_end_Nm"), "torque at stroke end");
}

}  // namespace
}  // namespace contour::diagnosis
