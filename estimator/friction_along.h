#pragma once

#include <array>
#include <cstddef>

#include "core/horizon.h"
#include "core/state_keeper.h"
#include "estimator/known_effects.h"
#include "estimator/linear_friction.h"

namespace contour {

/// Terms of friction at the points of a reference. From one cycle to the next a reference moves on by one
/// point and only its last one is new; where it does not, bit for bit, all but the memory at its beginning is
/// computed anew. What comes out does not depend on which of the two it was.
class FrictionAlong {
 public:
  /// Points that are looked at; beyond them the last one stands.
  static constexpr std::size_t kMost = 16;

  FrictionAlong() noexcept = default;
  explicit FrictionAlong(const LinearFriction& basis) noexcept : basis_(basis) {}

  void Reset() noexcept { known_ = 0; }
  /// The first `points` of the reference, or as many as there are; none: everything stays. Its element 0 is
  /// what element 1 was in the cycle before.
  void Follow(const AxisHorizon& reference, std::size_t points, const KnownEffects& known) noexcept;

  /// Nothing moves on the way.
  [[nodiscard]] bool Still() const noexcept;
  /// What the bristles carry comes to this share of it. Only where it is still.
  void Relax(double share) noexcept;
  /// What of a friction with these parameters is carried by bristles.
  [[nodiscard]] double Carried_N(const FrictionTerms& parameters) const noexcept;

  [[nodiscard]] const LinearFriction& basis() const noexcept { return basis_; }
  [[nodiscard]] std::size_t size() const noexcept { return known_; }
  [[nodiscard]] const FrictionTerms& terms(std::size_t point) const noexcept { return At(point).terms; }
  [[nodiscard]] double velocity_m_s(std::size_t point) const noexcept { return At(point).velocity_m_s; }
  [[nodiscard]] double position_m(std::size_t point) const noexcept { return At(point).position_m; }

  /// The basis stays as constructed.
  void Keep(StateKeeper& keep) noexcept { keep(nodes_, first_, known_); }

 private:
  struct Node {
    double position_m = 0.0, velocity_m_s = 0.0, acceleration_m_s2 = 0.0;
    FrictionTermsState memory;
    FrictionTerms terms{};
  };
  [[nodiscard]] const Node& At(std::size_t point) const noexcept {
    return nodes_[(first_ + (point < known_ ? point : known_ - 1)) % nodes_.size()];
  }
  [[nodiscard]] Node& At(std::size_t point) noexcept { return nodes_[(first_ + point) % nodes_.size()]; }
  [[nodiscard]] bool MovedOn(const AxisHorizon& reference, std::size_t count) const noexcept;
  void Lay(const ReferencePoint& point, const Node& from, const KnownEffects& known, Node& node) noexcept;

  LinearFriction basis_;
  std::array<Node, kMost> nodes_{};  // a ring
  std::size_t first_ = 0;
  std::size_t known_ = 0;
};

}  // namespace contour
