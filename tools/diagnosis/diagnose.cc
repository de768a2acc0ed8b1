#include "tools/diagnosis/diagnose.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "tools/diagnosis/detectable.h"
#include "tools/diagnosis/effects.h"
#include "tools/diagnosis/experiments.h"
#include "tools/diagnosis/fit.h"
#include "tools/diagnosis/gate.h"
#include "tools/diagnosis/jitter.h"
#include "tools/diagnosis/parameters.h"
#include "tools/diagnosis/residual_trace.h"
#include "tools/diagnosis/score.h"

namespace contour::diagnosis {
namespace {

constexpr double kJitterPenalty = 3.0;
// Of the drop in unseen blocks, over the root of its sum of squares: more than one block carries it.
constexpr double kConsistent = 1.0;

struct Refit {
  Fit fit;
  double score = 0.0;
};

bool Outside(const std::string& kind) { return kind.starts_with(kOutside); }

void CheckInput(const AxisLog& log, const StatedAxis& stated) {
  const std::size_t n = log.size();
  const auto same = [&](const std::vector<double>& v, bool optional) {
    return v.size() == n || (optional && v.empty());
  };
  if (!same(log.position, false) || !same(log.table_position_m, true) || !same(log.temperature_degC, true) ||
      !same(log.axis2_position_m, true) || !same(log.reference_position, true) || log.present.size() != n)
    throw std::invalid_argument(log.source + ": columns of different length");
  if (!(log.period_s > 0.0)) throw std::invalid_argument(log.source + ": period is not positive");
  if (!(stated.motor_inertia > 0.0)) throw std::invalid_argument(stated.source + ": inertia is not positive");
}

class Engine {
 public:
  Engine(const AxisLog& log, const StatedAxis& stated, const DiagnoseOptions& options)
      : options_(options), problem_(log, stated, options.threads) {}

  Diagnosis Run() {
    Diagnosis out;
    out.false_alarm_rate = options_.false_alarm_rate;
    Say("base model", 0.0);
    FitBase();
    Fit current = base_;
    bool jitter_known = false;
    for (int round = 0; round < options_.most_effects; ++round) {
      Say("candidates", 0.2 + 0.25 * round);
      const std::vector<Scored> scored = Screen(current);
      const double gate = SignFlipGate(scored, options_.false_alarm_rate, options_.seed);
      const Jitter jitter = TestJitter(problem_, current);
      if (round == 0) {
        KeepFirst(scored, out);
        out.candidates.push_back(
            {"sample_jitter", jitter.drop - kJitterPenalty, std::numeric_limits<double>::quiet_NaN(), false});
        KeepDetectable(problem_, current, scored, jitter, gate, out);
        out.gate = gate;
      }
      const bool jitter_there = !jitter_known && jitter.drop - kJitterPenalty > gate;
      // Nothing beyond the gate, even if the residual were as white as its spectrum says.
      const bool near = std::any_of(scored.begin(), scored.end(),
                                    [&](const Scored& s) { return s.drop - Penalty(*s.effect) > gate; });
      if (!near) {
        if (jitter_there) AcceptJitter(jitter, out);
        break;
      }
      Say("rivals", 0.3 + 0.25 * round);
      std::vector<Refit> refits = RefitBest(current, scored);
      // Noise as the best candidate leaves it.
      problem_.LearnNoise(refits[0].fit.point);
      Say("rivals under the noise that is left", 0.35 + 0.25 * round);
      Rescore(current, refits);
      // The best, or the next that holds where the best does not.
      double tested = 0.0;
      bool found = false;
      for (std::size_t i = 0; i < refits.size() && !found; ++i) {
        if (i > 0 && refits[i].score < 0.3 * refits[0].score) break;
        const double score = TestedScore(current, refits[i]);
        if (i == 0) tested = score;
        if (!Holds(current, refits[i], score, gate)) continue;
        found = true;
        tested = score;
        if (i == 0) continue;
        std::rotate(refits.begin(), refits.begin() + static_cast<std::ptrdiff_t>(i),
                    refits.begin() + static_cast<std::ptrdiff_t>(i) + 1);
        refits[0].fit = FitPoint(problem_, refits[0].fit.point, {.most_steps = 4, .most_refreshes = 2});
        refits[0].score = current.cost - refits[0].fit.cost - Penalty(*refits[0].fit.point.effects.back());
      }
      const Refit& best = refits[0];
      if (jitter_there) {
        // A mean effect that the variance was about leaves none behind.
        const Jitter left = TestJitter(problem_, best.fit);
        if (left.drop > 0.6 * jitter.drop && (!found || left.drop > tested)) {
          AcceptJitter(left, out);
          jitter_known = true;
          if (!found) break;
          continue;
        }
      }
      if (!found) break;
      Accept(current, refits, out);
      current = best.fit;
      if (Outside(KindOf(best))) break;
    }
    Finish(current, out);
    return out;
  }

