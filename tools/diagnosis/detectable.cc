#include "tools/diagnosis/detectable.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/diagnosis/effects.h"
#include "tools/diagnosis/parameters.h"

namespace contour::diagnosis {
namespace {

// Beyond this, the first amplitude of a kind is no small flaw any more but another machine.
double Largest(const Problem& p, const std::string& kind) {
  const Signals& s = *p.signals_;
  const double Fc = s.coulomb;
  if (kind == "constant_torque" || kind == "cogging" || kind == "periodic_force") return 0.7 * Fc;
  if (kind == "cable_spring" || kind == "viscous_nonlinear") return 1.5 * Fc;
  if (kind == "temperature_viscosity") return 0.15;
  if (kind == "torque_saturation") return 0.3;
  if (kind == "torque_constant") return 0.35;
  if (kind == "payload_step") return 1.0;
  if (kind == "input_delay" || kind == "current_lag") return 3.0 * p.log_.period_s;
  if (kind == "backlash") return 200e-6 / p.stated_.table_per_q;
  if (kind == "encoder_eccentricity" || kind == "encoder_subdivision") return 0.02 / s.angle_per_q;
  if (kind == "pitch_error") return 1e-3;
  if (kind == "cross_coupling") {
    double top = 0.0;
    for (const double a : s.axis2_m_s2) top = std::max(top, std::fabs(a));
    return top > 0.01 ? Fc / top : 0.0;
  }
  if (kind == "stribeck" || kind == "compliance") return 1.5;
  return 0.7;
}

// A cause must also hold in several blocks, in unseen halves and against its rivals, and the rest of the fit
// takes a part of it over: by recorded machines (docs/diagnosis_results.md).
constexpr double kBeyondTheGate = 2.5;

// A log is good for a kind while such a flaw would show by this much less.
constexpr double kHopeless = 1.5;

/// Standard errors that exceed a threshold of the squared score in 90 % of cases.
double Needed(double threshold) { return std::sqrt(std::max(threshold, 1.0)) + 1.2816; }

}  // namespace

void KeepDetectable(const Problem& problem, const Fit& base, std::span<const Scored> scored,
                    const Jitter& jitter, const Gate& gate, Diagnosis& out) {
  std::map<std::string, double> smallest;
  for (const Scored& s : scored) {
    const std::string& kind = s.effect->kind;
    if (kind.starts_with(kOutside)) continue;
    // The mean standard error over the amplitudes; a shape may lie along any of them.
    const double n = static_cast<double>(s.covariance.rows());
    const double sd = std::sqrt(std::max(0.0, s.covariance.trace() / n) * s.excess);
    const double needed = Needed(Threshold(problem, gate, *s.effect) + Penalty(*s.effect)) * sd;
    if (!std::isfinite(needed) || needed > kHopeless * Largest(problem, kind)) continue;
    Fit at;
    at.point = base.point;
    at.point.effects = {s.effect};
    at.point.amplitudes = {s.effect->start.empty() ? std::vector<double>(s.effect->steps.size(), 0.0)
                                                   : s.effect->start};
    at.point.amplitudes[0][0] = kBeyondTheGate * needed;
    const auto count = static_cast<Eigen::Index>(ParameterCount(at.point));
    at.covariance = Eigen::MatrixXd::Zero(count, count);
    Cause described;
    described.kind = kind;
    DescribeEffect(problem, at, 0, described);
    const std::string name = MainParameter(kind);
    const double size = std::fabs(described.parameters[name].value);
    const bool smaller = !smallest.contains(kind) || needed < smallest[kind];
    if (!smaller) continue;
    smallest[kind] = needed;
    out.smallest_detectable[kind][name] = size;
  }
  if (jitter.tested) {
    smallest["sample_jitter"] = 1.0;
    out.smallest_detectable["sample_jitter"]["rms_us"] =
        1e6 * std::sqrt(kBeyondTheGate * Needed(Threshold(problem, gate) + 3.0) * jitter.sigma_s2);
  }
  for (const std::string_view kind : kKinds)
    if (!smallest.contains(std::string(kind))) out.not_excited.emplace_back(kind);
}

}  // namespace contour::diagnosis
