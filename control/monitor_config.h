#pragma once

#include <cstdint>

#include "core/visit.h"

namespace contour {

/// How far an axis may be from its model before motion and torque count as contradicting each other
/// (`control.monitor` of the machine file). Everything else follows from the axis's own numbers.
struct MonitorConfig {
  double friction_factor = 2.0;
  double presliding_factor = 3.0;
  double mass_error_rel = 0.3;
  double torque_constant_error_rel = 0.4;
  std::int32_t misread_counts = 8;
  std::int32_t hysteresis_counts = 1;
  double drive_loop_Hz = 30.0;
  double reported_torque_error_rel = 0.1;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("friction_factor", friction_factor, Range{1.0, 20.0},
               "friction may be so many times what the model states");
    v.Optional("presliding_factor", presliding_factor, Range{1.0, 100.0},
               "presliding may be so many times as stiff as the model states");
    v.Optional("mass_error_rel", mass_error_rel, Range{0.0, 0.9},
               "masses may be off by this share of what the model states");
    v.Optional("torque_constant_error_rel", torque_constant_error_rel, Range{0.1, 10.0},
               "force per acceleration off by more than this share is told as a changed torque constant");
    v.Optional("misread_counts", misread_counts, Range{0, 10000},
               "a single reading of the encoder may be off by so many counts");
    v.Optional("hysteresis_counts", hysteresis_counts, Range{0, 10000},
               "the motor may turn by so many counts before the reading changes");
    v.Optional("drive_loop_Hz", drive_loop_Hz, Range{1.0, 500.0},
               "csp: the drive's own position loop, its integral action included, is at least as stiff as "
               "one of this "
               "bandwidth");
    v.Optional("reported_torque_error_rel", reported_torque_error_rel, Range{0.001, 1.0},
               "error of the reported torque (0x6077), as a share of rated torque");
  }
};

}  // namespace contour
