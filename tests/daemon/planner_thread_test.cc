#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <stop_token>
#include <string>
#include <thread>

#include "daemon/path_planner.h"
#include "tests/daemon/path_consumer.h"
#include "tests/daemon/path_way.h"
#include "tests/daemon/program/part_programs.h"

// The planner's thread beside the supply of points and those who ask for the status: for the thread sanitizer
// above all.
namespace contour {
namespace {

using test::kTolerance_m;
using test::Limits;
using test::Way;
using test::WithTolerance;
using Planning = PacedPath::Options::Planning;

constexpr std::size_t kQueue = 512;
constexpr double kPeriod_s = 1e-3;

/// Asks for what any thread may ask for, until it is told to end.
std::jthread Asking(PathFeeder& feeder) {
  return std::jthread([&feeder](const std::stop_token& end) {
    double sum = 0.0;
    while (!end.stop_requested()) {
      sum += feeder.duration().duration_s + feeder.time_share() + (feeder.waits_for_plan() ? 1.0 : 0.0);
      std::this_thread::yield();
    }
    EXPECT_GE(sum, 0.0);
  });
}

TEST(PlannerThreadTest, AnyFeedWithTheThreadBesideKeepsLimitsAndPath) {
  const PerAxis<PlanLimits> limits = WithTolerance(Limits(0.25, 5.0, 200.0));
  for (const bool text : {false, true}) {
    const std::string program =
        text ? testing::EngravedText(3, 4, 0.05, 3, 1500) : testing::Spiral(6, 0.8, 0.1, 3, 4000);
    Way way(program, limits, {1.0, false, false, Planning::kAheadOrSlower}, ProgramFormat::kGcode, kQueue);
    PathPlanner planner(way.feeder());
    planner.Start();
    const std::jthread asking = Asking(way.feeder());
    constexpr std::array<double, 6> kFeeds{1.6, 0.3, 0.0, 2.0, 0.7, 1.0};
    for (std::size_t k = 0; !way.ended(); ++k) {
      if (k % 400 == 399) way.feeder().SetPace(k > 20000 ? 1.0 : kFeeds[k / 400 % kFeeds.size()]);
      way.Cycle();
      // Nothing goes by while there is nothing to go on with.
      if (way.feeder().waits_for_plan() || way.place().time_s == 0.0) std::this_thread::yield();
    }
    planner.Finish();
    way.ExpectAtItsEnd();
    way.watch().ExpectKept();
    EXPECT_LE(way.off_m(), kTolerance_m);
  }
}

TEST(PlannerThreadTest, ProgramsThatAreGivenUpWhileTheyArePlanned) {
  const PerAxis<PlanLimits> limits = WithTolerance(Limits(0.25, 5.0, 200.0));
  const auto plan =
      PlanMotion(ParseProgram(testing::Spiral(16, 0.8, 0.1, 3, 4000), "spiral", ProgramFormat::kGcode),
                 test::Origin(), limits);
  CommandMailbox mailbox(16, kQueue);
  PathFeeder feeder(mailbox);
  PathPlanner planner(feeder);
  planner.Start();
  const std::jthread asking = Asking(feeder);
  for (std::uint32_t id = 1; id <= 40; ++id) {
    feeder.Begin(std::make_unique<PathGenerator>(plan, limits, kPeriod_s, id),
                 {id % 3 == 0 ? 1.5 : 1.0, false, false, Planning::kAheadOrSlower});
    for (std::uint32_t k = 0; k < 5 * id; ++k) {
      feeder.Feed();
      std::this_thread::yield();
    }
    feeder.Abandon();
    EXPECT_EQ(feeder.path(), nullptr);
  }
  planner.Finish();
}

/// More than is kept in memory of a program.
std::string ManyLines() {
  std::string text = "G21 G90 G1 F4000\n";
  for (int i = 0; i < 200'000; ++i)
    text += "X" + std::to_string(i % 100) + " Y" + std::to_string(i / 100 % 40) + "\n";
  return text + "M2\n";
}

/// What this process holds open in this folder can neither be read nor written any more.
void LoseFilesIn(const std::filesystem::path& folder) {
  const int nothing = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code gone;
    const std::string to = std::filesystem::read_symlink(entry.path(), gone).string();
    if (gone || to.rfind(folder.string() + "/", 0) != 0) continue;
    dup2(nothing, std::stoi(entry.path().filename().string()));
  }
  close(nothing);
}

TEST(PlannerThreadTest, ADiskThatLosesTheProgramIsNamed) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "lost_program";
  std::filesystem::create_directories(folder);
  const char* const before = std::getenv("TMPDIR");
  const std::string was = before != nullptr ? before : "";
  setenv("TMPDIR", folder.c_str(), 1);
  const PerAxis<PlanLimits> limits = WithTolerance(Limits(0.25, 5.0, 200.0));
  const auto plan =
      PlanMotion(ParseProgram(ManyLines(), "spiral", ProgramFormat::kGcode), test::Origin(), limits);
  before != nullptr ? setenv("TMPDIR", was.c_str(), 1) : unsetenv("TMPDIR");
  CommandMailbox mailbox(16, kQueue);
  PathFeeder feeder(mailbox);
  feeder.Begin(std::make_unique<PathGenerator>(plan, limits, kPeriod_s, 1),
               {1.0, false, false, Planning::kAheadOrSlower});
  feeder.Feed();
  EXPECT_EQ(feeder.failure(), "");
  LoseFilesIn(folder);
  test::Consumer consumer(mailbox, 75.0);
  for (int k = 0; k < 100000 && feeder.failure().empty(); ++k) {
    feeder.PlanStep();
    feeder.Feed();
    consumer.Tick();
  }
  EXPECT_NE(feeder.failure().find("a long program"), std::string::npos) << feeder.failure();
  feeder.Begin(std::make_unique<PathGenerator>(
                   PlanMotion(ParseProgram("G1 X10 F1000\nM2\n", "line", ProgramFormat::kGcode),
                              test::Origin(), limits),
                   limits, kPeriod_s, 2),
               {1.0, false, false, Planning::kAheadOrSlower});
  EXPECT_EQ(feeder.failure(), "") << "another program has its own";
}

}  // namespace
}  // namespace contour
