#include "analysis/diagnosis/report/report_data.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "tests/analysis/diagnosis/report/example_diagnosis.h"
#include "tests/support/scratch_directory.h"

namespace contour::diagnosis {
namespace {

class ReportDataTest : public testing::Test {
 protected:
  nlohmann::json Written(const Diagnosis& found, const std::optional<ContourGain>& contour = {}) const {
    WriteReportData(folder_.path(), log_, stated_, found, "model.yaml", contour);
    std::ifstream in(folder_.path() / "report_data.json");
    return nlohmann::json::parse(in);
  }

  ReportDataTest() {
    log_.source = "run.csv";
    stated_.friction.Fc_plus = 0.06;
    stated_.friction.Fc_minus = 0.04;
  }

  contour::test::ScratchDirectory folder_;
  AxisLog log_;
  StatedAxis stated_;
};

TEST_F(ReportDataTest, HasTheVerdictTheCausesAndTheQuality) {
  const nlohmann::json json = Written(test::Example());
  EXPECT_EQ(json["log"], "run.csv");
  EXPECT_EQ(json["Fc"], 0.05);
  EXPECT_EQ(json["verdict"], "ambiguous");
  EXPECT_EQ(json["causes"][0]["kind"], "cogging");
  EXPECT_EQ(json["causes"][0]["parameters"][0]["name"], "amplitude");
  EXPECT_EQ(json["causes"][0]["parameters"][0]["value"], "0.0191 Nm");
  EXPECT_TRUE(json["causes"][0]["gain_high"].is_null()) << "no number is null";
  EXPECT_EQ(json["detectable"][0]["size"], "0.001 Nm");
  EXPECT_EQ(json["quality"]["outliers"], 3);
  EXPECT_TRUE(json["contour_gain"].is_null());
  EXPECT_EQ(Written(test::Example(), ContourGain{"circle.yaml", 8.0, 2.0})["contour_gain"]["before_um"], 8.0);
}

TEST_F(ReportDataTest, SignalsAreInTheBinaryFileInTheOrderOfTheirNames) {
  Diagnosis d = test::Example();
  d.traces.time_s = {0.0, 1.0, 2.0};
  d.traces.residual_after = {7.0, 8.0};
  const nlohmann::json traces = Written(d)["traces"];
  std::ifstream in(folder_.path() / "report_traces.bin", std::ios::binary);
  for (const auto& [name, count] : traces.get<std::vector<std::pair<std::string, std::size_t>>>()) {
    std::vector<double> values(count);
    in.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(double)));
    ASSERT_TRUE(in) << name;
    if (name == "time_s") {
      EXPECT_EQ(values, d.traces.time_s);
    }
    if (name == "residual_after") {
      EXPECT_EQ(values, d.traces.residual_after);
    }
  }
  EXPECT_EQ(in.peek(), std::ifstream::traits_type::eof());
}

TEST_F(ReportDataTest, CandidatesNumbersBlocksAndShapesAreTold) {
  Diagnosis d = test::Example();
  d.candidates = {{"cogging", 12.5, 0.0 / 0.0, true}};
  d.base = {{"inertia", 1e-4, 1.1e-4, 1e-6}};
  d.blocks = {{0.0, 2.0, 0.5}};
  d.causes[0].shapes = {{"position_mm", "torque_Nm", {-1.0, 1.0}, {0.1, 0.2}, {0.01, 0.02}}};
  const nlohmann::json json = Written(d);
  EXPECT_EQ(json["candidates"][0]["score"], 12.5);
  EXPECT_TRUE(json["candidates"][0]["refitted"].is_null());
  EXPECT_EQ(json["base"][0]["fitted"], 1.1e-4);
  EXPECT_EQ(json["blocks"][0], nlohmann::json::array({0.0, 2.0, 0.5}));
  EXPECT_EQ(json["causes"][0]["shapes"][0]["y"], nlohmann::json::array({0.1, 0.2}));
}

// A file that others have open, or that is half written when the process ends, is never the report's.
TEST_F(ReportDataTest, TheSignalsTakeTheOldFilesPlaceWhenTheyAreWhole) {
  Diagnosis d = test::Example();
  d.traces.time_s = {0.0, 1.0};
  Written(d);
  const auto file = folder_.path() / "report_traces.bin";
  std::ifstream old(file, std::ios::binary);
  const auto bytes = std::filesystem::file_size(file);
  d.traces.time_s.assign(1000, 0.0);
  Written(d);
  EXPECT_GT(std::filesystem::file_size(file), bytes);
  old.seekg(0, std::ios::end);
  EXPECT_EQ(static_cast<std::uintmax_t>(old.tellg()), bytes) << "it was written over";
}

TEST_F(ReportDataTest, AFileThatCannotBeWrittenIsNamed) {
  try {
    WriteReportData(folder_.path() / "not_there", log_, stated_, test::Example(), "", {});
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("not_there"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace contour::diagnosis
