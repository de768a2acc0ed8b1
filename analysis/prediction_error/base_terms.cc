#include "analysis/prediction_error/base_terms.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/diagnosis/tuning/prediction_tuning.h"

namespace contour::diagnosis {
namespace {

// Without a statement of the model file.
const std::map<std::string, double> kDefaultSigma = {{"inertia", kPriors.inertia_rel},
                                                     {"load_inertia", kPriors.load_inertia_rel},
                                                     {"stiffness", kPriors.stiffness_rel},
                                                     {"damping", kPriors.damping_rel},
                                                     {"Fc", kPriors.Fc_rel},
                                                     {"Fs", kPriors.Fs_rel},
                                                     {"vs", kPriors.vs_rel},
                                                     {"s0", kPriors.s0_rel},
                                                     {"s1", kPriors.s1_rel},
                                                     {"s2", kPriors.s2_rel},
                                                     {"delay", kPriors.delay_rel},
                                                     {"lag", kPriors.lag_rel},
                                                     {"torque_constant", kPriors.torque_constant_rel}};

void AddNumbers(const StatedAxis& stated, AxisModel& nominal, std::vector<BaseTerm>& terms) {
  const auto sigma_of = [&](const char* name) { return StatedSigma(stated, name); };
  const auto add = [&](const char* name, double sigma, double step, double* (*field)(AxisModel&)) {
    BaseTerm t;
    t.name = name;
    t.stated = *field(nominal);
    t.sigma = sigma;
    t.step = step;
    t.field = field;
    if (t.stated > 0.0 && sigma > 0.0) terms.push_back(t);
  };
  add("inertia", sigma_of("inertia"), 5e-4, [](AxisModel& m) { return &m.motor_inertia; });
  if (nominal.two_inertia) {
    add("load_inertia", sigma_of("load_inertia"), 5e-4, [](AxisModel& m) { return &m.load_inertia; });
    add("stiffness", sigma_of("stiffness"), 5e-4, [](AxisModel& m) { return &m.stiffness; });
    add("damping", sigma_of("damping"), 5e-3, [](AxisModel& m) { return &m.damping; });
  }
  const StatedFriction& f = nominal.friction;
  add("Fc", sigma_of("Fc"), 1e-3, [](AxisModel& m) { return &m.friction.Fc_plus; });
  if (f.BreaksAwayHigher()) {
    add("Fs", sigma_of("Fs"), 2e-3, [](AxisModel& m) { return &m.friction.Fs_plus; });
    add("vs", sigma_of("vs"), 5e-3, [](AxisModel& m) { return &m.friction.vs; });
  }
  add("s0", sigma_of("s0"), 3e-3, [](AxisModel& m) { return &m.friction.s0; });
  add("s1", sigma_of("s1"), 1e-2, [](AxisModel& m) { return &m.friction.s1; });
  add("s2", sigma_of("s2"), 2e-3, [](AxisModel& m) { return &m.friction.s2; });
  add("torque_constant", sigma_of("torque_constant"), 5e-4, [](AxisModel& m) { return &m.torque_gain; });
}

/// A constant force that is stated is a number like the others, and as doubtful as friction: an axis whose
/// directions differ looks much like one that something pulls. One that is not stated is a cause.
void AddOffset(const StatedAxis& stated, const AxisModel& nominal, std::vector<BaseTerm>& terms) {
  if (stated.offset == 0.0) return;
  const double level = 0.5 * (nominal.friction.Fc_plus + nominal.friction.Fc_minus);
  const auto known = stated.sigma.find("offset");
  BaseTerm t;
  t.name = "offset";
  t.stated = stated.offset;
  t.sigma = known != stated.sigma.end() ? known->second * std::fabs(stated.offset)
                                        : kPriors.Fc_rel * std::max(level, std::fabs(stated.offset));
  t.step = 1e-2 * std::max(level, std::fabs(stated.offset));
  t.additive = true;
  t.field = [](AxisModel& m) { return &m.offset; };
  if (t.sigma > 0.0) terms.push_back(t);
}

void AddTimes(const StatedAxis& stated, AxisModel& nominal, std::vector<BaseTerm>& terms) {
  const auto timed = [&](const char* name, double* (*field)(AxisModel&)) {
    BaseTerm t;
    t.name = name;
    t.stated = *field(nominal);
    t.sigma = StatedSigma(stated, name) * t.stated;
    t.step = 2e-6;
    t.additive = true;
    t.field = field;
    if (t.sigma > 0.0) terms.push_back(t);
  };
  timed("delay", [](AxisModel& m) { return &m.delay_s; });
  timed("lag", [](AxisModel& m) { return &m.lag_s; });
  // No axis is quite rigid: below its antiresonance a coupling acts as a lag does that came with less delay
  // (both leave the sum alone; 1 + s^2 / w_ar^2 ... against s^2 lag^2 / 2).
  if (!nominal.two_inertia && nominal.delay_s > 2.0 * kPriors.lag_for_delay_s) {
    BaseTerm exchange;
    exchange.name = "lag_for_delay";
    exchange.sigma = kPriors.lag_for_delay_s;
    exchange.step = 2e-6;
    exchange.additive = exchange.nuisance = true;
    exchange.field = [](AxisModel& m) { return &m.lag_for_delay_s; };
    terms.push_back(exchange);
  }
}

void AddNuisances(const StatedFriction& f, std::vector<BaseTerm>& terms) {
  BaseTerm rough;
  rough.name = "rough";
  rough.sigma = std::pow(kPriors.rough_speed_share * f.vs, 2);
  rough.start = kPriors.rough_start_deviations * rough.sigma;
  rough.step = 0.002 * rough.sigma;
  rough.additive = rough.nuisance = true;
  rough.field = [](AxisModel& m) { return &m.rough; };
  terms.push_back(rough);
  BaseTerm z;
  z.name = "start_bristle";
  z.sigma = kPriors.start_bristle_lengths * f.Fc_plus / f.s0;
  z.step = 0.01 * f.Fc_plus / f.s0;
  z.additive = z.nuisance = true;
  z.field = [](AxisModel& m) { return &m.start_bristle; };
  terms.push_back(z);
}

}  // namespace

double StatedSigma(const StatedAxis& stated, const std::string& name) {
  const auto it = stated.sigma.find(name);
  if (it != stated.sigma.end()) return it->second;
  if (name == "inertia" && stated.sigma.contains("motor_inertia")) return stated.sigma.at("motor_inertia");
  return kDefaultSigma.at(name);
}

std::vector<BaseTerm> MakeBaseTerms(const StatedAxis& stated, AxisModel nominal) {
  std::vector<BaseTerm> terms;
  AddNumbers(stated, nominal, terms);
  AddOffset(stated, nominal, terms);
  AddTimes(stated, nominal, terms);
  AddNuisances(nominal.friction, terms);
  return terms;
}

}  // namespace contour::diagnosis
