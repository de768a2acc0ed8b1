// What the catalogue of causes writes is what the emulated machine reads.

#include "tools/validation/hidden/specimens.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "config/yaml_writer.h"
#include "tools/machine/assigned_axis.h"
#include "tools/validation/hidden/draw_setting.h"
#include "tools/validation/hidden/hide_effect.h"

namespace contour::hidden {
namespace {

EmulatedAxisConfig PlainAxis() {
  EmulatedAxisConfig axis;
  axis.motor_inertia_kgm2 = 5e-5;
  axis.table_mass_kg = 10.0;
  axis.screw_stiffness_N_um = 40.0;
  axis.screw_damping_Ns_m = 1000.0;
  EmulatedFrictionConfig& f = axis.friction;
  f.Fc_plus_N = f.Fc_minus_N = 40.0;
  f.Fs_plus_N = f.Fs_minus_N = 50.0;
  f.vs_mm_s = 2.0;
  f.sigma0_N_m = 5e6;
  f.sigma1_Ns_m = 2000.0;
  f.sigma1_decay_mm_s = 2.0;
  f.sigma2_Ns_m = 500.0;
  return axis;
}

TEST(Specimens, EveryCauseIsSomethingThatTheEmulatedMachineCanDoUpToItsLargestSize) {
  for (const std::string& kind : CatalogueKinds()) {
    const Setting setting = DrawSetting(7, {kind});
    Hidden hidden = DrawEffect(7, kind, setting);
    const diagnosis::Specimen& specimen = *SpecimenOf(kind);
    std::vector<double> sizes = {hidden.size};
    if (*specimen.sizes) sizes.assign((*specimen.sizes)->begin(), (*specimen.sizes)->end());
    if (*specimen.largest_size < diagnosis::kNoLargestSize) sizes.push_back(*specimen.largest_size);
    for (const double size : sizes) {
      hidden.size = size;
      EmulatedAxisConfig axis = PlainAxis();
      EXPECT_NO_THROW(HideEffect(hidden, setting, 1.0, 100.0, axis)) << kind << " " << size;
      EXPECT_NE(WriteYaml(axis), WriteYaml(PlainAxis())) << kind << " does nothing";
    }
  }
}

TEST(Specimens, WhatIsOutsideTheCatalogueIsHiddenToo) {
  for (const std::string& kind : OutsideKinds()) {
    EXPECT_EQ(SpecimenOf(kind), nullptr) << kind;
    const Setting setting = DrawSetting(7, {kind});
    EmulatedAxisConfig axis = PlainAxis();
    HideEffect(DrawEffect(7, kind, setting), setting, 1.0, 100.0, axis);
    EXPECT_NE(WriteYaml(axis), WriteYaml(PlainAxis())) << kind;
  }
}

TEST(Specimens, AnAxisWithoutAssignmentsStaysWhatItIs) {
  EXPECT_EQ(WriteYaml(Assigned(PlainAxis(), {})), WriteYaml(PlainAxis()));
  EXPECT_EQ(WriteYaml(Assigned(PlainAxis(), {"lag_ms=0.2"})), WriteYaml(PlainAxis())) << "as it was already";
  EXPECT_THROW(Assigned(PlainAxis(), {"effects.no_such_effect={a: 1}"}), std::runtime_error);
}

}  // namespace
}  // namespace contour::hidden
