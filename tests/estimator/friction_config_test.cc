#include "estimator/friction_config.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/axis.h"
#include "estimator/estimator_config.h"

namespace contour {
namespace {

// Collects the keys that a configuration lists.
struct KeyList {
  std::vector<std::string> required;
  std::vector<std::string> optional;
  template <class T>
  void Required(std::string_view key, T&, const Range&, std::string_view) {
    required.emplace_back(key);
  }
  template <class T>
  void Optional(std::string_view key, T&, const Range&, std::string_view) {
    optional.emplace_back(key);
  }
};

TEST(FrictionConfig, ListsTheKeysOfTheSideItActsOn) {
  FrictionConfig c;
  KeyList table;
  c.Visit(table);
  EXPECT_EQ(table.required, (std::vector<std::string>{"Fs_plus_N", "Fs_minus_N", "Fc_plus_N", "Fc_minus_N",
                                                      "vs_mm_s", "sigma0_N_m", "sigma2_Ns_m"}));
  EXPECT_EQ(table.optional.front(), "acts_on");
  c.acts_on = FrictionSide::kMotor;
  KeyList motor;
  c.Visit(motor);
  EXPECT_EQ(motor.required,
            (std::vector<std::string>{"Fs_plus_Nm", "Fs_minus_Nm", "Fc_plus_Nm", "Fc_minus_Nm", "vs_rad_s",
                                      "sigma0_Nm_rad", "sigma2_Nms_rad"}));
}

TEST(FrictionConfig, MotorAndTableValuesOfTheSameFrictionAgree) {
  const double r = ScrewRadius_m_rad(5.0);
  FrictionConfig table;
  table.Fs_plus_N = 52;
  table.Fs_minus_N = 47;
  table.Fc_plus_N = 42;
  table.Fc_minus_N = 36;
  table.vs_mm_s = 2;
  table.sigma0_N_m = 5e6;
  table.sigma1_Ns_m = 3000;
  table.sigma1_decay_mm_s = 2.5;
  table.sigma2_Ns_m = 500;
  table.stribeck_exponent = 2;
  FrictionConfig motor;
  motor.acts_on = FrictionSide::kMotor;
  motor.Fs_plus_Nm = 52 * r;
  motor.Fs_minus_Nm = 47 * r;
  motor.Fc_plus_Nm = 42 * r;
  motor.Fc_minus_Nm = 36 * r;
  motor.vs_rad_s = 2e-3 / r;
  motor.sigma0_Nm_rad = 5e6 * r * r;
  motor.sigma1_Nms_rad = 3000 * r * r;
  motor.sigma1_decay_rad_s = 2.5e-3 / r;
  motor.sigma2_Nms_rad = 500 * r * r;
  motor.stribeck_exponent = 2;
  const Friction a = ToSi(table, r);
  const Friction b = ToSi(motor, r);
  EXPECT_DOUBLE_EQ(a.Fs_plus_N, b.Fs_plus_N);
  EXPECT_DOUBLE_EQ(a.Fs_minus_N, b.Fs_minus_N);
  EXPECT_DOUBLE_EQ(a.Fc_plus_N, b.Fc_plus_N);
  EXPECT_DOUBLE_EQ(a.Fc_minus_N, b.Fc_minus_N);
  EXPECT_DOUBLE_EQ(a.vs_m_s, b.vs_m_s);
  EXPECT_DOUBLE_EQ(a.sigma0_N_m, b.sigma0_N_m);
  EXPECT_DOUBLE_EQ(a.sigma1_Ns_m, b.sigma1_Ns_m);
  EXPECT_DOUBLE_EQ(a.sigma1_decay_m_s, b.sigma1_decay_m_s);
  EXPECT_DOUBLE_EQ(a.sigma2_Ns_m, b.sigma2_Ns_m);
  EXPECT_EQ(a.stribeck_exponent, b.stribeck_exponent);
  EXPECT_DOUBLE_EQ(a.vs_m_s, 2e-3);
}

TEST(FrictionConfig, SideNamesGoBothWays) {
  FrictionSide s = FrictionSide::kTable;
  EXPECT_TRUE(FromName("motor", s));
  EXPECT_EQ(s, FrictionSide::kMotor);
  EXPECT_EQ(Name(s), "motor");
  EXPECT_FALSE(FromName("screw", s));
  EXPECT_EQ(s, FrictionSide::kMotor);
}

TEST(EstimatorConfig, EveryKeyIsOptional) {
  EstimatorConfig c;
  KeyList keys;
  c.Visit(keys);
  EXPECT_TRUE(keys.required.empty());
  EXPECT_GE(keys.optional.size(), 15u);
}

}  // namespace
}  // namespace contour
