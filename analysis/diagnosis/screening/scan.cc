#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>

#include "analysis/diagnosis/causes/waves.h"
#include "analysis/diagnosis/screening/octave_noise.h"
#include "analysis/diagnosis/screening/score.h"
#include "analysis/prediction_error/fourier_transform.h"

// Waves of the motor's angle and of time by matched filters: the response of the white innovation to a pulse
// of torque (or of the reading) is that of the linear observer, friction left out; one transform gives all
// orders.
namespace contour::diagnosis {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr std::size_t kResponse = kScan.response_rows;
// The response fills half of its transform: as fine as there is anything to see.
constexpr std::size_t kTransfer = 2 * kResponse;

struct Matched {
  std::vector<double> lambda;    // gradient of |r|^2 / 2 by a pulse at each row
  std::vector<double> transfer;  // |response|^2 by frequency, kTransfer / 2 bins up to half the rate
  /// Beyond half the rate, of the slower wave that it looks like from row to row.
  double At(double cycles_per_row) const {
    const double f = std::fabs(cycles_per_row - std::round(cycles_per_row)) * kTransfer;
    const auto i = static_cast<std::size_t>(f);
    const double part = f - static_cast<double>(i);
    return i + 1 < transfer.size() ? (1.0 - part) * transfer[i] + part * transfer[i + 1] : transfer.back();
  }
};

Matched Match(const Problem& problem, bool reading, Signal gradient) {
  const std::vector<double> h = PulseResponse(problem, reading);
  Matched m;
  m.lambda = std::move(gradient);
  std::vector<double> padded(kTransfer, 0.0);
  std::copy(h.begin(), h.end(), padded.begin());
  for (const std::complex<double>& x : FourierTransform(padded)) m.transfer.push_back(std::norm(x));
  return m;
}

struct Peak {
  double order = 0.0, score = -1.0;
};

// Best `count` orders, apart by more than `apart`.
std::vector<double> Best(std::vector<Peak> peaks, std::size_t count, double apart) {
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const Peak& a, const Peak& b) { return a.score > b.score; });
  std::vector<double> out;
  for (const Peak& p : peaks) {
    if (out.size() == count || p.score <= 0.0) break;
    if (std::all_of(out.begin(), out.end(), [&](double o) { return std::fabs(o - p.order) > apart; }))
      out.push_back(p.order);
  }
  return out;
}

struct Histogram {
  std::vector<double> weight, speed;  // speed in rad of motor angle per row
  double InformationAt(const Matched& m, double order) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < weight.size(); ++i) sum += weight[i] * m.At(order * speed[i] / kTwoPi);
    return 0.5 * sum;
  }
};

// Spectrum over the angle of the weighted gradient: score of every order up to `highest`. Folded onto one
// turn, it has the integer orders and no others.
std::vector<Peak> AngleScores(const Problem& problem, const Matched& matched,
                              const std::vector<double>& weight, double highest, bool folded) {
  const Signals& s = *problem.signals;
  const auto [low, high] = std::minmax_element(s.angle_rad.begin(), s.angle_rad.end());
  const double revs = std::max(1.0, (*high - *low) / kTwoPi);
  const double per_rev = 2.0 * std::exp2(std::ceil(std::log2(2.0 * highest)));
  const auto length = folded ? static_cast<std::size_t>(per_rev)
                             : std::bit_ceil(static_cast<std::size_t>(per_rev * revs * 2.0) + 2);
  std::vector<double> gradient(length, 0.0);
  Histogram histogram;
  constexpr std::size_t kBins = kScreening.bins;
  histogram.weight.assign(kBins, 0.0);
  histogram.speed.assign(kBins, 0.0);
  double fastest = 1e-12;
  const std::size_t n = problem.rows();
  std::vector<double> speed(n);
  for (std::size_t k = 1; k < n; ++k) {
    speed[k] = std::fabs(s.velocity[k]) * problem.log.period_s * s.angle_per_q;
    fastest = std::max(fastest, speed[k]);
  }
  for (std::size_t i = 0; i < kBins; ++i)
    histogram.speed[i] = fastest * std::pow((static_cast<double>(i) + 0.5) / kBins, 2);
  for (std::size_t k = 0; k < n; ++k) {
    if (problem.counted[k] == 0 || weight[k] == 0.0) continue;
    const auto bin = static_cast<std::size_t>((s.angle_rad[k] - *low) / kTwoPi * per_rev + 0.5);
    gradient[bin & (length - 1)] += weight[k] * matched.lambda[k];
    const auto b = std::min(kBins - 1, static_cast<std::size_t>(std::sqrt(speed[k] / fastest) * kBins));
    histogram.weight[b] += weight[k] * weight[k] * problem.root_weight[k] * problem.root_weight[k];
  }
  const HalfSpectrum spectrum = FourierTransform(gradient);
  std::vector<double> orders, scores;
  const double step = per_rev / static_cast<double>(length);
  double info = 0.0, info_at = -1.0;
  for (std::size_t i = 1; i < length / 2; ++i) {
    const double order = step * static_cast<double>(i);
    if (order > highest) break;
    if (order > info_at + (1.0 + info_at) / kScreening.bins || info_at < 0.0) {
      info = histogram.InformationAt(matched, order);
      info_at = order;
    }
    if (!(info > 0.0)) continue;
    orders.push_back(order);
    scores.push_back(std::norm(spectrum[i]) / info);
  }
  OverTheOctave(scores);
  std::vector<Peak> out;
  for (std::size_t i = 0; i < orders.size(); ++i) out.push_back({orders[i], scores[i]});
  return out;
}

