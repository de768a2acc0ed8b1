#include "estimator/linear_friction_fit.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "estimator/friction_model.h"
#include "estimator/turn.h"

namespace contour {
namespace {

// Small swings: amplitudes in presliding lengths, highest speeds in Stribeck velocities.
constexpr std::array<double, 4> kAmplitudes{0.3, 1.0, 3.0, 10.0};
constexpr std::array<double, 4> kSpeeds{0.05, 0.3, 1.0, 5.0};
constexpr int kSamplesPerTurn = 100;
// Reversals out of gross sliding at constant acceleration, in vs^2 per presliding length: from a creeping
// axis to corners at full torque. Travel from the reversal goes up and down in equal ratios.
constexpr std::array<double, 6> kAccelerations{0.001, 0.01, 0.1, 1.0, 10.0, 100.0};
constexpr double kNearest = 0.01, kFarthest = 300.0;  // presliding lengths
constexpr int kSamplesPerWay = 120;
// Of the friction level: what a fit to a smooth law may leave, and what a parameter may be.
constexpr double kLeft = 0.01;
constexpr double kLargest = 0.5;

}  // namespace

void LinearFrictionFit::Add(const FrictionTerms& terms, double friction_N, double weight) noexcept {
  for (std::size_t i = 0; i < kFrictionTerms; ++i) {
    const double weighed = weight * terms[i];
    right_[i] += weighed * friction_N;
    for (std::size_t j = 0; j < kFrictionTerms; ++j) normal_[i][j] += weighed * terms[j];
  }
}

// Cholesky of S N S + 1 with S = diag(std): regular whatever the samples are.
FrictionTerms LinearFrictionFit::Solve(const FrictionTerms& std) const noexcept {
  FrictionMatrix l{};
  FrictionTerms x{};
  for (std::size_t i = 0; i < kFrictionTerms; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = std[i] * normal_[i][j] * std[j] + (i == j ? 1.0 : 0.0);
      for (std::size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      l[i][j] = i == j ? std::sqrt(sum) : sum / l[j][j];
    }
    double sum = std[i] * right_[i];
    for (std::size_t k = 0; k < i; ++k) sum -= l[i][k] * x[k];
    x[i] = sum / l[i][i];
  }
  for (std::size_t i = kFrictionTerms; i-- > 0;) {
    double sum = x[i];
    for (std::size_t k = i + 1; k < kFrictionTerms; ++k) sum -= l[k][i] * x[k];
    x[i] = sum / l[i][i];
  }
  for (std::size_t i = 0; i < kFrictionTerms; ++i) x[i] *= std[i];
  return x;
}

namespace {

/// The law and the terms side by side along one motion.
class Sweep {
 public:
  Sweep(const LinearFriction& basis, const Friction& friction) noexcept
      : basis_(basis), friction_(friction) {}

  /// To `position_m` in `step_s`; taken into the fit unless `fit` is null.
  void Go(double position_m, double velocity_m_s, double step_s, LinearFrictionFit* fit) noexcept {
    const double step_m = position_m - position_m_, mean_m_s = step_m / step_s;
    position_m_ = position_m;
    basis_.Follow(step_m, basis_.scale().centre_m, velocity_m_s, 0.0, memory_, terms_);
    bristle_N_ =
        BristleAfter(bristle_N_, mean_m_s, friction_.sigma0_N_m, FrictionLevel(friction_, mean_m_s), step_s);
    if (fit == nullptr) return;
    const double level_N = FrictionLevel(friction_, velocity_m_s), left_N = kLeft * basis_.scale().level_N;
    fit->Add(terms_, bristle_N_ + BristleDamping(friction_, bristle_N_, velocity_m_s, level_N),
             1.0 / (left_N * left_N));
  }

 private:
  const LinearFriction& basis_;
  const Friction& friction_;
  FrictionTermsState memory_;
  FrictionTerms terms_{};
  double bristle_N_ = 0.0, position_m_ = 0.0;
};

void Swing(const LinearFriction& basis, const Friction& friction, double amplitude_m, double speed_m_s,
           LinearFrictionFit& fit) noexcept {
  Sweep sweep(basis, friction);
  const double step_s = 2.0 * std::numbers::pi * amplitude_m / (speed_m_s * kSamplesPerTurn);
  for (int k = 1; k <= 2 * kSamplesPerTurn; ++k) {
    const CosSin turn = Turn(static_cast<double>(k) / kSamplesPerTurn);
    sweep.Go(amplitude_m * turn.sin, speed_m_s * turn.cos, step_s, k > kSamplesPerTurn ? &fit : nullptr);
  }
}

// Towards `direction` to a standstill at 0, and back.
void Reverse(const LinearFriction& basis, const Friction& friction, double acceleration_m_s2,
             double direction, LinearFrictionFit& fit) noexcept {
  const double ratio = std::pow(kFarthest / kNearest, 1.0 / kSamplesPerWay);
  Sweep sweep(basis, friction);
  const auto go = [&](double travel_m, double from_m, double way) {
    const double v = std::sqrt(2.0 * acceleration_m_s2 * travel_m);
    const double from = std::sqrt(2.0 * acceleration_m_s2 * from_m);
    sweep.Go(-direction * travel_m, way * direction * v, std::abs(v - from) / acceleration_m_s2, &fit);
  };
  double travel_m = kFarthest * basis.scale().presliding_m;
  sweep.Go(-direction * travel_m, direction, travel_m, nullptr);  // slides when it begins
  for (int k = 0; k < kSamplesPerWay; ++k, travel_m /= ratio) go(travel_m / ratio, travel_m, 1.0);
  for (int k = 0; k < kSamplesPerWay; ++k, travel_m *= ratio) go(travel_m * ratio, travel_m, -1.0);
}

}  // namespace

FrictionTerms FitToLuGre(const LinearFriction& basis, const Friction& friction) noexcept {
  const FrictionScale& scale = basis.scale();
  LinearFrictionFit fit;
  for (const double amplitude : kAmplitudes)
    for (const double speed : kSpeeds)
      Swing(basis, friction, amplitude * scale.presliding_m, speed * scale.vs_m_s, fit);
  for (const double a : kAccelerations)
    for (const double direction : {1.0, -1.0})
      Reverse(basis, friction, a * scale.vs_m_s * scale.vs_m_s / scale.presliding_m, direction, fit);
  FrictionTerms std{};
  for (std::size_t i = 0; i <= friction_term::kDamping; ++i) std[i] = kLargest * scale.level_N;
  return fit.Solve(std);
}

}  // namespace contour
