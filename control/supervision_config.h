#pragma once

#include <cstdint>

#include "core/visit.h"

namespace contour {

/// How the machine watches itself (`control.supervision`). What lasts is noticed, then softened, then fallen
/// back from, then stopped; each step takes as long again. 0 switches that watch off.
/// innovation_sigma: one reading is believed up to `estimator.innovation_gate_sigma` (12), and a force that
/// the filter does not know takes an axis four times as far in two periods as in one. A filter whose mean is
/// beyond 4 x 12 would not even be right about every other reading.
struct SupervisionConfig {
  std::int32_t half_waves = 12;
  double softer = 0.6;
  double innovation_sigma = 48.0;
  std::int32_t innovation_samples = 500;
  double gated_ms = 20.0;
  double solver_cap_ms = 100.0;
  double late_ms = 250.0;
  double step_s = 0.3;
  double quiet_s = 5.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("half_waves", half_waves, Range{0, 1000},
               "half waves of an oscillation in a row that are a step of the ladder; 0: not watched");
    v.Optional("softer", softer, Range{0.2, 1.0}, "bandwidth of a softened loop, as a share of its own");
    v.Optional("innovation_sigma", innovation_sigma, Range{0.0, 1e6},
               "root mean square of the friction filter's innovations, in its own standard deviations, above "
               "which it contradicts itself: 4 x innovation_gate_sigma's default; 0: not watched");
    v.Optional("innovation_samples", innovation_samples, Range{10, 100000},
               "samples of that mean; from n the spread of a mean square is sqrt(2 / n)");
    v.Optional("gated_ms", gated_ms, Range{0.0, 20.0},
               "for so long the filter believes no measurement; after 20 ms it begins anew; 0: not watched");
    v.Optional("solver_cap_ms", solver_cap_ms, Range{0.0, 1e5},
               "for so long the solver reaches its cap in every cycle; 0: not watched");
    v.Optional(
        "late_ms", late_ms, Range{0.0, 1e5},
        "for so long every cycle is late; the time at which frames leave is part of the loop's delay; 0: "
        "not watched");
    v.Optional("step_s", step_s, Range{0.0, 60.0},
               "shortest time between two steps: what a step changes needs time to act");
    v.Optional("quiet_s", quiet_s, Range{0.1, 3600.0},
               "time without trouble after which a step is taken back");
  }
};

}  // namespace contour
