#include "analysis/diagnosis/report/draw.h"

#include <gtest/gtest.h>

#include <string>

#include "core/exit_status.h"

namespace contour::diagnosis {
namespace {

TEST(Draw, AScriptThatFailsSaysWhatIsNeeded) {
  try {
    Draw("no_such_script.py", {});
    FAIL() << "nothing was thrown";
  } catch (const EnvironmentError& e) {
    const std::string what = e.what();
    EXPECT_NE(what.find("no_such_script.py"), std::string::npos) << what;
    EXPECT_NE(what.find("status 2"), std::string::npos) << what;
    EXPECT_NE(what.find("python3-matplotlib"), std::string::npos) << what;
  }
}

TEST(Draw, AScriptGetsItsArguments) {
  // Every one of the scripts tells what it takes when it is asked, and refuses what it does not know.
  EXPECT_NO_THROW(Draw("plot_diagnosis.py", {"--help"}));
  EXPECT_THROW(Draw("plot_diagnosis.py", {"--no-such-option"}), EnvironmentError);
}

}  // namespace
}  // namespace contour::diagnosis