 private:
  void Say(std::string_view what, double done) const {
    if (options_.progress) options_.progress(what, done);
  }

  void FitBase() {
    Point start;
    for (const BaseTerm& t : problem_.terms_) start.base.push_back(t.start);
    problem_.LearnOutliers(start);
    problem_.LearnNoise(start);
    base_ = FitPoint(problem_, start,
                     {.most_steps = 4, .most_refreshes = 2, .close_enough = 3.0, .covariance = false});
    problem_.LearnNoise(base_.point);
    base_ = FitPoint(problem_, base_.point, {.most_steps = 8, .most_refreshes = 3});
    problem_.LearnSignals(base_.point);
  }

  std::vector<Scored> Screen(const Fit& fit) const {
    std::vector<SharedEffect> effects = CatalogueEffects(problem_);
    for (SharedEffect& e : ScanWaves(problem_, fit)) effects.push_back(std::move(e));
    std::erase_if(effects, [&](const SharedEffect& e) {
      return std::any_of(fit.point.effects.begin(), fit.point.effects.end(),
                         [&](const SharedEffect& f) { return f->kind == e->kind; });
    });
    std::vector<Scored> scored = ScoreEffects(problem_, fit, std::move(effects));
    std::stable_sort(scored.begin(), scored.end(), [](const Scored& a, const Scored& b) {
      return a.drop - Penalty(*a.effect) > b.drop - Penalty(*b.effect);
    });
    return scored;
  }

  void KeepFirst(const std::vector<Scored>& scored, Diagnosis& out) const {
    for (const Scored& s : scored) {
      const bool known = std::any_of(out.candidates.begin(), out.candidates.end(),
                                     [&](const Candidate& c) { return c.kind == s.effect->kind; });
      if (!known)
        out.candidates.push_back({s.effect->kind, s.score, std::numeric_limits<double>::quiet_NaN(), false});
    }
  }

  /// The best of each kind, jointly with the base and what is accepted already: some of the catalogue, and
  /// the best from outside it.
  std::vector<Refit> RefitBest(const Fit& current, const std::vector<Scored>& scored) const {
    std::vector<Refit> out;
    std::vector<std::string> done;
    double most = 0.0;
    bool outside = false;
    for (const Scored& s : scored)
      if (!Outside(s.effect->kind)) most = std::max(most, s.drop);
    std::vector<const Scored*> far;
    for (const Scored& s : scored) {
      if (Outside(s.effect->kind)) {
        if (!outside && s.drop > most) out.push_back(RefitOne(current, s));
        outside = true;
        continue;
      }
      if (done.size() >= 4 || s.drop < 0.1 * most) continue;
      if (std::find(done.begin(), done.end(), s.effect->kind) != done.end()) continue;
      done.push_back(s.effect->kind);
      if (s.effect->start.empty())
        out.push_back(RefitOne(current, s));
      else
        far.push_back(&s);
    }
    double best = 0.0;
    for (const Refit& r : out) best = std::max(best, r.score);
    for (const Scored* s : far)
      if (std::optional<Refit> r = RefitFar(current, *s, best)) out.push_back(std::move(*r));
    Sort(out);
    return out;
  }

