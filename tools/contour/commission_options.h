#pragma once

#include <optional>
#include <string>

namespace contour {

/// What `contour commission` was asked for.
struct CommissionOptions {
  std::string axis;
  std::string socket;
  std::optional<double> travel_mm, max_speed_mm_s, max_torque_Nm;
  std::string out;
  std::string report;
  std::string loop;
  std::string mode = "auto";
  bool drive = false;
  bool yes = false;
  /// With `yes`: axes other than `axis` may move, too.
  bool other_axes = false;
};

}  // namespace contour
