#pragma once

#include <stop_token>
#include <thread>

#include "daemon/path_feeder.h"

namespace contour {

/// Plans the program that a feeder supplies, behind its motion, in a thread of its own: planning may take as
/// long as it takes, and whoever supplies the points waits for nobody.
class PathPlanner {
 public:
  explicit PathPlanner(PathFeeder& feeder) : feeder_(feeder) {}

  void Start();
  void Finish();

 private:
  void Work(const std::stop_token& end);

  PathFeeder& feeder_;
  std::jthread thread_;
};

}  // namespace contour
