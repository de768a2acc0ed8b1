#pragma once

#include <array>
#include <cstddef>

#include "tools/plant_emulator/friction_parameters.h"

namespace contour::plant {

struct MaxwellSlipParameters {
  FrictionParameters base;
  std::size_t elements = 12;
  double breakaway_min_m = 0.5e-6;
  double breakaway_max_m = 20e-6;
  double attraction_N_s = 5e4;  ///< C: how fast slipping elements follow the steady curve
};

/// Generalised Maxwell-slip friction (Lampaert, Al-Bender, Swevers 2003): parallel elements that each stick
/// like a spring until their share of the steady curve, F_i = share_i s(v), and then slip with
///   F_i' = sign(v) C (share_i - |F_i| / s(v))   until the velocity turns round.
/// The break-away travels are spread logarithmically; the shares grow with a power of the travel that makes
/// the stiffness of all elements together sigma0. Hysteresis has non-local memory: minor loops close.
class MaxwellSlipFriction {
 public:
  static constexpr std::size_t kMaxElements = 16;

  /// Throws std::invalid_argument when no power of the travels gives sigma0 with these break-away travels.
  explicit MaxwellSlipFriction(const MaxwellSlipParameters& parameters);

  FrictionLine Line(double expected_m_s, double step_s, const FrictionScale& scale) noexcept;
  void Commit(double velocity_m_s) noexcept;
  [[nodiscard]] double Force_N(double velocity_m_s, const FrictionScale& scale) const noexcept;
  [[nodiscard]] double Elastic_N() const noexcept;
  /// Every element takes its share of the force.
  void SetElastic_N(double force_N) noexcept;

  [[nodiscard]] double share(std::size_t i) const noexcept { return elements_[i].share; }
  [[nodiscard]] double stiffness_N_m(std::size_t i) const noexcept { return elements_[i].stiffness_N_m; }
  [[nodiscard]] std::size_t size() const noexcept { return p_.elements; }

 private:
  struct Element {
    double share = 0.0;
    double stiffness_N_m = 0.0;
    double force_N = 0.0;
    int slip = 0;  ///< direction in which it slips; 0 sticks
  };

  MaxwellSlipParameters p_;
  std::array<Element, kMaxElements> elements_{};
  double step_s_ = 0.0;
  double level_N_ = 1.0;
  portable::Decay decay_;
};

}  // namespace contour::plant
