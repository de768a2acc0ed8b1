#pragma once

#include <cstdint>
#include <string_view>

#include "core/visit.h"

namespace contour {

/// Where a friction law is stated: at the table (N, m) or at the motor (Nm, rad).
enum class FrictionSide : std::uint8_t { kTable, kMotor };

constexpr std::string_view Name(FrictionSide s) noexcept {
  return s == FrictionSide::kTable ? "table" : "motor";
}
constexpr std::string_view Choices(FrictionSide) noexcept { return "table or motor"; }
constexpr bool FromName(std::string_view name, FrictionSide& out) noexcept {
  if (name != "table" && name != "motor") return false;
  out = name == "table" ? FrictionSide::kTable : FrictionSide::kMotor;
  return true;
}

/// LuGre friction of one axis in SI units at the table:
///   F = sigma0 z + sigma1(v) z' + sigma2 v,   z' = v - sigma0 |v| z / g(v),
///   g(v) = Fc + (Fs - Fc) exp(-(|v| / vs)^n) > 0 per direction,   sigma1(v) = sigma1 exp(-(v / vd)^2).
struct Friction {
  double Fs_plus_N = 0.0;
  double Fs_minus_N = 0.0;
  double Fc_plus_N = 0.0;
  double Fc_minus_N = 0.0;
  double vs_m_s = 0.0;
  double stribeck_exponent = 1.0;
  double sigma0_N_m = 0.0;
  double sigma1_Ns_m = 0.0;
  double sigma1_decay_m_s = 0.0;
  double sigma2_Ns_m = 0.0;
  double motor_share = 0.0;  ///< of all of it, that acts on the motor; the rest winds the screw up
};

/// `model.friction` of a machine file. Which of the two sets of numbers counts is said by acts_on.
struct FrictionConfig {
  FrictionSide acts_on = FrictionSide::kTable;
  double stribeck_exponent = 1.0;
  double motor_share_rel = 0.0;

  // acts_on: table
  double Fs_plus_N = 0.0;
  double Fs_minus_N = 0.0;
  double Fc_plus_N = 0.0;
  double Fc_minus_N = 0.0;
  double vs_mm_s = 0.0;
  double sigma0_N_m = 0.0;
  double sigma1_Ns_m = 0.0;
  double sigma1_decay_mm_s = 2.0;
  double sigma2_Ns_m = 0.0;

  // acts_on: motor
  double Fs_plus_Nm = 0.0;
  double Fs_minus_Nm = 0.0;
  double Fc_plus_Nm = 0.0;
  double Fc_minus_Nm = 0.0;
  double vs_rad_s = 0.0;
  double sigma0_Nm_rad = 0.0;
  double sigma1_Nms_rad = 0.0;
  double sigma1_decay_rad_s = 2.5;
  double sigma2_Nms_rad = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("acts_on", acts_on, kAny, "whether the values below are at the table (N) or the motor (Nm)");
    v.Optional("stribeck_exponent", stribeck_exponent, Range{0.5, 4.0}, "n of exp(-(|v| / vs)^n)");
    v.Optional(
        "motor_share_rel", motor_share_rel, Range{0.0, 0.9},
        "share of the friction that acts before the screw (motor, bearings, belt) and does not wind it "
        "up; a circle that something else measured tells it (contour circle-test)");
    if (acts_on == FrictionSide::kTable) {
      v.Required("Fs_plus_N", Fs_plus_N, kPositive, "break-away friction, positive direction");
      v.Required("Fs_minus_N", Fs_minus_N, kPositive, "break-away friction, negative direction");
      v.Required("Fc_plus_N", Fc_plus_N, kPositive, "Coulomb friction, positive direction");
      v.Required("Fc_minus_N", Fc_minus_N, kPositive, "Coulomb friction, negative direction");
      v.Required("vs_mm_s", vs_mm_s, kPositive, "Stribeck velocity");
      v.Required("sigma0_N_m", sigma0_N_m, kPositive, "bristle stiffness");
      v.Optional("sigma1_Ns_m", sigma1_Ns_m, kNotNegative, "bristle damping");
      v.Optional("sigma1_decay_mm_s", sigma1_decay_mm_s, kPositive,
                 "velocity at which bristle damping fades");
      v.Required("sigma2_Ns_m", sigma2_Ns_m, kNotNegative, "viscous friction");
    } else {
      v.Required("Fs_plus_Nm", Fs_plus_Nm, kPositive, "break-away friction, positive direction");
      v.Required("Fs_minus_Nm", Fs_minus_Nm, kPositive, "break-away friction, negative direction");
      v.Required("Fc_plus_Nm", Fc_plus_Nm, kPositive, "Coulomb friction, positive direction");
      v.Required("Fc_minus_Nm", Fc_minus_Nm, kPositive, "Coulomb friction, negative direction");
      v.Required("vs_rad_s", vs_rad_s, kPositive, "Stribeck velocity");
      v.Required("sigma0_Nm_rad", sigma0_Nm_rad, kPositive, "bristle stiffness");
      v.Optional("sigma1_Nms_rad", sigma1_Nms_rad, kNotNegative, "bristle damping");
      v.Optional("sigma1_decay_rad_s", sigma1_decay_rad_s, kPositive,
                 "velocity at which bristle damping fades");
      v.Required("sigma2_Nms_rad", sigma2_Nms_rad, kNotNegative, "viscous friction");
    }
  }
};

/// The same at the table in SI units, whichever side it was stated for. radius_m_rad is R = lead / (2 pi):
/// F = T / R, v = R omega, so stiffness and damping divide by R^2.
constexpr Friction ToSi(const FrictionConfig& c, double radius_m_rad) noexcept {
  if (c.acts_on == FrictionSide::kTable) {
    return {c.Fs_plus_N,   c.Fs_minus_N,     c.Fc_plus_N,
            c.Fc_minus_N,  c.vs_mm_s * 1e-3, c.stribeck_exponent,
            c.sigma0_N_m,  c.sigma1_Ns_m,    c.sigma1_decay_mm_s * 1e-3,
            c.sigma2_Ns_m, c.motor_share_rel};
  }
  const double r = radius_m_rad;
  return {c.Fs_plus_Nm / r,
          c.Fs_minus_Nm / r,
          c.Fc_plus_Nm / r,
          c.Fc_minus_Nm / r,
          c.vs_rad_s * r,
          c.stribeck_exponent,
          c.sigma0_Nm_rad / (r * r),
          c.sigma1_Nms_rad / (r * r),
          c.sigma1_decay_rad_s * r,
          c.sigma2_Nms_rad / (r * r),
          c.motor_share_rel};
}

}  // namespace contour
