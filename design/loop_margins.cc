#include "design/loop_margins.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "design/spectral_radius.h"

namespace contour {
namespace {

using Index = Eigen::Index;

// From half a thousandth of the sampling frequency to its half. Above a hundredth, where modes are, so dense
// that one of 1 % damping has several; below, the loop is smooth.
constexpr double kLowest = 5e-4;
constexpr double kModesFrom = 1e-2;
constexpr double kHighest = 0.4999;
constexpr std::size_t kSmooth = 40;
constexpr std::size_t kFrequencies = 500;
constexpr std::size_t kFrequenciesOfReport = 6000;
constexpr double kStepLag_s = 4e-3;
constexpr double kStepTime_s = 0.2;
constexpr double kStepSettles_s = 0.01;
constexpr double kGone = 0.1;
// A reading is off by this much of a step of the encoder, one standard deviation.
constexpr double kNoiseOfStep = 0.3;

std::vector<double> Frequencies(std::size_t count) {
  std::vector<double> f(count);
  for (std::size_t i = 0; i < count; ++i) {
    const bool smooth = i < kSmooth;
    const double low = smooth ? kLowest : kModesFrom, high = smooth ? kModesFrom : kHighest;
    const auto at = static_cast<double>(smooth ? i : i - kSmooth);
    f[i] = low * std::pow(high / low, at / static_cast<double>(smooth ? kSmooth : count - 1 - kSmooth));
  }
  return f;
}

/// Forces in units that make all states of plant and controller of one size: it moves the axis by a metre per
/// period in a period.
double ForceUnit_N(const TwoInertiaAxis& a, double period_s) {
  return (a.motor_mass_kg + a.table_mass_kg) / (period_s * period_s);
}

/// Plant and controller as one; inputs and outputs are those of the plant but for the command.
LoopMatrix Closed(const LinearSystem& plant, const LinearSystem& controller) {
  const Index n = plant.a.rows(), m = controller.a.rows();
  LoopMatrix a(n + m, n + m);
  a.topLeftCorner(n, n) = plant.a + plant.b.col(0) * controller.d * plant.c;
  a.topRightCorner(n, m) = plant.b.col(0) * controller.c;
  a.bottomLeftCorner(m, n) = controller.b * plant.c;
  a.bottomRightCorner(m, m) = controller.a;
  return a;
}

double ErrorOf_m(const ForceStep& step) { return step.peak_m + 2.0 * step.mean_m; }

/// L of negative feedback.
std::vector<Complex> OpenLoop(const std::vector<std::array<Complex, 2>>& plant,
                              const std::vector<std::array<Complex, 2>>& controller) {
  std::vector<Complex> loop(plant.size());
  for (std::size_t i = 0; i < loop.size(); ++i)
    loop[i] = -(controller[i][0] * plant[i][0] + controller[i][1] * plant[i][1]);
  return loop;
}

/// Of the chords between neighbouring frequencies: a mode may pass -1 between two of them.
double Peak(const std::vector<Complex>& loop) {
  double least = std::norm(1.0 + loop.front());
  for (std::size_t i = 1; i < loop.size(); ++i) {
    const Complex from = 1.0 + loop[i - 1], step = loop[i] - loop[i - 1];
    const double length2 = std::norm(step);
    const double along = -(from.real() * step.real() + from.imag() * step.imag());
    const double share = length2 > 0.0 ? std::clamp(along / length2, 0.0, 1.0) : 0.0;
    least = std::min(least, std::norm(from + share * step));
  }
  return 1.0 / std::sqrt(least);
}

}  // namespace

LoopMargins MarginsOf(const std::vector<Complex>& open, const std::vector<double>& frequencies_Hz) {
  LoopMargins m;
  m.gain_up = std::numeric_limits<double>::infinity();
  m.phase_deg = 180.0;
  for (std::size_t i = 0; i < open.size(); ++i) {
    const double peak = 1.0 / std::abs(1.0 + open[i]);
    if (peak > m.peak) {
      m.peak = peak;
      m.peak_Hz = frequencies_Hz[i];
    }
    if (i == 0) continue;
    const Complex a = open[i - 1], b = open[i];
    if (a.imag() * b.imag() < 0.0) {
      const double share = a.imag() / (a.imag() - b.imag());
      const double real = a.real() + share * (b.real() - a.real());
      if (real < -1.0) m.gain_down = std::max(m.gain_down, -1.0 / real);
      if (real < 0.0 && real >= -1.0) m.gain_up = std::min(m.gain_up, -1.0 / real);
    }
    if ((std::abs(a) - 1.0) * (std::abs(b) - 1.0) < 0.0) {
      const double to_minus_one = 180.0 - std::fabs(std::arg(b)) * 180.0 / std::numbers::pi;
      m.phase_deg = std::min(m.phase_deg, to_minus_one);
      if (m.bandwidth_Hz == 0.0 && std::abs(b) < 1.0) m.bandwidth_Hz = frequencies_Hz[i];
    }
  }
  return m;
}

LoopMargins MarginsOn(const LoopMember& member, const TwoInertiaLoop& loop, double period_s) {
  const double unit_N = ForceUnit_N(member.axis, period_s);
  const LinearSystem plant = MakePlant(member, period_s, unit_N).system;
  const LinearSystem controller = MakeController(loop, unit_N);
  std::vector<double> f = Frequencies(kFrequenciesOfReport);
  const std::vector<Complex> open = OpenLoop(Response(plant, 0, f), ResponseToBoth(controller, f));
  for (double& frequency : f) frequency /= period_s;
  LoopMargins m = MarginsOf(open, f);
  m.growth_per_cycle = SpectralRadius(Closed(plant, controller));
  m.stable = m.growth_per_cycle < 1.0;
  return m;
}

double GrowthOn(const LoopMember& member, const TwoInertiaLoop& loop, double period_s) {
  const double unit_N = ForceUnit_N(member.axis, period_s);
  return SpectralRadius(Closed(MakePlant(member, period_s, unit_N).system, MakeController(loop, unit_N)));
}

ForceStep UnderForceStep(const LoopMember& member, const TwoInertiaLoop& loop, double period_s,
                         double force_N, ForcePlace place) {
  const double unit_N = ForceUnit_N(member.axis, period_s);
  const LinearSystem plant = MakePlant(member, period_s, unit_N).system;
  const LoopMatrix closed = Closed(plant, MakeController(loop, unit_N));
  const Index n = plant.a.rows();
  // A force on the motor acts as a torque that nobody commanded.
  const LoopMatrix pushes = place == ForcePlace::kMotor ? plant.b.col(0) : plant.b.col(1);
  LoopMatrix state = LoopMatrix::Zero(closed.rows(), 1);
  ForceStep step;
  const auto periods = static_cast<int>(std::ceil(kStepTime_s / period_s));
  int settled = 0;
  std::vector<double> errors_m;
  errors_m.reserve(static_cast<std::size_t>(periods));
  for (int j = 0; j < periods; ++j) {
    const double time_s = (j + 0.5) * period_s;
    state = (closed * state).eval();
    state.topRows(n) += pushes * (force_N / unit_N * (1.0 - std::exp(-time_s / kStepLag_s)));
    const double table_m = std::fabs(state(2, 0));
    step.peak_m = std::max(step.peak_m, table_m);
    step.mean_m += table_m / periods;
    step.left_m = table_m;
    errors_m.push_back(table_m);
    if ((j + 1) * period_s < kStepSettles_s) continue;
    step.rms_m += table_m * table_m;
    ++settled;
  }
  step.rms_m = std::sqrt(step.rms_m / std::max(1, settled));
  while (!errors_m.empty() && errors_m.back() <= kGone * step.peak_m) errors_m.pop_back();
  step.gone_s = static_cast<double>(errors_m.size()) * period_s;
  return step;
}

double StepError_m(const LoopVerdict& v) {
  const double table_m = std::max(ErrorOf_m(v.step), ErrorOf_m(v.step_astray));
  return 0.5 * (table_m + ErrorOf_m(v.step_of_motor));
}

bool Acceptable(const LoopVerdict& v, double tolerance) {
  for (std::size_t i = 0; i < kMemberKinds; ++i) {
    if (static_cast<MemberKind>(i) == MemberKind::kCreeping) continue;
    const WorstMember& w = v.worst[i];
    if (!w.stable || w.peak > w.limit * (1.0 + tolerance)) return false;
  }
  return v.torque_noise <= v.noise_limit * (1.0 + tolerance);
}

const WorstMember& Limiting(const LoopVerdict& v) {
  const auto nearer = [](const WorstMember& a, const WorstMember& b) {
    if (a.stable != b.stable) return a.stable;
    return a.peak / a.limit < b.peak / b.limit;
  };
  static_assert(static_cast<std::size_t>(MemberKind::kCreeping) == kMemberKinds - 1);
  return *std::max_element(v.worst.begin(), v.worst.end() - 1, nearer);
}

const WorstMember& Binding(const LoopVerdict& v) {
  const WorstMember& creeping = v.worst[static_cast<std::size_t>(MemberKind::kCreeping)];
  return creeping.name.empty() ? Limiting(v) : creeping;
}

LoopJudge::LoopJudge(const LoopAxis& axis, double period_s)
    : LoopJudge(axis, period_s, UncertaintySet(axis)) {}

LoopJudge::LoopJudge(const LoopAxis& axis, double period_s, const std::vector<LoopMember>& members)
    : axis_(axis), period_s_(period_s), frequencies_(Frequencies(kFrequencies)) {
  const double unit_N = ForceUnit_N(axis.axis, period_s);
  for (const LoopMember& m : members) {
    LinearSystem plant = MakePlant(m, period_s, unit_N).system;
    auto response = Response(plant, 0, frequencies_);
    members_.push_back({m, std::move(plant), std::move(response)});
  }
}

LoopVerdict LoopJudge::Judge(const TwoInertiaLoop& loop) const {
  const double unit_N = ForceUnit_N(axis_.axis, period_s_);
  const LinearSystem controller = MakeController(loop, unit_N);
  const auto response = ResponseToBoth(controller, frequencies_);
  LoopVerdict v;
  for (std::size_t i = 0; i < kMemberKinds; ++i)
    v.worst[i].limit = PeakLimit(axis_.limits, static_cast<MemberKind>(i));
  for (const Member& m : members_) {
    WorstMember& worst = v.worst[static_cast<std::size_t>(m.member.kind)];
    const double growth = SpectralRadius(Closed(m.plant, controller), 1.0);
    const double peak = Peak(OpenLoop(m.response, response));
    const bool stable = growth < 1.0;
    const bool worse = stable == worst.stable ? (stable ? peak > worst.peak : growth > worst.growth_per_cycle)
                                              : worst.stable;
    if (worse) worst = {m.member.name, stable, peak, growth, worst.limit};
  }
  v.step =
      UnderForceStep(members_.front().member, loop, period_s_, axis_.limits.force_step * axis_.rated_force_N);
  v.step_astray = v.step_of_motor = v.step;
  if (axis_.scale_step_m) {
    v.step_of_motor = UnderForceStep(members_.front().member, loop, period_s_,
                                     axis_.limits.force_step * axis_.rated_force_N, ForcePlace::kMotor);
    for (const double stiffness : {1.0 - axis_.limits.far_off, 1.0 + axis_.limits.far_off}) {
      LoopMember m = members_.front().member;
      m.axis.stiffness_N_m *= stiffness;
      const ForceStep step =
          UnderForceStep(m, loop, period_s_, axis_.limits.force_step * axis_.rated_force_N);
      if (!(ErrorOf_m(step) <= ErrorOf_m(v.step_astray))) v.step_astray = step;
    }
  }
  // The torque that the noise of the readings leads to, on the stated axis.
  const auto open = OpenLoop(members_.front().response, response);
  const double encoder_m = kNoiseOfStep * axis_.encoder_step_m;
  const double scale_m = kNoiseOfStep * axis_.scale_step_m.value_or(0.0);
  double power = 0.0, last = 0.0;
  for (std::size_t i = 0; i < open.size(); ++i) {
    const double gain2 =
        (std::norm(response[i][0]) * encoder_m * encoder_m + std::norm(response[i][1]) * scale_m * scale_m) /
        std::norm(1.0 + open[i]);
    power += gain2 * 2.0 * (frequencies_[i] - last);
    last = frequencies_[i];
  }
  v.torque_noise = std::sqrt(power) * unit_N / axis_.rated_force_N;
  v.noise_limit = axis_.limits.torque_noise;
  return v;
}

}  // namespace contour
