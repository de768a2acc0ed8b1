#include "analysis/diagnosis/report/diagnosis_text.h"

#include <gtest/gtest.h>

#include <set>
#include <sstream>
#include <string>

#include "tests/analysis/diagnosis/report/example_diagnosis.h"

namespace contour::diagnosis {
namespace {

using test::Example;

TEST(DiagnosisText, TextSaysWhatHowSureAndWhatNext) {
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

/// What the text of a cause with this gain says about it, lines joined.
std::string GainSaid(double gain, double low, double high) {
  Diagnosis d = Example();
  d.causes[0].heldout_gain = gain;
  d.causes[0].heldout_gain_low = low;
  d.causes[0].heldout_gain_high = high;
  std::istringstream words(DiagnosisText(d));
  std::string out;
  for (std::string word; words >> word;) out += word + " ";
  const std::size_t at = out.find("Gain on data");
  return out.substr(at, out.find(").", at) - at);
}

TEST(DiagnosisText, AResidualThatGrowsIsSoMuchMore) {
  const auto says = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  const std::string less = GainSaid(0.25, 0.125, 0.5);
  EXPECT_TRUE(says(less, "25 % less (95 %: 12.5 % to 50 % less")) << less;
  const std::string either = GainSaid(-0.04379, -0.125, 0.0625);
  EXPECT_TRUE(says(either, "4.379 % more (95 %: 12.5 % more to 6.25 % less")) << either;
  const std::string more = GainSaid(-0.25, -0.5, -0.125);
  EXPECT_TRUE(says(more, "25 % more (95 %: 50 % to 12.5 % more")) << more;
}

TEST(DiagnosisText, OfALinearAxisInNewtons) {
  Diagnosis d = Example();
  d.fitted.emplace();
  d.fitted->linear = true;
  d.causes[0].parameters["stiffness_Nm_rad"] = {4e6, 3e6, 5e6};
  const std::string text = DiagnosisText(d);
  EXPECT_NE(text.find("0.0191 N "), std::string::npos) << text;
  EXPECT_NE(text.find("4000000 N/m"), std::string::npos) << text;
}

TEST(DiagnosisText, EveryVerdictIsASentenceOfItsOwn) {
  std::set<std::string> sentences;
  Diagnosis d;
  for (const Verdict v : {Verdict::kCauseFound, Verdict::kAmbiguous, Verdict::kNothingFound,
                          Verdict::kUnexplained, Verdict::kInsufficientData}) {
    d.verdict = v;
    sentences.insert(VerdictText(d));
    EXPECT_NE(VerdictText(d).find('.'), std::string::npos);
  }
  EXPECT_EQ(sentences.size(), 5u);
}

TEST(DiagnosisText, CountsItsCausesAndSaysHowOftenItAlarms) {
  Diagnosis d = Example();
  d.verdict = Verdict::kCauseFound;
  EXPECT_EQ(VerdictText(d), "One cause was found.");
  d.causes.push_back(d.causes[0]);
  EXPECT_EQ(VerdictText(d), "2 causes were found.");
  EXPECT_NE(DiagnosisText(d).find("\n2. cogging"), std::string::npos);
  d.verdict = Verdict::kNothingFound;
  EXPECT_NE(VerdictText(d).find("1 % of all cases"), std::string::npos);
}

TEST(DiagnosisText, NotesAndRefitsAreToldWhereThereAreSome) {
  Diagnosis d = Example();
  EXPECT_EQ(DiagnosisText(d).find("Note:"), std::string::npos);
  EXPECT_EQ(DiagnosisText(d).find("refits"), std::string::npos);
  d.notes = {"Something small is left."};
  d.bootstrap_runs = 100;
  EXPECT_NE(DiagnosisText(d).find("Note: Something small is left."), std::string::npos);
  EXPECT_NE(DiagnosisText(d).find("from 100 refits"), std::string::npos);
}

}  // namespace
}  // namespace contour::diagnosis