// Of forces of time, by one transform of the gradient.
std::vector<double> Frequencies(const Problem& problem, const Matched& torque,
                                const std::vector<double>& sliding) {
  const std::size_t n = problem.rows();
  const std::size_t length = std::bit_ceil(2 * n);
  std::vector<double> gradient(length, 0.0);
  double moving = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    gradient[k] = sliding[k] * torque.lambda[k];
    moving += sliding[k] * problem.root_weight[k] * problem.root_weight[k];
  }
  const HalfSpectrum spectrum = FourierTransform(gradient);
  std::vector<Peak> time;
  for (std::size_t i = 1; i < length / 2; ++i) {
    const double f = static_cast<double>(i) / static_cast<double>(length);
    if (f * static_cast<double>(n) < kScan.fewest_periods || f > kScan.highest_per_row) continue;
    time.push_back(
        {f / problem.log.period_s, 2.0 * std::norm(spectrum[i]) / (moving * torque.At(f) + 1e-300)});
  }
  return Best(time, kScan.proposed, 2.0 / (static_cast<double>(n) * problem.log.period_s));
}

}  // namespace

std::vector<double> PulseResponse(const Problem& problem, bool reading) {
  // In the middle of the longest slide.
  const Signals& s = *problem.signals;
  const std::size_t n = problem.rows();
  std::size_t row = n / 2, longest = 0, since = 0;
  for (std::size_t k = 1; k <= n; ++k) {
    const bool slides = k < n && problem.counted[k] != 0 && std::fabs(s.sign[k]) > kFollowsMotion &&
                        (s.velocity[k] > 0.0) == (s.velocity[k - 1] > 0.0);
    if (slides) continue;
    if (k - since > longest) {
      longest = k - since;
      row = (since + k) / 2;
    }
    since = k;
  }
  return problem.noise.Pulse(std::min(row, n > kResponse + 2 ? n - kResponse - 2 : 0), reading, kResponse,
                             problem.counted);
}

std::vector<SharedEffect> ScanWaves(const Problem& problem, const Fit& fit) {
  const Signals& s = *problem.signals;
  const std::size_t n = problem.rows();
  std::vector<SharedEffect> out;
  // The grid is what was looked at: every order up to the highest, every frequency that the log resolves.
  const auto add = [&](Wave wave, const std::vector<double>& orders, double grid) {
    for (const double o : orders) out.push_back(WaveEffect(problem, wave, o, grid));
  };
  const auto whole_orders = [&](Wave wave, const Matched& matched, const std::vector<double>& weight,
                                double highest, std::size_t count) {
    add(wave, Best(AngleScores(problem, matched, weight, highest, true), count, kScan.waves_apart), highest);
  };
  std::vector<double> innovation(fit.residual.begin(), fit.residual.begin() + static_cast<std::ptrdiff_t>(n));
  NoiseFilter::Gradient back = problem.noise.Back(innovation, problem.counted, problem.root_weight.data());
  for (double& x : back.level) x /= s.coulomb;
  const Matched torque = Match(problem, false, std::move(back.motor));
  const Matched level{std::move(back.level), torque.transfer};
  // Stuck, the axis hardly answers to a torque: the information is in the slides.
  std::vector<double> sliding(n), loaded(n);
  double torque_scale = 1e-300;
  for (std::size_t k = 0; k < n; ++k) torque_scale = std::max(torque_scale, std::fabs(s.model_torque[k]));
  for (std::size_t k = 0; k < n; ++k) {
    sliding[k] = std::fabs(s.sign[k]) > kFollowsMotion ? 1.0 : 0.0;
    loaded[k] = sliding[k] * s.model_torque[k] / torque_scale;
  }
  const auto [low, high] = std::minmax_element(s.angle_rad.begin(), s.angle_rad.end());
  const double revs = (*high - *low) / kTwoPi;
  if (revs > 2.0) {
    whole_orders(Wave::kFrictionOfAngle, level, sliding, kScan.highest_friction_order, kScan.proposed);
    std::vector<Peak> between;
    if (revs > kScan.fewest_periods)
      for (const Peak& p : AngleScores(problem, level, sliding, kScan.highest_friction_order, false))
        if (std::fabs(p.order - std::round(p.order)) > 1.0 / revs && p.order > kScan.fewest_periods / revs)
          between.push_back(p);
    add(Wave::kFrictionOfAngle, Best(std::move(between), kScan.proposed, 1.0 / revs),
        kScan.highest_friction_order * revs);
    whole_orders(Wave::kTorqueOfAngle, torque, sliding, kScan.highest_torque_order, kScan.proposed);
    whole_orders(Wave::kGainOfAngle, torque, loaded, kScan.highest_torque_order, 1);
  }
  if (revs > 1.0) {
    const Matched reading = Match(problem, true, std::move(back.reading));
    std::vector<Peak> lines =
        AngleScores(problem, reading, std::vector<double>(n, 1.0), kScan.highest_line_order, true);
    std::erase_if(lines, [](const Peak& peak) { return peak.order < kScan.lowest_line_order; });
    add(Wave::kReadingOfAngle, Best(std::move(lines), kScan.proposed, kScan.waves_apart),
        kScan.highest_line_order);
  }
  add(Wave::kForceOfTime, Frequencies(problem, torque, sliding), 0.5 * static_cast<double>(n));
  return out;
}

}  // namespace contour::diagnosis
