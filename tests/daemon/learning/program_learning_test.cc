#include "daemon/learning/program_learning.h"

#include <gtest/gtest.h>

#include "tests/daemon/learning/pass_of_a_table.h"
#include "tests/daemon/program/on_a_table.h"

namespace contour {
namespace {

using test::kPeriod_s;
using testing::Point;

MachineConfig Machine(bool enabled, int programs = 4) {
  MachineConfig machine;
  machine.learning.enabled = enabled;
  machine.learning.programs = programs;
  for (const char* name : {"x", "y"}) {
    machine.axes[name].model.mechanics = test::kScrew;
    machine.axes[name].limits.acceleration_mm_s2 = 5000.0;
  }
  return machine;
}

/// Learns a line of a table that is pushed aside by 3 um, across the line.
class OnALine {
 public:
  explicit OnALine(const MachineConfig& machine) : learning(machine) {}

  /// The points of the next pass, in which nothing runs yet.
  std::vector<PathPoint> Points(const std::string& text = "a line",
                                PerAxis<double> start_m = Point(0.0, 0.0)) {
    PathGenerator generator(testing::Yaml("{shape: line, dx_mm: 20, dy_mm: 0, feed_mm_min: 3000}"), start_m,
                            testing::TableLimits(), kPeriod_s, ++id_);
    report = learning.Prepare([&] { return text; }, start_m, id_, generator);
    return test::PointsOf(generator);
  }
  void Run(const std::vector<PathPoint>& told, std::size_t rows, MachineState ends, Reason reason) {
    const test::Table table = [this](const std::vector<PathPoint>& points, std::size_t now) {
      PerAxis<double> t(2);
      for (std::size_t i = 0; i < 2; ++i) t[i] = scale_factor * points[now].axes[i].position_m;
      t[1] += now > 200 && now < 260 ? push_m : 0.0;
      return t;
    };
    for (std::size_t k = 0; k < rows; ++k) learning.Consume(test::RowAt(told, k, table));
    CycleRecord end = test::RowAt(told, rows - 1, table);
    ++end.cycle;
    end.state = ends;
    end.reason = reason;
    learning.Consume(end);
  }
  void Pass(const std::string& text = "a line", PerAxis<double> start_m = Point(0.0, 0.0)) {
    const std::vector<PathPoint> told = Points(text, start_m);
    Run(told, told.size(), MachineState::kReady, Reason::kProgramEnd);
  }
  static double Largest_m(const std::vector<PathPoint>& points, double start_m = 0.0) {
    double largest_m = 0.0;
    for (const PathPoint& p : points)
      largest_m = std::max(largest_m, std::abs(p.axes[1].position_m - start_m));
    return largest_m;
  }

  double push_m = 3e-6;
  double scale_factor = 1.0;  ///< of what the scales count of the way
  ProgramLearning learning;
  std::optional<LearningReport> report;

