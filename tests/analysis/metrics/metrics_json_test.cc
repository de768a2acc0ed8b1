#include "analysis/metrics/metrics_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace contour {
namespace {

RunMetrics Example() {
  RunMetrics m;
  m.encoder.rms_um = 0.25;
  m.encoder.peak_um = 1.5;
  m.encoder.circular_deviation_um = 2.5;
  m.encoder.quadrant_peak_um = {1.0, 2.0, 3.0, 4.0};
  m.axes.resize(2);
  m.axes[0].axis = "x";
  m.axes[0].friction_estimate_error_rms_N = 0.75;
  m.axes[1].axis = "y";
  m.axes[1].torque_saturated_fraction = 0.125;
  return m;
}

TEST(MetricsJson, HasTheAgreedShape) {
  const auto json =
      nlohmann::json::parse(MetricsJson({"full", "circle.yaml", 3, 1000, 12000, {}, 1}, Example()));
  const auto expected = nlohmann::json::parse(R"({
    "controller": "full", "program": "circle.yaml", "seed": 3, "cycle_us": 1000, "cycles": 12000,
    "late_cycles": null, "stale_cycles": 1,
    "contour": {"encoder": {"rms_um": 0.25, "peak_um": 1.5, "circular_deviation_um": 2.5,
                            "quadrant_peak_um": [1.0, 2.0, 3.0, 4.0]},
                "table": {"rms_um": null, "peak_um": null, "circular_deviation_um": null,
                          "quadrant_peak_um": null}},
    "friction_estimate_error_rms_N": {"x": 0.75, "y": null},
    "torque_saturated_fraction": {"x": 0.0, "y": 0.125}, "encoder_pp_counts": null})");
  for (const auto& [key, value] : expected.items()) EXPECT_EQ(json.at(key), value) << key;
}

TEST(MetricsJson, LateCyclesAreANumberInRealTime) {
  const auto json = nlohmann::json::parse(MetricsJson({"mpc", "hold", {}, 1000, 5, 2, 0}, Example()));
  EXPECT_EQ(json.at("late_cycles"), 2);
  EXPECT_TRUE(json.at("seed").is_null());
}

TEST(MetricsJson, RefusesAFileItCannotWrite) {
  EXPECT_THROW(WriteMetrics("/nowhere/metrics.json", {}, Example()), std::runtime_error);
}

}  // namespace
}  // namespace contour
