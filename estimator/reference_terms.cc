#include "estimator/reference_terms.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "core/wide_vectors.h"

namespace contour {
namespace {

enum Node : std::size_t { kAt, kNodeVelocity, kAcceleration };
enum Term : std::size_t {
  kMiddleVelocity = LevelCorrection::kTerms,  // after the basis
  kLowSpeed,
  kNodeSigma1,
  kMiddleSigma1,
};

using Short = std::array<double, kMaxHorizonPoints>;

/// Other than 0 where the bits differ.
inline std::uint64_t Differ(double a, double b) noexcept {
  std::uint64_t x, y;
  std::memcpy(&x, &a, sizeof x);
  std::memcpy(&y, &b, sizeof y);
  return x ^ y;
}

}  // namespace

// Elements 0 .. count-1 are what elements 1 .. count were.
bool ReferenceTerms::MovedOn(const AxisHorizon& reference, std::size_t count) const noexcept {
  if (count != count_ || reference.size() < count) return false;
  const double *position = &nodes_[kAt][head_ + 1], *velocity = &nodes_[kNodeVelocity][head_ + 1],
               *acceleration = &nodes_[kAcceleration][head_ + 1];
  std::uint64_t differ = 0;
  for (std::size_t j = 0; j < count; ++j) {
    const ReferencePoint& point = reference[j];
    differ |= Differ(point.position_m, position[j]) | Differ(point.velocity_m_s, velocity[j]) |
              Differ(point.acceleration_m_s2, acceleration[j]);
  }
  return differ == 0;
}

void ReferenceTerms::Lay(const AxisHorizon& reference, std::size_t from, std::size_t count) noexcept {
  for (std::size_t j = from; j <= count; ++j) {
    const ReferencePoint& point = reference[std::min(j, reference.size() - 1)];
    nodes_[kAt][head_ + j] = point.position_m;
    nodes_[kNodeVelocity][head_ + j] = point.velocity_m_s;
    nodes_[kAcceleration][head_ + j] = point.acceleration_m_s2;
  }
}

[[gnu::always_inline]] inline void ReferenceTerms::ComputeAll(const SevenStateModel& model,
                                                              const LevelCorrection& correction) noexcept {
  // Rows of their own, so that the compiler sees that none of them is another.
  alignas(32) Short position, node_velocity, velocity, low_speed, node_sigma1, middle_sigma1;
  alignas(32) std::array<Short, LevelCorrection::kTerms> basis;
  const std::size_t begin = head_, size = count_;
  for (std::size_t j = 0; j < size; ++j) position[j] = nodes_[kAt][begin + j];
  for (std::size_t j = 0; j < size; ++j) node_velocity[j] = nodes_[kNodeVelocity][begin + j];
  for (std::size_t j = 0; j < size; ++j)
    velocity[j] = 0.5 * (nodes_[kNodeVelocity][begin + j] + nodes_[kNodeVelocity][begin + j + 1]);
  correction.Basis(position, velocity, size, basis);
  model.LowSpeeds(velocity, size, low_speed);
  const double sigma1 = model.friction().sigma1_Ns_m;
  const double per_decay = 1.0 / model.friction().sigma1_decay_m_s;
  for (std::size_t j = 0; j < size; ++j) {
    const double at_node = node_velocity[j] * per_decay, in_middle = velocity[j] * per_decay;
    node_sigma1[j] = sigma1 * ExpOfNegative(-at_node * at_node);
    middle_sigma1[j] = sigma1 * ExpOfNegative(-in_middle * in_middle);
  }
  const auto keep = [&](std::size_t term, const Short& row) {
    for (std::size_t j = 0; j < size; ++j) terms_[term][begin + j] = row[j];
  };
  for (std::size_t i = 0; i < basis.size(); ++i) keep(i, basis[i]);
  keep(kMiddleVelocity, velocity);
  keep(kLowSpeed, low_speed);
  keep(kNodeSigma1, node_sigma1);
  keep(kMiddleSigma1, middle_sigma1);
}

// The exponentials of one place are side by side, and take as long as one of them.
[[gnu::always_inline]] inline void ReferenceTerms::ComputeLast(const SevenStateModel& model,
                                                               const LevelCorrection& correction) noexcept {
  const std::size_t last = head_ + count_ - 1;
  const double node_velocity = nodes_[kNodeVelocity][last];
  const double velocity = 0.5 * (node_velocity + nodes_[kNodeVelocity][last + 1]);
  const double per_decay = 1.0 / model.friction().sigma1_decay_m_s;
  const double at_node = node_velocity * per_decay, in_middle = velocity * per_decay;
  std::array<double, 1> power;
  model.StribeckPowers(std::array<double, 1>{velocity}, 1, power);
  const wide::Quad exponents{correction.LowSpeedExponent(velocity), -power[0], -at_node * at_node,
                             -in_middle * in_middle};
  wide::Quad e;
  ExpOfNegative<wide::Quad>(exponents, e);
  const LevelCorrection::Terms ripple = correction.RippleBasis(nodes_[kAt][last]);
  for (std::size_t i = 0; i < LevelCorrection::kRippleTerms; ++i) terms_[i][last] = ripple[i];
  const double sigma1 = model.friction().sigma1_Ns_m;
  terms_[LevelCorrection::kRippleTerms][last] = e[0];
  terms_[kMiddleVelocity][last] = velocity;
  terms_[kLowSpeed][last] = e[1];
  terms_[kNodeSigma1][last] = sigma1 * e[2];
  terms_[kMiddleSigma1][last] = sigma1 * e[3];
}

void ReferenceTerms::Rewind() noexcept {
  for (Row& row : nodes_)
    std::copy_n(row.begin() + static_cast<std::ptrdiff_t>(head_), count_ + 1, row.begin());
  for (Row& row : terms_) std::copy_n(row.begin() + static_cast<std::ptrdiff_t>(head_), count_, row.begin());
  head_ = 0;
}

CONTOUR_WIDE_VECTORS
ReferenceTerms::View ReferenceTerms::Follow(const SevenStateModel& model, const LevelCorrection& correction,
                                            const AxisHorizon& reference, std::size_t count) noexcept {
  if (MovedOn(reference, count)) {
    if (head_ + 1 + count >= kLength) Rewind();
    ++head_;
    Lay(reference, count, count);
    ComputeLast(model, correction);
  } else {
    head_ = 0;
    count_ = count;
    Lay(reference, 0, count);
    ComputeAll(model, correction);
  }
  View view{&nodes_[kAt][head_],
            &nodes_[kNodeVelocity][head_],
            &nodes_[kAcceleration][head_],
            &terms_[kMiddleVelocity][head_],
            {},
            &terms_[kLowSpeed][head_],
            &terms_[kNodeSigma1][head_],
            &terms_[kMiddleSigma1][head_]};
  for (std::size_t i = 0; i < view.basis.size(); ++i) view.basis[i] = &terms_[i][head_];
  return view;
}

}  // namespace contour
