// The loops on record, on axes that are integrated in steps of 25 us by equations of their own.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "design/loop_margins.h"
#include "tests/design/family_axes.h"

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr int kParts = 40;

using State = std::array<double, 5>;  // p1 v1 p2 v2 u

State Rate(const TwoInertiaAxis& a, const State& x, double command_N, double force_N) {
  const double screw_N = a.stiffness_N_m * (x[0] - x[2]) + a.damping_Ns_m * (x[1] - x[3]);
  return {x[1], (x[4] - screw_N) / a.motor_mass_kg, x[3],
          (screw_N - a.viscous_Ns_m * x[3] - force_N) / a.table_mass_kg, (command_N - x[4]) / a.lag_s};
}

void RungeKutta(const TwoInertiaAxis& a, State& x, double command_N, double force_N) {
  const double h = kPeriod_s / kParts;
  const auto plus = [](const State& s, double share, const State& r) {
    State out = s;
    for (std::size_t i = 0; i < s.size(); ++i) out[i] += share * r[i];
    return out;
  };
  const State k1 = Rate(a, x, command_N, force_N);
  const State k2 = Rate(a, plus(x, 0.5 * h, k1), command_N, force_N);
  const State k3 = Rate(a, plus(x, 0.5 * h, k2), command_N, force_N);
  const State k4 = Rate(a, plus(x, h, k3), command_N, force_N);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
}

/// The cycle's side of the loop, from the numbers of TwoInertiaLoop alone.
class Controller {
 public:
  explicit Controller(const TwoInertiaLoop& loop) : loop_(loop) {}
  double Step(double encoder_m) {
    const double innovation = encoder_m - x_[0];
    for (std::size_t i = 0; i < kLoopMotion; ++i) x_[i] += loop_.gain[i][0] * innovation;
    d_ += loop_.gain[kObserverDisturbance][0] * innovation;
    double wanted = loop_.disturbance_to_command * d_ - loop_.regulator_queue[0] * queued_;
    for (std::size_t i = 0; i < kLoopMotion; ++i) wanted -= loop_.regulator_motion[i] * x_[i];
    const Biquad& f = loop_.filter;
    const double command = f.b0 * wanted + s1_;
    s1_ = f.b1 * wanted - f.a1 * command + s2_;
    s2_ = f.b2 * wanted - f.a2 * command;
    LoopMotion next{};
    for (std::size_t i = 0; i < kLoopMotion; ++i) {
      next[i] = loop_.motion_from_input[0][i] * queued_ + loop_.motion_from_disturbance[i] * d_;
      for (std::size_t j = 0; j < kLoopMotion; ++j) next[i] += loop_.motion_from_motion[i][j] * x_[j];
    }
    x_ = next;
    queued_ = command;
    return command;
  }

 private:
  const TwoInertiaLoop& loop_;
  LoopMotion x_{};
  double d_ = 0.0, queued_ = 0.0, s1_ = 0.0, s2_ = 0.0;
};

double PeakOf(const LoopAxis& a, const TwoInertiaLoop& loop) {
  Controller controller(loop);
  State x{};
  double acting_N = 0.0, peak_m = 0.0;
  const double force_N = a.limits.force_step * a.rated_force_N;
  for (int j = 0; j < 400; ++j) {
    const double next_N = controller.Step(x[0]);
    for (int i = 0; i < kParts; ++i) {
      const double time_s = kPeriod_s * (j + (i + 0.5) / kParts);
      RungeKutta(a.axis, x, acting_N, force_N * (1.0 - std::exp(-time_s / 4e-3)));
      peak_m = std::max(peak_m, std::fabs(x[2]));
    }
    acting_N = next_N;
  }
  EXPECT_LT(std::fabs(x[2]), 0.05 * peak_m) << "the table comes back";
  return peak_m;
}

struct OnRecord {
  std::string axis;
  LoopTuning tuning;
  double peak_um;  ///< docs/laboratory/loop_designs.md
};

class ForceStepOf : public testing::TestWithParam<OnRecord> {};

TEST_P(ForceStepOf, TableMovesAsFarAsTheRecordSays) {
  const LoopAxis axis = AxisOf(GetParam().axis);
  const TwoInertiaLoop loop = DesignLoop(axis.axis, GetParam().tuning, kPeriod_s, false);
  const double peak_um = 1e6 * PeakOf(axis, loop);
  EXPECT_NEAR(peak_um, GetParam().peak_um, 0.04 * GetParam().peak_um);
  const double force_N = axis.limits.force_step * axis.rated_force_N;
  EXPECT_NEAR(1e6 * UnderForceStep(SlidingMember(axis), loop, kPeriod_s, force_N).peak_m, peak_um,
              0.03 * peak_um);
  // Two digits of the record lose little of the margins.
  const LoopVerdict verdict = LoopJudge(axis, kPeriod_s).Judge(loop);
  EXPECT_TRUE(Acceptable(verdict, 0.15)) << Binding(verdict).name << " " << Binding(verdict).peak;
}

// What supervision does to a loop that oscillates must not take stability away.
TEST_P(ForceStepOf, SoftenedLoopStaysStableOnEveryMember) {
  const LoopAxis axis = AxisOf(GetParam().axis);
  const LoopJudge judge(axis, kPeriod_s);
  const double before = judge.Judge(DesignLoop(axis.axis, GetParam().tuning, kPeriod_s, false)).worst[0].peak;
  for (const double share : {0.7, 0.5, 0.3}) {
    LoopTuning soft = GetParam().tuning;
    soft.regulator_Hz *= share;
    const LoopVerdict v = judge.Judge(DesignLoop(axis.axis, soft, kPeriod_s, false));
    for (const WorstMember& w : v.worst) EXPECT_TRUE(w.stable) << share << " " << w.name;
    EXPECT_LT(v.worst[0].peak, before) << share;
  }
}

LoopTuning Tuning(std::array<double, 9> v) {
  return {v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8], 1.0, 5.0};
}

INSTANTIATE_TEST_SUITE_P(
    Family, ForceStepOf,
    testing::Values(OnRecord{"base", Tuning({26.7, 0.12, 0.10, 274, 1038, 793, 0.75, 0.10, 0.06}), 21.0},
                    OnRecord{"t20", Tuning({19.1, 0.04, 0.10, 250, 973, 1142, 0.76, 0.10, 0.03}), 30.4},
                    OnRecord{"t30", Tuning({15.8, 0.05, 0.23, 272, 1165, 1350, 0.77, 0.10, 0.03}), 36.3},
                    OnRecord{"t50", Tuning({13.1, 0.20, 0.43, 228, 536, 1252, 0.78, 0.10, 0.05}), 39.7},
                    OnRecord{"m100", Tuning({17.5, 0.03, 0.07, 271, 552, 66, 0.67, 1.19, 0.46}), 30.0},
                    OnRecord{"m300", Tuning({24.6, 0.50, 0.63, 226, 600, 270, 0.92, 1.23, 0.78}), 17.2},
                    OnRecord{"soft", Tuning({15.6, 0.10, 1.44, 236, 842, 903, 0.55, 0.79, 0.42}), 55.8}),
    [](const auto& at) { return at.param.axis; });

}  // namespace
}  // namespace contour
