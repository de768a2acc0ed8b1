#include "daemon/program/shapes.h"

namespace contour {

bool FromName(std::string_view name, Direction& direction) {
  if (name != "ccw" && name != "cw") return false;
  direction = name == "ccw" ? Direction::kCcw : Direction::kCw;
  return true;
}

std::string_view Name(Direction direction) { return direction == Direction::kCcw ? "ccw" : "cw"; }

std::string_view Choices(Direction) { return "ccw, cw"; }

bool FromName(std::string_view name, Corners& corners) {
  if (name != "velocity_jump" && name != "exact_stop") return false;
  corners = name == "velocity_jump" ? Corners::kVelocityJump : Corners::kExactStop;
  return true;
}

std::string_view Name(Corners corners) {
  return corners == Corners::kVelocityJump ? "velocity_jump" : "exact_stop";
}

std::string_view Choices(Corners) { return "exact_stop, velocity_jump"; }

bool FromName(std::string_view name, TorqueSignalKind& kind) {
  for (const auto k : {TorqueSignalKind::kChirp, TorqueSignalKind::kMultisine, TorqueSignalKind::kPulses}) {
    if (name != Name(k)) continue;
    kind = k;
    return true;
  }
  return false;
}

std::string_view Name(TorqueSignalKind kind) {
  switch (kind) {
    case TorqueSignalKind::kChirp:
      return "chirp";
    case TorqueSignalKind::kMultisine:
      return "multisine";
    case TorqueSignalKind::kPulses:
      break;
  }
  return "pulses";
}

std::string_view Choices(TorqueSignalKind) { return "chirp, multisine, pulses"; }

}  // namespace contour
