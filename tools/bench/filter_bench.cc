#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "core/wide_vectors.h"
#include "estimator/axis_estimator.h"

// Time of one cycle of each estimator: filter, prediction and, for `full`, the preview over a horizon of 20.
namespace contour {
namespace {

FrictionConfig NominalFriction() {
  FrictionConfig f;
  f.Fs_plus_N = 52;
  f.Fs_minus_N = 47;
  f.Fc_plus_N = 42;
  f.Fc_minus_N = 36;
  f.vs_mm_s = 2;
  f.sigma0_N_m = 5e6;
  f.sigma1_Ns_m = 3000;
  f.sigma2_Ns_m = 500;
  return f;
}

Mechanics NominalMechanics() { return ToSi(MechanicsConfig{5.0, 5e-5, 10.0, 40.0, 1100.0}); }

// A motion of 100 um and the force it takes, well enough for a filter to follow.
std::vector<AxisEstimatorInput> Motion() {
  std::vector<AxisEstimatorInput> inputs;
  const Friction friction = ToSi(NominalFriction(), NominalMechanics().radius_m_rad);
  const double mass_kg = NominalMechanics().mass_kg;
  const double w = 4.9;
  FrictionState axis;
  std::array<double, 3> force_N{};
  for (int k = 0; k < 4000; ++k) {
    const double t = 1e-3 * k;
    const double p = 100e-6 * (1.0 - std::cos(w * t)), v = 100e-6 * w * std::sin(w * t);
    const double u =
        4e6 * (p - axis.position_m) + 4e4 * (v - axis.velocity_m_s) + TotalFriction(friction, axis);
    AxisEstimatorInput in;
    in.position_m = axis.position_m;
    in.fresh = in.enabled = true;
    in.at_rest = false;
    in.force_N = force_N;
    in.commanded_velocity_m_s = v;
    in.commanded_acceleration_m_s2 = 100e-6 * w * w * std::cos(w * t);
    inputs.push_back(in);
    for (int i = 0; i < 10; ++i) axis = StepRigid(friction, axis, mass_kg, u, 1e-4);
    force_N = {u, force_N[0], force_N[1]};
  }
  return inputs;
}

void Estimator(benchmark::State& state, EstimatorKind kind, bool preview) {
  const auto inputs = Motion();
  AxisEstimator estimator(kind, NominalMechanics(), NominalFriction(), {}, 1e-3, 0.2e-3, 5e-3 / 1048576);
  AxisHorizon horizon;
  FrictionPreview ahead;
  std::size_t k = 0;
  for (auto _ : state) {
    const AxisEstimatorInput& in = inputs[k];
    k = k + 1 < inputs.size() ? k + 1 : 0;
    if (k == 0) estimator.Reset(0.0);
    benchmark::DoNotOptimize(estimator.Update(in));
    if (preview) {
      horizon.clear();
      for (std::size_t j = 0; j < 23; ++j) {
        const AxisEstimatorInput& at = inputs[(k + j) % inputs.size()];
        horizon.push_back({at.position_m, at.commanded_velocity_m_s, at.commanded_acceleration_m_s2});
      }
      estimator.PreviewFriction(horizon, horizon.size(), ahead);
      benchmark::DoNotOptimize(ahead);
    }
  }
}

BENCHMARK_CAPTURE(Estimator, kinematic, EstimatorKind::kKinematic, false);
BENCHMARK_CAPTURE(Estimator, disturbance_observer, EstimatorKind::kDisturbanceObserver, false);
BENCHMARK_CAPTURE(Estimator, srukf4, EstimatorKind::kSrukf4, false);
BENCHMARK_CAPTURE(Estimator, ekf7, EstimatorKind::kEkf7, false);
BENCHMARK_CAPTURE(Estimator, srukf7, EstimatorKind::kSrukf7, false);
BENCHMARK_CAPTURE(Estimator, full, EstimatorKind::kFull, true);

template <std::size_t N>
CONTOUR_WIDE_VECTORS void PredictAndUpdate(SqrtUkf<N>& filter, const StateVector<N>& noise) {
  Innovation innovation;
  filter.Predict(
      [](SigmaPoints<N>& points) noexcept {
        for (std::size_t i = 0; i + 1 < N; ++i) {
          for (std::size_t k = 0; k < SigmaPoints<N>::kStride; ++k)
            points.row[i][k] += 0.1 * points.row[i + 1][k];
        }
      },
      noise);
  filter.UpdateState0(0.1, 0.1, {1e9, 1e9}, AllStates<N>(), innovation);
}

// Predict and update alone, on models of one multiplication per state: what the filter itself costs,
// translated as the cycle's is.
template <std::size_t N>
void BareFilter(benchmark::State& state) {
  SqrtUkf<N> filter;
  StateVector<N> noise{};
  for (std::size_t i = 0; i < N; ++i) {
    filter.s[i][i] = 1.0;
    noise[i] = 0.01;
  }
  for (auto _ : state) {
    PredictAndUpdate<N>(filter, noise);
    benchmark::DoNotOptimize(filter);
  }
}
BENCHMARK(BareFilter<4>);
BENCHMARK(BareFilter<7>);

}  // namespace
}  // namespace contour
