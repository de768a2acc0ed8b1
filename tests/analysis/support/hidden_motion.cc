#include "tests/analysis/support/hidden_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace contour::diagnosis::test {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

struct Writer {
  Motion& m;
  std::size_t rows;
  double T;
  double x = 0.0;

  bool full() const { return m.table_m.size() >= rows; }
  void Put(double position, double velocity, double acceleration, double dither = 0.0) {
    if (full()) return;
    m.table_m.push_back(position);
    m.velocity_m_s.push_back(velocity);
    m.acceleration_m_s2.push_back(acceleration);
    m.dither_rel.push_back(dither);
  }
  void Rest(double s) {
    for (double t = 0.0; t < s; t += T) Put(x, 0.0, 0.0);
  }
  // Trapezoid of speed.
  void MoveTo(double to, double v, double a) {
    const double d = std::fabs(to - x), sign = to < x ? -1.0 : 1.0;
    v = std::min(v, std::sqrt(d * a));
    if (d <= 0.0 || v <= 0.0) return;
    const double ramp = v / a, cruise = d / v - ramp, from = x;
    for (double t = T; t < 2.0 * ramp + cruise; t += T) {
      double s = 0.0, speed = v, acc = 0.0;
      if (t < ramp) {
        s = 0.5 * a * t * t;
        speed = a * t;
        acc = a;
      } else if (t < ramp + cruise) {
        s = v * (t - 0.5 * ramp);
      } else {
        const double left = 2.0 * ramp + cruise - t;
        s = d - 0.5 * a * left * left;
        speed = a * left;
        acc = -a;
      }
      Put(from + sign * s, sign * speed, sign * acc);
    }
    x = to;
    Put(x, 0.0, 0.0);
  }
  void Sine(double amplitude, double f, double cycles) {
    const double w = kTwoPi * f, from = x;
    for (double t = 0.0; t < cycles / f; t += T) {
      const double fade = std::min(1.0, t * f);  // grows over the first cycle
      Put(from + amplitude * fade * std::sin(w * t), amplitude * fade * w * std::cos(w * t),
          -amplitude * fade * w * w * std::sin(w * t));
    }
    x = from;
  }
  template <class Random>
  void Multisine(double seconds, double v, double size, Random& random) {
    std::uniform_real_distribution<double> uniform(0.0, kTwoPi);
    std::vector<double> f, phase;
    for (double g = 2.0; g < 320.0; g *= 1.13) {
      f.push_back(g);
      phase.push_back(uniform(random));
    }
    const double a = size / std::sqrt(0.5 * static_cast<double>(f.size()));
    const double from = x, ramp = 0.2;
    for (double t = 0.0; t < seconds; t += T) {
      double d = 0.0;
      for (std::size_t i = 0; i < f.size(); ++i) d += a * std::sin(kTwoPi * f[i] * t + phase[i]);
      const double fade = std::clamp(std::min(t, seconds - t) / ramp, 0.0, 1.0);
      Put(from + v * t, v, 0.0, d * fade);
      x = from + v * t;
    }
  }
};

}  // namespace

Motion MakeMotion(std::size_t rows, double period_s, double half_stroke_m, std::uint64_t seed) {
  std::mt19937_64 random(seed * 31 + 5);
  std::uniform_real_distribution<double> uniform;
  Motion m;
  Writer w{m, rows, period_s};
  const double end = 0.97 * half_stroke_m;
  w.x = (uniform(random) - 0.5) * half_stroke_m;
  w.Rest(0.5);
  const double speeds[] = {0.06, 0.2, 0.11, 0.24, 0.08};
  int pass = 0;
  while (!w.full()) {
    for (const double v : {0.0003, 0.0012, 0.005}) {
      w.MoveTo(w.x + v * 0.8, v, 1.0);
      w.Rest(0.1);
      w.MoveTo(w.x - v * 0.8, v, 1.0);
    }
    for (int i = 0; i < 3; ++i) {
      const double v = speeds[(pass * 3 + i) % 5] * (0.9 + 0.2 * uniform(random));
      w.MoveTo(end, v, 2.5);
      w.Rest(0.05);
      w.MoveTo(-end, v, 2.5);
      w.Rest(0.05);
    }
    w.MoveTo((uniform(random) - 0.5) * half_stroke_m, 0.1, 3.0);
    for (const double a : {4e-6, 15e-6, 60e-6, 250e-6, 1e-3}) w.Sine(a, 2.0 + uniform(random), 3.0);
    w.Multisine(2.5, 0.008, 0.45, random);
    w.Multisine(1.5, -0.02, 0.45, random);
    for (int i = 0; i < 6; ++i)
      w.MoveTo(w.x + (i % 2 == 0 ? 0.012 : -0.012), 0.22, 4.0 + 3.0 * uniform(random));
    w.Rest(0.2);
    ++pass;
  }
  // The other axis moves when it likes, at frequencies that wander.
  m.axis2_m.resize(rows);
  m.axis2_m_s2.resize(rows);
  const double f2 = 1.1 + uniform(random), f3 = 2.7 + uniform(random);
  const auto other = [&](double t) {
    return 0.03 * std::sin(kTwoPi * f2 * t + 6.0 * std::sin(0.31 * t)) +
           0.006 * std::sin(kTwoPi * f3 * t + 9.0 * std::sin(0.23 * t + 1.0));
  };
  for (std::size_t k = 0; k < rows; ++k) {
    const double t = static_cast<double>(k) * period_s, d = 1e-3;
    m.axis2_m[k] = other(t);
    m.axis2_m_s2[k] = (other(t + d) - 2.0 * other(t) + other(t - d)) / (d * d);
  }
  return m;
}

}  // namespace contour::diagnosis::test
