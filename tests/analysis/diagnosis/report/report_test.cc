#include "analysis/diagnosis/report/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "analysis/diagnosis/report/diagnosis_text.h"
#include "core/exit_status.h"
#include "tests/analysis/diagnosis/report/example_diagnosis.h"
#include "tests/support/scratch_directory.h"

namespace contour::diagnosis {
namespace {

TEST(Report, WithoutItsFolderNothingIsDrawn) {
  const contour::test::ScratchDirectory folder;
  try {
    WriteReport(folder.path() / "not_there", {}, {}, test::Example(), "");
    FAIL() << "nothing was thrown";
  } catch (const EnvironmentError& e) {
    FAIL() << "python was asked: " << e.what();
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("not_there"), std::string::npos) << e.what();
  }
}

TEST(Report, IsOnePageWithWhatWasFound) {
  const contour::test::ScratchDirectory folder;
  Diagnosis found = test::Example();
  Traces& t = found.traces;
  for (std::size_t k = 0; k < 4000; ++k) {
    const double time_s = 1e-3 * static_cast<double>(k), ripple = 0.01 * std::sin(12.0 * time_s);
    t.time_s.push_back(time_s);
    t.position.push_back(40.0 * std::sin(time_s));
    t.velocity.push_back(40.0 * std::cos(time_s));
    t.acceleration.push_back(-40.0 * std::sin(time_s));
    t.measured.push_back(0.03 + ripple);
    t.simulated_before.push_back(0.03);
    t.simulated_after.push_back(0.03 + ripple);
    t.residual_before.push_back(ripple);
    t.residual_after.push_back(0.0);
  }
  StatedAxis stated;
  stated.table_per_q = 8e-4;
  stated.lead_m = 5e-3;
  stated.rated = 0.6;
  stated.friction.Fc_plus = stated.friction.Fc_minus = 0.03;
  ASSERT_NO_THROW(WriteReport(folder.path(), {}, stated, found, "extended_model.yaml"));
  std::ifstream in(folder.path() / "report.html");
  std::stringstream page;
  page << in.rdbuf();
  EXPECT_NE(page.str().find("cogging"), std::string::npos);
  EXPECT_NE(page.str().find(VerdictText(found)), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "report_data.json"));
}

}  // namespace
}  // namespace contour::diagnosis
