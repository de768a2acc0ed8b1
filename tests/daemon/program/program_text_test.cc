#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/daemon/program/on_a_table.h"

namespace contour {
namespace {

using testing::ErrorOf;
using testing::Yaml;

TEST(ProgramText, CircleWithAllItsKeys) {
  const Program program =
      Yaml("shape: circle\nradius_mm: 0.1\nfrequency_hz: 0.125\nturns: 5\ndirection: cw\naxes: [y, x]\n");
  const auto& circle = std::get<CircleShape>(program.shape);
  EXPECT_EQ(circle.radius_mm, 0.1);
  EXPECT_EQ(circle.feed.frequency_hz, 0.125);
  EXPECT_FALSE(circle.feed.feed_mm_min.has_value());
  EXPECT_EQ(circle.turns, 5);
  EXPECT_EQ(circle.direction, Direction::kCw);
  EXPECT_EQ(circle.axes, (PlaneAxes{"y", "x"}));
  EXPECT_EQ(program.name, "test.yaml");
}

TEST(ProgramText, DiamondIsNotASquare) {
  const std::string rest = "\nside_mm: 10\nfeed_mm_min: 3000\ncorners: exact_stop\n";
  EXPECT_EQ(std::get<DiamondShape>(Yaml("shape: diamond" + rest).shape).corners, Corners::kExactStop);
  EXPECT_EQ(std::get<SquareShape>(Yaml("shape: square" + rest).shape).side_mm, 10.0);
}

TEST(ProgramText, CornersHaveAModeOrATolerance) {
  const std::string text = "shape: square\nside_mm: 10\nfeed_mm_min: 3000\n";
  EXPECT_EQ(std::get<SquareShape>(Yaml(text + "corner_tolerance_mm: 0.005\n").shape).corner_tolerance_mm,
            0.005);
  EXPECT_FALSE(std::get<SquareShape>(Yaml(text).shape).corner_tolerance_mm.has_value());
}

struct Wrong {
  const char* text;
  const char* message;  ///< must be contained
};

TEST(ProgramText, ErrorsNamePlaceAndExpectation) {
  const Wrong wrong[] = {
      {"radius_mm: 1\n", "test.yaml: shape: missing"},
      {"shape: square\nside_mm: 1\nfeed_mm_min: 100\ncorner_tolerance_mm: 0\n",
       "test.yaml:4: corner_tolerance_mm"},
      {"shape: square\nside_mm: 1\nfeed_mm_min: 100\ncorners: velocity_jump\ncorner_tolerance_mm: 0.1\n",
       "test.yaml:5: corner_tolerance_mm: corners is given as well"},
      {"shape: circle\nradius_mm: 1\nfeed_mm_min: 100\ncorner_tolerance_mm: 0.1\n",
       "test.yaml:4: corner_tolerance_mm"},
      {"# a comment\nshape: helix\n", "test.yaml:2: shape: found 'helix'"},
      {"shape: circle\nradius_mm: 1\nfeed: 100\n", "test.yaml:3: feed"},
      {"shape: circle\nfeed_mm_min: 100\n", "radius_mm"},
      {"shape: circle\nradius_mm: -1\nfeed_mm_min: 100\n", "test.yaml:2: radius_mm"},
      {"shape: circle\nradius_mm: big\nfeed_mm_min: 100\n", "test.yaml:2: radius_mm"},
      {"shape: circle\nradius_mm: 1\nfeed_mm_min: 100\ndirection: left\n", "test.yaml:4: direction"},
      {"shape: circle\nradius_mm: 1\nfeed_mm_min: 100\nturns: 0\n", "test.yaml:4: turns"},
      {"shape: circle\nradius_mm: 1\nfeed_mm_min: 100\nturns: 1.5\n", "test.yaml:4: turns"},
      {"shape: circle\nradius_mm: 1\n", "feed_mm_min or frequency_hz: missing"},
      {"shape: circle\nradius_mm: 1\nfeed_mm_min: 1\nfrequency_hz: 1\n", "test.yaml:4: frequency_hz"},
      {"shape: circle\nradius_mm: 1\nfeed_mm_min: 1\naxes: [x, x]\n", "two different axes"},
      {"shape: line\nfeed_mm_min: 100\n", "dx_mm, dy_mm: both are zero"},
      {"shape: hold\nseconds: 0\n", "test.yaml:2: seconds"},
      {"shape: creep\naxis: x\nstroke_mm: 1\nvelocities_mm_s: []\n", "test.yaml:4: velocities_mm_s"},
      {"shape: sweep\naxis: x\nvelocity_mm_s: 1\nfrequency_min_hz: 5\nfrequency_max_hz: 2\nseconds: 3\n",
       "test.yaml:5: frequency_max_hz"},
      {"shape: torque_steps\naxis: x\ntravel_mm: 0.1\ntorques_Nm: [0.1, 0]\n",
       "test.yaml:4: torques_Nm: found 0"},
      {"shape: torque_steps\naxis: x\ntorques_Nm: [0.1]\n", "travel_mm"},
      {"shape: reversals\naxis: x\namplitudes_mm: []\nfrequency_hz: 1\n", "test.yaml:3: amplitudes_mm"},
      {"shape: hold\nseconds: 1\ntorque: {axis: x, kind: chirp, amplitude_Nm: 0.1}\n",
       "test.yaml:3: torque: expected frequency_min_hz"},
      {"shape: hold\nseconds: 1\ntorque: {axis: x, kind: pulses, amplitude_Nm: 0.1, width_s: 2}\n",
       "test.yaml:3: torque: four times width_s"},
      {"shape: hold\nseconds: 1\ntorque: {axis: x, kind: noise, amplitude_Nm: 0.1}\n", "torque.kind"},
      {"sequence: []\n", "test.yaml:1: sequence: found a list"},
      {"sequence: [circle]\n", "expected a program with a shape"},
      {"sequence:\n  - {shape: hold, seconds: 1, minutes: 2}\n", "test.yaml:2: minutes"},
      {"sequence: [{shape: hold, seconds: 1}]\nrepeat: 2\n", "test.yaml:2: repeat"},
      {"together: [{shape: hold, seconds: 1}]\nrepeats: 2\n", "test.yaml:2: repeats"},
      {"shape: hold\nsequence: [{shape: hold, seconds: 1}]\n", "only one of shape, sequence and together"},
      {"{ not yaml", "test.yaml"},
  };
  for (const Wrong& w : wrong) {
    const std::string error = ErrorOf([&] { Yaml(w.text); });
    EXPECT_NE(error.find(w.message), std::string::npos) << w.text << "gave: " << error;
    EXPECT_EQ(error.rfind("test.yaml", 0), 0u) << error;
  }
}

TEST(ProgramText, FormatFollowsTheNameOfTheFile) {
  EXPECT_EQ(FormatOf("a/b.ngc"), ProgramFormat::kGcode);
  EXPECT_EQ(FormatOf("PART.NC"), ProgramFormat::kGcode);
  EXPECT_EQ(FormatOf("part.Cnc"), ProgramFormat::kGcode);
  EXPECT_EQ(FormatOf("b.yaml"), ProgramFormat::kYaml);
  EXPECT_NE(ErrorOf([] { LoadProgram("/nowhere/circle.yaml"); }).find("/nowhere/circle.yaml: cannot be read"),
            std::string::npos);
  EXPECT_NE(ErrorOf([] { LoadProgram("/tmp"); }).find("cannot be read"), std::string::npos);
}

TEST(ProgramText, EveryExampleFitsTheTable) {
  int examples = 0;
  for (const auto& file : std::filesystem::directory_iterator(CONTOUR_PROGRAMS)) {
    EXPECT_EQ(ErrorOf([&] { testing::PlanOf(LoadProgram(file.path())); }), "");
    ++examples;
  }
  EXPECT_GE(examples, 10);
}

TEST(ProgramText, AnEmptyFileIsReadAndDoesNotMove) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "empty.ngc";
  std::ofstream(file).close();
  EXPECT_EQ(ReadProgramText(file), "");
  EXPECT_EQ(ErrorOf([&] { static_cast<void>(LoadProgram(file)); }),
            file.string() + ": the program does not move");
}

}  // namespace
}  // namespace contour