  /// Catalogue first, the best first; what lies outside it comes first only where it explains far more.
  static void Sort(std::vector<Refit>& refits) {
    std::stable_sort(refits.begin(), refits.end(), [](const Refit& a, const Refit& b) {
      const bool x = Outside(KindOf(a)), y = Outside(KindOf(b));
      return x != y ? y : a.score > b.score;
    });
    const auto outside =
        std::find_if(refits.begin(), refits.end(), [](const Refit& r) { return Outside(KindOf(r)); });
    if (outside == refits.end() || outside == refits.begin()) return;
    if (outside->score > 1.3 * std::max(0.0, refits[0].score) + 25.0)
      std::rotate(refits.begin(), outside, outside + 1);
  }
  static const std::string& KindOf(const Refit& r) { return r.fit.point.effects.back()->kind; }

  Refit RefitOne(const Fit& current, const Scored& s) const {
    Point start = current.point;
    start.effects.push_back(s.effect);
    std::vector<double> a(s.effect->steps.size(), 0.0);
    for (std::size_t i = 0; i < s.effect->tested; ++i) a[i] = s.amplitude(static_cast<Eigen::Index>(i));
    const auto clamp = [&](std::vector<double> v) {
      for (std::size_t i = 0; i < v.size() && !s.effect->low.empty(); ++i)
        v[i] = std::clamp(v[i], s.effect->low[i], s.effect->high[i]);
      return v;
    };
    start.amplitudes.push_back(clamp(a));
    if (s.effect->kind == "torque_constant")
      ShiftForces(problem_, std::log1p(start.amplitudes.back()[0]), start);
    Refit best;
    best.fit = FitPoint(
        problem_, start,
        {.most_steps = 3, .most_refreshes = 1, .close_enough = 1.0, .covariance = false, .warm = &current});
    best.score = current.cost - best.fit.cost - Penalty(*s.effect);
    return best;
  }

  /// Far from linear: the kind's whole grid at full size, the base following to first order, shows where to
  /// begin, and whether that is worth while beside what the best of the others explains.
  std::optional<Refit> RefitFar(const Fit& current, const Scored& s, double others) const {
    const Start start = FullStart(current, s.effect->kind);
    if (!start.effect) return std::nullopt;
    Refit best;
    Point point = current.point;
    point.effects.push_back(start.effect);
    point.amplitudes.push_back(start.amplitudes);
    // To first order the base follows too little: half of what is promised may still come.
    if (current.cost - start.cost < 0.2 * others - 0.3 * current.cost) return std::nullopt;
    best.fit = FitPoint(problem_, point,
                        {.most_steps = 8, .most_refreshes = 3, .close_enough = 1.0, .covariance = false});
    best.score = current.cost - best.fit.cost - Penalty(*start.effect);
    return best;
  }

  struct Start {
    SharedEffect effect;
    std::vector<double> amplitudes;
    double cost = 0.0;
  };

  Start FullStart(const Fit& current, const std::string& kind) const {
    std::vector<Start> starts;
    std::vector<Point> points;
    for (const SharedEffect& e : CatalogueEffects(problem_)) {
      if (e->kind != kind) continue;
      for (const double size : {0.15, 0.5, 1.5}) {
        std::vector<double> a = e->start;
        a[0] = std::clamp(size * a[0], e->low[0], e->high[0]);
        Point p = current.point;
        p.effects.push_back(e);
        p.amplitudes.push_back(a);
        points.push_back(std::move(p));
        starts.push_back({e, std::move(a), 0.0});
      }
    }
    Start best;
    best.cost = std::numeric_limits<double>::infinity();
    for (std::size_t first = 0; first < points.size(); first += 8) {
      const std::size_t count = std::min<std::size_t>(8, points.size() - first);
      const auto residuals = problem_.Residuals(std::span(points).subspan(first, count));
      for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Map<const Eigen::VectorXd> r(residuals[i].data(),
                                                  static_cast<Eigen::Index>(residuals[i].size()));
        Eigen::VectorXd gradient = current.jacobian.transpose() * r;
        for (std::size_t t = 0; t < current.point.base.size(); ++t)
          gradient(static_cast<Eigen::Index>(t)) +=
              current.point.base[t] / std::pow(problem_.terms_[t].sigma, 2);
        const double cost = r.squaredNorm() + current.prior - gradient.dot(current.covariance * gradient);
        if (!std::isfinite(cost) || cost >= best.cost) continue;
        best = starts[first + i];
        best.cost = cost;
      }
    }
    return best;
  }

