#include "analysis/axis_model/fitted_config.h"

#include <gtest/gtest.h>

#include "analysis/axis_model/read_stated_axis.h"
#include "tests/config/test_files.h"

namespace contour::diagnosis {
namespace {

/// Written and read again.
StatedAxis Again(const std::string& file, const StatedAxis& axis) {
  YamlValue tree = ParseYamlFile(file);
  LooseAxisFile content = ReadLooseFile(tree);
  const YamlEntry* model = tree.Find("model");
  IntoConfig(axis, content);
  return ReadStatedAxis(
      WriteTestFile("again.yaml", TextOf(content, UnitsOf(model != nullptr ? model->value : tree))), "");
}

void ExpectAlike(const StatedAxis& a, const StatedAxis& b) {
  const auto near = [](double x, double y) { EXPECT_NEAR(x, y, 1e-4 * std::abs(x) + 1e-300); };
  near(a.motor_inertia, b.motor_inertia);
  near(a.load_inertia, b.load_inertia);
  near(a.stiffness, b.stiffness);
  near(a.damping, b.damping);
  near(a.friction.Fc_plus, b.friction.Fc_plus);
  near(a.friction.Fs_minus, b.friction.Fs_minus);
  near(a.friction.vs, b.friction.vs);
  near(a.friction.s0, b.friction.s0);
  near(a.friction.s1, b.friction.s1);
  near(a.friction.s2, b.friction.s2);
  near(a.offset, b.offset);
  near(a.delay_s, b.delay_s);
  EXPECT_TRUE(b.open.empty() || b.open == std::set<std::string>{"stroke"});
}

TEST(FittedConfig, NumbersOfEveryKindOfAxisComeBack) {
  for (const char* text :
       {"mass_kg: 95\nlead_mm: 2.5\nconstant_force_N: 3.2\nfriction: {Fc_plus_N: 20, sigma2_Ns_m: 200}\n",
        "mass_kg: 95\n", "mass_kg: 40\nload_mass_kg: 50\nscrew_stiffness_N_um: 30\nscrew_damping_Ns_m: 900\n",
        "model: {motor_inertia_kgm2: 1e-4}\n",
        "model:\n  lead_mm: 5\n  motor_inertia_kgm2: 5e-5\n  table_mass_kg: 10\n"
        "  friction: {Fc_plus_N: 40, Fc_minus_N: 38, sigma2_Ns_m: 400}\ndrive: {delay_ms: 1}\n",
        "motor_inertia_kgm2: 5e-5\nload_inertia_kgm2: 4e-5\nstiffness_Nm_rad: 20\ndamping_Nms_rad: 1e-3\n"
        "friction: {Fc_plus_Nm: 0.03, sigma2_Nms_rad: 3e-4}\n"}) {
    SCOPED_TRACE(text);
    const std::string file = WriteTestFile("model.yaml", text);
    StatedAxis axis = ReadStatedAxis(file, "");
    axis.motor_inertia *= 1.13;
    axis.load_inertia *= 0.9;
    axis.stiffness *= 1.2;
    axis.friction.Fc_plus *= 1.3;
    axis.friction.s2 += 1e-5;
    axis.friction.s1 = 1e-3 * axis.friction.s0;
    axis.sigma["inertia"] = 0.0123;
    axis.sigma["Fc"] = 0.02;
    const StatedAxis again = Again(file, axis);
    ExpectAlike(axis, again);
    EXPECT_NEAR(again.sigma.at("inertia"), 0.0123, 1e-5);
    EXPECT_NEAR(again.sigma.at("Fc"), 0.02, 1e-5);
  }
}

TEST(FittedConfig, WhatIsSaidOfTheStrokeStays) {
  for (const char* endless : {"true", "false"}) {
    const std::string file = WriteTestFile(
        "model.yaml", std::string("model: {motor_inertia_kgm2: 1e-4}\ndrive: {endless: ") + endless + "}\n");
    const StatedAxis axis = ReadStatedAxis(file, "");
    const StatedAxis again = Again(file, axis);
    EXPECT_EQ(again.endless, axis.endless) << endless;
    EXPECT_EQ(again.to_and_fro, axis.to_and_fro) << endless;
  }
}

TEST(FittedConfig, ExtensionsKeepTheUnitsOfTheAxis) {
  const std::string file = WriteTestFile(
      "model.yaml",
      "mass_kg: 95\nfriction: {Fc_plus_N: 20, sigma2_Ns_m: 200}\nextensions: {cogging: {amplitude_N: 1.5, "
      "order_per_rev: 1, phase_rad: 0}}\n");
  const StatedAxis axis = ReadStatedAxis(file, "");
  EXPECT_EQ(Again(file, axis).extras.cogging.at(0).amplitude, 1.5);
}

}  // namespace
}  // namespace contour::diagnosis
