#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "daemon/program/program.h"
#include "daemon/program/smooth_path.h"
#include "daemon/program/stretch_plan.h"
#include "daemon/program/time_law.h"

// Smooth paths of a G-code program and how they are timed, as JSON, for independent solvers to compare with:
//   dump_stretches PROGRAM VELOCITY ACCELERATION JERK TOLERANCE   (SI; three axes alike)
namespace contour {
namespace {

constexpr int kSamples = 400;

PerAxis<PlanLimits> Limits(char** numbers) {
  PerAxis<PlanLimits> limits;
  for (const char* axis : {"x", "y", "z"}) {
    PlanLimits l;
    l.axis = axis;
    l.position_min_m = -10.0;
    l.position_max_m = 10.0;
    l.velocity_m_s = std::atof(numbers[0]);
    l.acceleration_m_s2 = std::atof(numbers[1]);
    l.jerk_m_s3 = std::atof(numbers[2]);
    l.path_tolerance_m = std::atof(numbers[3]);
    limits.push_back(l);
  }
  return limits;
}

void PrintSpline(const Stretch& stretch) {
  // Breaks and values with derivatives are as good as coefficients.
  std::vector<double> breaks = stretch.Jumps_m(0.0, stretch.length_m());
  breaks.insert(breaks.begin(), 0.0);
  breaks.push_back(stretch.length_m());
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
  std::printf("\"breaks\":[");
  for (std::size_t i = 0; i < breaks.size(); ++i) std::printf("%s%.17g", i ? "," : "", breaks[i]);
  std::printf("],\"pieces\":[");
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const PathDerivatives q = stretch.At(breaks[i], 0.5 * (breaks[i] + breaks[i + 1]));
    std::printf("%s[", i ? "," : "");
    for (std::size_t a = 0; a < q.first.size(); ++a)
      std::printf("%s[%.17g,%.17g,%.17g,%.17g]", a ? "," : "", q.position_m[a], q.first[a], q.second[a],
                  q.third[a]);
    std::printf("]");
  }
  std::printf("],\n");
}

void Print(const StretchProgram& program, const StretchProgram::Part& part, Stretch stretch) {
  while (!stretch.all_known()) stretch.Extend();
  std::printf("{");
  PrintSpline(stretch);
  std::printf("\"feeds\":[");
  double way_m = 0.0, feed_m_s = -1.0;
  for (std::size_t i = part.first; i < part.end; ++i) {
    const ProgrammedMove move = program.moves().Move(i);
    if (move.feed_m_s != feed_m_s)
      std::printf("%s[%.17g,%.17g]", i > part.first ? "," : "", way_m, move.feed_m_s);
    feed_m_s = move.feed_m_s;
    way_m += move.curve.length_m;
  }
  TimeLaw law(stretch, 0.0, 1.0);
  const double duration_s = law.duration_s();
  std::printf("],\"duration_s\":%.12g,\"moves\":%zu,\"samples\":[", duration_s, part.end - part.first);
  for (int k = 0; k <= kSamples; ++k) {
    const double t = duration_s * k / kSamples;
    const TimeLaw::State s = law.At(t);
    std::printf("%s[%.12g,%.17g,%.12g,%.12g]", k ? "," : "", t, s.way_m, s.speed_m_s, s.acceleration_m_s2);
  }
  std::printf("]}");
}

int Run(char** arguments) {
  const PerAxis<PlanLimits> limits = Limits(arguments + 2);
  PerAxis<double> start(limits.size());
  std::fill(start.begin(), start.end(), 0.0);
  const auto plan = PlanMotion(LoadProgram(arguments[1]), start, limits);
  const std::shared_ptr<const StretchProgram> program = dynamic_cast<const StretchPlan&>(*plan).program();
  std::printf("{\"duration_s\":%.12g,\"stretches\":[\n", plan->duration_s());
  bool first = true;
  for (std::size_t i = 0; i < program->parts().size(); ++i) {
    const StretchProgram::Part part = program->parts()[i];
    if (part.first == part.end) continue;
    std::printf("%s", first ? "" : ",\n");
    Print(*program, part, Stretch(program, i));
    first = false;
  }
  std::printf("]}\n");
  return 0;
}

}  // namespace
}  // namespace contour

int main(int count, char** arguments) { return count == 6 ? contour::Run(arguments) : 2; }
