#include "daemon/program/placed_program.h"

#include <gtest/gtest.h>

#include "daemon/program/path_generator.h"
#include "tests/daemon/program/keeps_limits.h"

namespace contour {
namespace {

PerAxis<PlanLimits> Limits() {
  PerAxis<PlanLimits> limits;
  limits.push_back({"x", -0.2, 0.2, 0.25, 5.0, 200.0});
  limits.push_back({"y", -0.2, 0.2, 0.1, 2.0, 50.0});
  return limits;
}

Placement Place(double x_m, double y_m, double zero_x_m, double zero_y_m) {
  Placement place;
  place.start_m.push_back(x_m);
  place.start_m.push_back(y_m);
  place.zero_m.push_back(zero_x_m);
  place.zero_m.push_back(zero_y_m);
  return place;
}

Program Yaml(const char* text) { return ParseProgram(text, "shape.yaml", ProgramFormat::kYaml); }

PerAxis<double> At(const MotionPlan& plan, double time_s) {
  PerAxis<ReferencePoint> axes;
  plan.At(time_s, axes);
  PerAxis<double> at_m;
  for (const ReferencePoint& p : axes) at_m.push_back(p.position_m);
  return at_m;
}

TEST(PlacedProgramTest, AShapeIsDrawnAtProgramZeroFromWhereverTheMachineStands) {
  const Program circle = Yaml("{shape: circle, radius_mm: 10, turns: 3, frequency_hz: 0.5}");
  const auto there = PlanPlaced(circle, Place(0.01, 0.02, 0.01, 0.02), Limits());
  const auto from = PlanPlaced(circle, Place(-0.03, 0.05, 0.01, 0.02), Limits());
  const double approach_s = from->duration_s() - there->duration_s();
  ASSERT_GT(approach_s, 0.5);
  for (double t = 0.0; t <= there->duration_s(); t += 0.05)
    for (std::size_t i = 0; i < 2; ++i)
      ASSERT_NEAR(At(*from, approach_s + t)[i], At(*there, t)[i], 1e-9) << t;
  EXPECT_NEAR(At(*from, 0.0)[0], -0.03, 1e-15);
  EXPECT_FALSE(from->Scored(0.5 * approach_s));
  EXPECT_EQ(from->Scored(approach_s + 2.5), there->Scored(2.5));
  ASSERT_TRUE(from->circle().has_value());
  EXPECT_EQ(from->circle()->centre_m[0], there->circle()->centre_m[0]);
  test::LimitWatch watch(Limits(), 1e-3);
  PathGenerator points(from, Limits(), 1e-3, 1);
  double fastest_m_s = 0.0;
  for (PathPoint p; points.Next(p);) {
    watch.Add(p.axes);
    if (static_cast<double>(points.points_done()) * 1e-3 < approach_s)
      fastest_m_s = std::max(fastest_m_s, std::abs(p.axes[1].velocity_m_s));
  }
  watch.ExpectKept();
  EXPECT_NEAR(fastest_m_s, 0.01, 1e-4) << "a tenth of the slower axis's speed, which leads here";
}

TEST(PlacedProgramTest, ALineThatDoesNotFitFromZeroIsRefusedWhereverTheMachineStands) {
  const Program line = Yaml("{shape: line, dx_mm: 150, feed_mm_min: 3000}");
  EXPECT_NO_THROW(PlanPlaced(line, Place(0.1, 0.0, 0.0, 0.0), Limits()));
  EXPECT_THROW(PlanPlaced(line, Place(0.0, 0.0, 0.1, 0.0), Limits()), ProgramError);
}

TEST(PlacedProgramTest, GcodeCountsFromZeroAndBeginsWhereTheMachineStands) {
  const char* const text = "G21 G61\nG0 X10 Y5\nG91 G1 X10 F600\nG90 G2 X30 Y15 I0 J10\n";
  const Placement place = Place(-0.02, 0.03, 0.01, 0.02);
  const Program part = ReadPlaced({text, "part.ngc", ProgramFormat::kGcode}, place, Limits());
  const auto plan = PlanPlaced(part, place, Limits());
  EXPECT_NEAR(At(*plan, 0.0)[0], -0.02, 1e-15);
  EXPECT_NEAR(At(*plan, 0.0)[1], 0.03, 1e-15);
  EXPECT_NEAR(At(*plan, plan->duration_s())[0], 0.01 + 0.03, 1e-12);
  EXPECT_NEAR(At(*plan, plan->duration_s())[1], 0.02 + 0.015, 1e-12);
  EXPECT_EQ(plan->Line(1e-3), 2u);
  EXPECT_EQ(plan->Line(plan->duration_s()), 4u);
  // Incremental from the start: from where the machine stands.
  const Program step = ReadPlaced({"G91 G1 X1 F600\n", "step.ngc", ProgramFormat::kGcode}, place, Limits());
  const auto stepped = PlanPlaced(step, place, Limits());
  EXPECT_NEAR(At(*stepped, stepped->duration_s())[0], -0.019, 1e-12);
  // Machine coordinates, where the machine has some.
  EXPECT_THROW(ReadPlaced({"G53 G0 X1\n", "m.ngc", ProgramFormat::kGcode}, place, Limits()), ProgramError);
  const Program home =
      ReadPlaced({"G53 G0 X1\n", "m.ngc", ProgramFormat::kGcode}, place, Limits(), {true, {}, {}});
  const auto homed = PlanPlaced(home, place, Limits());
  EXPECT_NEAR(At(*homed, homed->duration_s())[0], 0.001, 1e-12);
}

TEST(PlacedProgramTest, AProgramBeginsAtALineWithTheWordsInForceThere) {
  const char* const text =
      "G21 G61 F600\nG0 X10 Y5\nG91\nG1 X10\nG20 X0.1\nO1 sub\nG1 Y1\nO1 endsub\nG90 G21 X0 Y5\n";
  const auto read = [&](const Placement& place, int line, bool go_there) {
    ReadOptions options;
    options.part.from_line = line;
    options.part.go_there = go_there;
    return ReadPlaced({text, "part.ngc", ProgramFormat::kGcode}, place, Limits(), options);
  };
  // Line 5 begins at X20 Y5, in inches by then.
  const Placement there = Place(0.02, 0.005, 0.0, 0.0);
  const auto plan = PlanPlaced(read(there, 5, false), there, Limits());
  EXPECT_EQ(plan->Line(1e-3), 5u);
  EXPECT_NEAR(At(*plan, 0.0)[0], 0.02, 1e-12);
  double most_m = 0.0;
  for (double t = 0.0; t < plan->duration_s(); t += 1e-3) most_m = std::max(most_m, At(*plan, t)[0]);
  EXPECT_NEAR(most_m, 0.02 + 0.00254, 1e-6);
  EXPECT_NEAR(At(*plan, plan->duration_s())[0], 0.0, 1e-12);
  const Placement elsewhere = Place(-0.01, 0.03, 0.0, 0.0);
  try {
    static_cast<void>(read(elsewhere, 5, false));
    ADD_FAILURE() << "it stands elsewhere";
  } catch (const ProgramError& e) {
    EXPECT_NE(std::string(e.what()).find("part.ngc:5: it begins at X20.0000 Y5.0000 mm"), std::string::npos)
        << e.what();
  }
  const auto going = PlanPlaced(read(elsewhere, 5, true), elsewhere, Limits());
  EXPECT_NEAR(At(*going, 0.0)[1], 0.03, 1e-12);
  EXPECT_GT(going->duration_s(), plan->duration_s() + 0.1);
  for (double t = 0.0; t < plan->duration_s(); t += 0.01)
    ASSERT_NEAR(At(*going, going->duration_s() - plan->duration_s() + t)[0], At(*plan, t)[0], 1e-9);
  EXPECT_THROW(static_cast<void>(read(there, 100, true)), ProgramError);
  ReadOptions of_shape;
  of_shape.part.from_line = 1;
  EXPECT_THROW(static_cast<void>(ReadPlaced({"{shape: hold, seconds: 1}", "h.yaml", ProgramFormat::kYaml},
                                            there, Limits(), of_shape)),
               ProgramError);
}

TEST(PlacedProgramTest, ALineWithinASubIsNoPlaceToBegin) {
  const char* const text = "G21 G61 F600\nO1 sub\nG91 G1 X1\nG90\nO1 endsub\nO1 call\nO1 call\nG0 X0\n";
  const Placement place = Place(0.0, 0.0, 0.0, 0.0);
  ReadOptions options;
  options.part.go_there = true;
  options.part.from_line = 3;
  EXPECT_THROW(
      static_cast<void>(ReadPlaced({text, "s.ngc", ProgramFormat::kGcode}, place, Limits(), options)),
      ProgramError);
  options.part.from_line = 7;
  const auto plan = PlanPlaced(ReadPlaced({text, "s.ngc", ProgramFormat::kGcode}, place, Limits(), options),
                               place, Limits());
  EXPECT_EQ(plan->Line(plan->duration_s()), 8u);
}

TEST(PlacedProgramTest, GcodeThatIsThereAlreadyEndsAtOnce) {
  const Placement place = Place(0.02, 0.02, 0.01, 0.02);
  const Program part = ReadPlaced({"G0 X10 Y0\n", "part.ngc", ProgramFormat::kGcode}, place, Limits());
  EXPECT_LT(PlanPlaced(part, place, Limits())->duration_s(), 1e-9);
}

}  // namespace
}  // namespace contour