  /// Under new noise: the base, the rivals where they stand, and those that may still win fitted anew.
  void Rescore(Fit& current, std::vector<Refit>& refits) const {
    current = FitPoint(problem_, current.point, {.most_steps = 5, .most_refreshes = 2});
    std::vector<Point> points;
    for (const Refit& r : refits) points.push_back(r.fit.point);
    const auto residuals = problem_.Residuals(points);
    const auto score = [&](Refit& r) {
      r.score = current.cost - r.fit.cost - Penalty(*r.fit.point.effects.back());
    };
    for (std::size_t i = 0; i < refits.size(); ++i) {
      double cost = refits[i].fit.prior;
      for (const double x : residuals[i]) cost += x * x;
      refits[i].fit.cost = cost;
      score(refits[i]);
    }
    Sort(refits);
    const double best = refits[0].score;
    for (std::size_t i = 0; i < refits.size(); ++i) {
      if (i > 0 && refits[i].score < 0.4 * best - 30.0) continue;
      refits[i].fit = FitPoint(problem_, refits[i].fit.point,
                               {.most_steps = 5,
                                .most_refreshes = i == 0 ? 3 : 1,
                                .close_enough = i == 0 ? 0.02 : 0.3,
                                .covariance = i == 0});
      score(refits[i]);
    }
    const std::string first = KindOf(refits[0]);
    Sort(refits);
    if (KindOf(refits[0]) != first)
      refits[0].fit = FitPoint(problem_, refits[0].fit.point, {.most_steps = 3, .most_refreshes = 2});
  }

  bool Holds(const Fit& current, const Refit& r, double tested, double gate) const {
    // From outside the catalogue only what is beyond doubt.
    if (tested <= (Outside(KindOf(r)) ? gate + 25.0 : gate)) return false;
    // What a base parameter does already shows in the priors; it must not do harm elsewhere.
    const double unseen = HeldOutStatistic(problem_, current, r.fit);
    return KindOf(r) == "torque_constant" || unseen > (InBase(problem_, KindOf(r)) ? 0.0 : kConsistent);
  }

  /// Of a rival, what the gate asks about: the drop of the joint fit, but not more than the score test at
  /// its own place promises (a cost that is a little rough has lucky points), over the excess of what is
  /// left.
  double TestedScore(const Fit& current, const Refit& best) const {
    const SharedEffect& effect = best.fit.point.effects.back();
    double drop = best.score + Penalty(*effect);
    if (effect->signals) {
      const std::vector<Scored> again = ScoreEffects(problem_, current, {effect});
      if (again[0].drop < 60.0) drop = std::min(drop, again[0].drop);
    }
    return drop / ExcessOfLast(problem_, best.fit) - Penalty(*effect);
  }