 private:
  std::uint32_t id_ = 0;
};

TEST(ProgramLearning, ShiftsTheNextPassOfTheSameProgram) {
  OnALine line(Machine(true));
  EXPECT_EQ(OnALine::Largest_m(line.Points()), 0.0);
  EXPECT_EQ(line.report->passes, 0U);
  line.Pass();
  EXPECT_NEAR(OnALine::Largest_m(line.Points()), 0.6 * 3e-6, 0.3e-6);
  EXPECT_EQ(line.report->passes, 1U);
  EXPECT_NEAR(line.report->last_peak_um, 3.0, 0.8);  // the scale's zero takes a part of it
}

TEST(ProgramLearning, OffItTouchesNothing) {
  OnALine line(Machine(false));
  line.Pass();
  const std::vector<PathPoint> points = line.Points();
  EXPECT_FALSE(line.report.has_value());
  EXPECT_EQ(OnALine::Largest_m(points), 0.0);
}

TEST(ProgramLearning, AnotherProgramOrPlaceKnowsNothingOfIt) {
  OnALine line(Machine(true));
  line.Pass();
  EXPECT_EQ(OnALine::Largest_m(line.Points("another line")), 0.0);
  EXPECT_GT(OnALine::Largest_m(line.Points()), 1e-6) << "the first is still known";
  EXPECT_EQ(OnALine::Largest_m(line.Points("a line", Point(0.001, 0.002)), 0.002), 0.0);
  EXPECT_EQ(OnALine::Largest_m(line.Points()), 0.0) << "what was learnt elsewhere is gone";
}

TEST(ProgramLearning, TheOldestIsForgottenForTheNewest) {
  OnALine line(Machine(true, 2));
  for (const char* text : {"one", "two", "three"}) line.Pass(text);
  EXPECT_GT(OnALine::Largest_m(line.Points("three")), 1e-6);
  EXPECT_GT(OnALine::Largest_m(line.Points("two")), 1e-6);
  EXPECT_EQ(OnALine::Largest_m(line.Points("one")), 0.0);
}

TEST(ProgramLearning, AFaultWipesEverything) {
  OnALine line(Machine(true));
  line.Pass("before");
  line.Pass();
  const std::vector<PathPoint> told = line.Points();
  ASSERT_GT(OnALine::Largest_m(told), 1e-6);
  line.Run(told, 50, MachineState::kFaulted, Reason::kFollowingError);
  EXPECT_EQ(OnALine::Largest_m(line.Points()), 0.0);
  EXPECT_EQ(OnALine::Largest_m(line.Points("before")), 0.0);
}

TEST(ProgramLearning, OtherGainsWipeEverything) {
  OnALine line(Machine(true));
  line.Pass();
  line.learning.Forget();
  EXPECT_EQ(OnALine::Largest_m(line.Points()), 0.0);
}

TEST(ProgramLearning, APassThatWasStoppedTeachesNothing) {
  OnALine line(Machine(true));
  const std::vector<PathPoint> told = line.Points();
  line.Run(told, told.size() - 5, MachineState::kStopping, Reason::kNone);
  EXPECT_EQ(OnALine::Largest_m(line.Points()), 0.0);
}

TEST(ProgramLearning, APassWithManyRowsMissingTeachesNothing) {
  OnALine line(Machine(true));
  const std::vector<PathPoint> told = line.Points();
  line.Run(told, told.size() * 9 / 10, MachineState::kReady, Reason::kProgramEnd);
  EXPECT_EQ(OnALine::Largest_m(line.Points()), 0.0);
}

TEST(ProgramLearning, AScaleThatDoesNotFollowTheMotorTeachesNothing) {
  for (const double factor : {-1.0, 0.0, 0.5, 1.2}) {
    OnALine line(Machine(true));
    line.scale_factor = factor;
    line.Pass();
    EXPECT_EQ(OnALine::Largest_m(line.Points()), 0.0) << factor;
    EXPECT_NE(line.report->refused.find("axis number 1 does not move as its motor does"), std::string::npos)
        << line.report->refused;
  }
}

TEST(ProgramLearning, AnErrorThatIsNoneToLearnIsNotLearnt) {
  OnALine line(Machine(true));
  line.Pass();
  ASSERT_GT(OnALine::Largest_m(line.Points()), 1e-6);
  line.push_m = 100e-6;
  line.Pass();
  EXPECT_EQ(OnALine::Largest_m(line.Points()), 0.0) << "and what was learnt before is gone";
  EXPECT_NE(line.report->refused.find("more than three times learning.largest_um"), std::string::npos)
      << line.report->refused;
}

TEST(ProgramLearning, LongProgramsAreNotLearnt) {
  MachineConfig machine = Machine(true);
  machine.learning.longest_s = 0.3;
  OnALine line(machine);
  line.Pass();
  EXPECT_EQ(OnALine::Largest_m(line.Points()), 0.0);
}

}  // namespace
}  // namespace contour
