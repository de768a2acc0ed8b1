#include "estimator/friction_along.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace contour {
namespace {

bool SameBits(double a, double b) noexcept {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

}  // namespace

// Elements 0 .. count-2 are what elements 1 .. count-1 were.
bool FrictionAlong::MovedOn(const AxisHorizon& reference, std::size_t count) const noexcept {
  if (count != known_) return false;
  for (std::size_t j = 0; j + 1 < count; ++j) {
    const Node& node = At(j + 1);
    if (!SameBits(node.position_m, reference[j].position_m) ||
        !SameBits(node.velocity_m_s, reference[j].velocity_m_s) ||
        !SameBits(node.acceleration_m_s2, reference[j].acceleration_m_s2))
      return false;
  }
  return true;
}

// `from` and `node` may be the same.
void FrictionAlong::Lay(const ReferencePoint& point, const Node& from, const KnownEffects& known,
                        Node& node) noexcept {
  FrictionTermsState memory = from.memory;
  // Where the level is higher by a factor, the bristle is as stiff as elsewhere and gives way later: its
  // travel counts less by that factor.
  const double factor = known.neutral() ? 1.0 : known.LevelFactor(point.position_m);
  basis_.Follow((point.position_m - from.position_m) / factor, point.position_m, point.velocity_m_s,
                point.acceleration_m_s2, memory, node.terms);
  if (!known.neutral()) {
    for (std::size_t i = 0; i < friction_term::kViscous; ++i)
      if (i != friction_term::kConstant) node.terms[i] *= factor;
  }
  node.memory = memory;
  node.position_m = point.position_m;
  node.velocity_m_s = point.velocity_m_s;
  node.acceleration_m_s2 = point.acceleration_m_s2;
}

bool FrictionAlong::Still() const noexcept {
  for (std::size_t j = 0; j < known_; ++j) {
    const Node& node = At(j);
    if (node.velocity_m_s != 0.0 || node.position_m != At(0).position_m) return false;
  }
  return known_ > 0;
}

double FrictionAlong::Carried_N(const FrictionTerms& parameters) const noexcept {
  double sum_N = 0.0;
  for (std::size_t i = 0; i < kFrictionTerms; ++i)
    if (LinearFriction::Carried(i)) sum_N += parameters[i] * terms(0)[i];
  return sum_N;
}

void FrictionAlong::Relax(double share) noexcept {
  for (std::size_t j = 0; j < known_; ++j) {
    Node& node = At(j);
    for (double& bristle : node.memory.dahl) bristle *= share;
    for (double& stop : node.memory.stop) stop *= share;
    for (double& sign : node.memory.relaxed) sign *= share;
    for (std::size_t i = 0; i < kFrictionTerms; ++i)
      if (LinearFriction::Carried(i)) node.terms[i] *= share;
  }
}

void FrictionAlong::Follow(const AxisHorizon& reference, std::size_t points,
                           const KnownEffects& known) noexcept {
  const std::size_t count = std::min({points, reference.size(), kMost});
  if (count == 0) return;
  if (MovedOn(reference, count)) {
    const Node last = At(count - 1);
    first_ = (first_ + 1) % nodes_.size();
    Lay(reference[count - 1], last, known, At(count - 1));
    return;
  }
  Node from;
  if (known_ == 0)
    from.position_m = reference[0].position_m;  // at rest, nothing is known of its past
  else
    from = At(known_ > 1 ? 1 : 0);
  first_ = 0;
  known_ = count;
  for (std::size_t j = 0; j < count; ++j) Lay(reference[j], j == 0 ? from : At(j - 1), known, At(j));
}

}  // namespace contour
