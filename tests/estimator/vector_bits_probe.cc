// Runs the filter of `full` with its friction ahead in a closed loop and prints the bits of what came out,
// for tests/estimator/vector_bits.py to compare those of two translations.
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>

#include "tests/estimator/screw_axis.h"

namespace contour {
namespace {

/// FNV-1a over the bits of numbers.
class Digest {
 public:
  void Add(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int shift = 0; shift < 64; shift += 8) hash_ = (hash_ ^ ((bits >> shift) & 0xFFU)) * 1099511628211U;
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 14695981039346656037U;
};

void Run(double stribeck_exponent) {
  FrictionConfig friction = test::WrongFriction();
  friction.stribeck_exponent = stribeck_exponent;
  test::Loop loop(EstimatorKind::kFull, test::WrongMechanics(), friction, {});
  const double w = 2 * std::numbers::pi;
  Digest digest;
  for (int k = 0; k < 3000; ++k) {
    loop.Step([&](double t) {
      return ReferencePoint{1e-3 * std::sin(w * t), 1e-3 * w * std::cos(w * t),
                            -1e-3 * w * w * std::sin(w * t)};
    });
    for (const double value : {loop.estimate.friction_N, loop.estimate.g_plus_N, loop.estimate.g_minus_N,
                               loop.estimate.sigma0_N_m})
      digest.Add(value);
    for (const auto& ahead : loop.preview) {
      digest.Add(ahead.node_N);
      digest.Add(ahead.mid_N);
    }
  }
  std::printf("exponent %g: friction %.17g N, level %.17g N, digest %016llx\n", stribeck_exponent,
              loop.estimate.friction_N, loop.estimate.g_plus_N,
              static_cast<unsigned long long>(digest.value()));
}

}  // namespace
}  // namespace contour

int main() {
  for (const double exponent : {1.0, 2.0}) contour::Run(exponent);
}
