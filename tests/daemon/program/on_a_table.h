#pragma once

#include <string>

#include "daemon/program/motion_plan.h"

namespace contour::testing {

/// A table of two axes, x and y, with 400 mm of travel.
inline PerAxis<PlanLimits> TableLimits() {
  PerAxis<PlanLimits> limits(2);
  limits[0] = {"x", -0.2, 0.2, 0.25, 5.0, 200.0, 1.5, 5e-4, 8e-4, 84.0};
  limits[1] = {"y", -0.2, 0.2, 0.25, 5.0, 200.0, 1.5, 5e-4, 8e-4, 84.0};
  return limits;
}

inline PerAxis<double> Point(double x_m, double y_m) {
  PerAxis<double> p(2);
  p[0] = x_m;
  p[1] = y_m;
  return p;
}

inline Program Yaml(const std::string& text) { return ParseProgram(text, "test.yaml", ProgramFormat::kYaml); }
inline Program Gcode(const std::string& text) {
  return ParseProgram(text, "test.ngc", ProgramFormat::kGcode);
}

inline std::shared_ptr<const MotionPlan> PlanOf(const Program& program) {
  return PlanMotion(program, Point(0.003, -0.004), TableLimits());
}

/// What is thrown, or "" when nothing is.
template <class Work>
std::string ErrorOf(Work work) {
  try {
    work();
  } catch (const ProgramError& e) {
    return e.what();
  }
  return "";
}

}  // namespace contour::testing