  void Accept(const Fit& current, const std::vector<Refit>& refits, Diagnosis& out) const {
    const Refit& best = refits[0];
    Cause cause;
    cause.kind = best.fit.point.effects.back()->kind;
    cause.log_evidence_gain = 0.5 * best.score;
    for (const Refit& r : refits) {
      const std::string& kind = r.fit.point.effects.back()->kind;
      for (Candidate& c : out.candidates)
        if (c.kind == kind && std::isnan(c.refitted)) {
          c.refitted = r.score;
          c.accepted = &r == &best;
        }
      if (&r != &best && !Outside(kind) && r.score > best.score - std::max(12.0, 0.03 * best.score))
        cause.indistinguishable_from.push_back(kind);
    }
    const Experiment experiment = DecidingExperiment(problem_, cause.kind, cause.indistinguishable_from);
    cause.deciding_experiment = experiment.text;
    cause.deciding_program = experiment.program;
    // The residual's own scatter from block to block widens the intervals where it is more than white
    // noise's.
    Fit scattered = best.fit;
    scattered.covariance *= ExcessOfLast(problem_, best.fit);
    DescribeEffect(problem_, scattered, best.fit.point.effects.size() - 1, cause);
    std::vector<BlockGain> blocks;
    HeldOutGain(problem_, current, best.fit, cause.kind == "pitch_error", cause, blocks);
    if (out.causes.empty()) out.blocks = blocks;
    out.causes.push_back(std::move(cause));
  }

  void AcceptJitter(const Jitter& jitter, Diagnosis& out) const {
    Cause cause;
    cause.kind = "sample_jitter";
    cause.log_evidence_gain = 0.5 * (jitter.drop - kJitterPenalty);
    cause.parameters["rms_us"] = {1e6 * jitter.rms_s,
                                  1e6 * std::max(0.0, jitter.rms_s - 1.96 * jitter.sigma_s),
                                  1e6 * (jitter.rms_s + 1.96 * jitter.sigma_s)};
    cause.unit = problem_.log_.linear ? "N" : "Nm";
    cause.deciding_experiment = DecidingExperiment(problem_, cause.kind, {}).text;
    for (Candidate& c : out.candidates)
      if (c.kind == cause.kind) c.accepted = true;
    out.causes.push_back(std::move(cause));
  }

  void Finish(const Fit& current, Diagnosis& out) {
    out.data_quality = problem_.quality_;
    for (std::size_t i = 0; i < problem_.terms_.size(); ++i) {
      const BaseTerm& t = problem_.terms_[i];
      if (t.nuisance) continue;
      const double x = current.point.base[i];
      const double sd = std::sqrt(
          std::max(0.0, current.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i))));
      const double fitted = t.additive ? t.stated + x : t.stated * std::exp(x);
      out.base.push_back({t.name, t.stated, fitted, t.additive ? sd : fitted * sd});
    }
    out.traces = MakeTraces(problem_, base_.point, current.point);
    std::erase_if(out.candidates, [](const Candidate& c) { return Outside(c.kind); });
    if (out.causes.empty())
      out.verdict = Verdict::kNothingFound;
    else if (Outside(out.causes[0].kind) ||
             (Outside(out.causes.back().kind) &&
              out.causes.back().log_evidence_gain > 0.4 * out.causes[0].log_evidence_gain))
      out.verdict = Verdict::kUnexplained;
    else
      out.verdict = out.causes[0].indistinguishable_from.empty() ? Verdict::kCauseFound : Verdict::kAmbiguous;
    for (const Cause& c : out.causes)
      if (Outside(c.kind))
        out.notes.push_back("Something is missing that none of the known causes fits; nearest: " +
                            c.kind.substr(std::string_view(kOutside).size()));
    std::erase_if(out.causes, [](const Cause& c) { return Outside(c.kind); });
    Say("done", 1.0);
  }

  const DiagnoseOptions& options_;
  Problem problem_;
  Fit base_;
};

}  // namespace

Diagnosis Diagnose(const AxisLog& log, const StatedAxis& stated, const DiagnoseOptions& options) {
  CheckInput(log, stated);
  if (log.size() < 3000) {
    Diagnosis out;
    out.false_alarm_rate = options.false_alarm_rate;
    out.data_quality.rows = log.rows;
    out.data_quality.missing = log.missing;
    out.notes.push_back("The log is shorter than 3000 rows.");
    return out;
  }
  return Engine(log, stated, options).Run();
}

}  // namespace contour::diagnosis
