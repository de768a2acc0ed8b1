#include "daemon/start_again.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "config/config_error.h"
#include "daemon/loaded_model.h"
#include "tests/support/scratch_directory.h"

namespace contour {
namespace {

TEST(NextFile, CountsUpToOneThatIsNotThere) {
  const test::ScratchDirectory scratch;
  const std::string log = (scratch.path() / "run.log").string();
  EXPECT_EQ(NextFile(""), "");
  EXPECT_EQ(NextFile(log), log + ".1");
  EXPECT_EQ(NextFile(log + ".1"), log + ".2");
  std::ofstream(log + ".1") << "kept";
  EXPECT_EQ(NextFile(log), log + ".2") << "no log is written over";
}

TEST(WithModel, OneModelForEachAxisAndNoneWhereItIsTakenAway) {
  DaemonOptions options;
  options.models = {"x=a", "y=b"};
  options = WithModel(options, "x={lead_mm: 5}");
  EXPECT_EQ(options.models, (std::vector<std::string>{"y=b", "x={lead_mm: 5}"}));
  EXPECT_EQ(WithModel(options, "x=").models, (std::vector<std::string>{"y=b"}));
}

TEST(WithNewStart, LogAndTruthGoOnInFilesOfTheirOwn) {
  const test::ScratchDirectory scratch;
  DaemonOptions options;
  options.log = (scratch.path() / "run.log").string();
  options.models = {"x=a"};
  options.torque_loops = {"x=old"};
  options.torque_models = {"x=older"};
  options.csp_axes = {"x"};
  const DaemonOptions modelled = WithNewStart(options, {"x={lead_mm: 5}", {}});
  EXPECT_EQ(modelled.log, options.log + ".1");
  EXPECT_EQ(modelled.truth, "");
  EXPECT_EQ(modelled.models, (std::vector<std::string>{"x={lead_mm: 5}"}));
  EXPECT_EQ(modelled.torque_loops, options.torque_loops) << "a model is loaded in the mode that runs";
  const DaemonOptions back = WithNewStart(modelled, {{}, RecordingMode{}});
  EXPECT_TRUE(back.torque_loops.empty());
  EXPECT_TRUE(back.torque_models.empty());
  EXPECT_TRUE(back.csp_axes.empty());
  EXPECT_EQ(WithNewStart(back, {{}, RecordingMode{{}, {}, {"x", "y"}}}).csp_axes,
            (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(back.models, modelled.models);
}

TEST(Describe, SaysWhatBeginsAnew) {
  EXPECT_EQ(Describe({"x={lead_mm: 5}", {}}), "with another model of axis x");
  EXPECT_EQ(Describe({{}, RecordingMode{{"x=a"}, {}}}), "in torque mode for commissioning");
  EXPECT_EQ(Describe({{}, RecordingMode{{}, {}, {"x"}}}), "in csp for commissioning");
  EXPECT_EQ(Describe({{}, RecordingMode{}}), "in the machine file's own mode");
}

TEST(ArgumentsOf, AreReadAsTheSameOptions) {
  DaemonOptions options;
  options.config = "a machine.yaml";
  options.buses = {"can0", "can1"};
  options.clock = "lockstep";
  options.controller = "full";
  options.set = {"machine.name=-x", "axes.x.limits.position_mm=[-1, 1]"};
  options.models = {"x=lead_mm: 5\nfriction: {a: 1}\n"};
  options.torque_loops = {"x=regulator_Hz: 20\n", "y={regulator_Hz: 10}"};
  options.torque_models = {"x={lead_mm: 5}"};
  options.csp_axes = {"x", "y"};
  options.log = "l";
  options.truth = "t";
  options.socket = "/s";
  std::vector<std::string> arguments = ArgumentsOf(options);
  std::vector<char*> words;
  for (std::string& a : arguments) words.push_back(a.data());
  DaemonOptions read;
  ASSERT_EQ(ParseOptions(static_cast<int>(words.size()), words.data(), read), ParseResult::kRun);
  EXPECT_EQ(ArgumentsOf(read), ArgumentsOf(options));
  EXPECT_EQ(read.models, options.models);
  EXPECT_EQ(read.torque_loops, options.torque_loops);
  EXPECT_EQ(read.torque_models, options.torque_models);
  EXPECT_EQ(read.csp_axes, options.csp_axes);
  EXPECT_EQ(read.set, options.set);
  EXPECT_EQ(read.buses, options.buses);
}

TEST(LoadedModel, StandsInPlaceOfTheMachineFilesOwn) {
  EXPECT_EQ(ModelOverride("x={lead_mm: 5}"), "axes.x.model={lead_mm: 5}");
  EXPECT_THROW(ModelOverride("{lead_mm: 5}"), ConfigError);
  EXPECT_TRUE(LoadedModelTexts({}).empty());
  const std::vector<std::string> told = LoadedModelTexts({"y=b", "x={lead_mm: 5}"});
  ASSERT_EQ(told.size(), 2u);
  EXPECT_NE(told[1].find("axis x"), std::string::npos);
  EXPECT_EQ(WithoutModelOf("x", {"axes.x.model={a: 1}", "axes.y.model={a: 1}", "axes.x.model.lead_mm=5"}),
            (std::vector<std::string>{"axes.y.model={a: 1}", "axes.x.model.lead_mm=5"}));
}

}  // namespace
}  // namespace contour
