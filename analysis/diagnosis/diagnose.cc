#include "analysis/diagnosis/diagnose.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "analysis/diagnosis/adequacy/firm_slides.h"
#include "analysis/diagnosis/adequacy/leftover.h"
#include "analysis/diagnosis/causes/effects.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/parameters.h"
#include "analysis/diagnosis/decision/gate.h"
#include "analysis/diagnosis/decision/residual_trace.h"
#include "analysis/diagnosis/decision/rivals.h"
#include "analysis/diagnosis/decision/verdict.h"
#include "analysis/diagnosis/quantification/detectable.h"
#include "analysis/diagnosis/quantification/widen.h"
#include "analysis/diagnosis/screening/jitter.h"
#include "analysis/diagnosis/screening/score.h"
#include "analysis/diagnosis/tuning/margins.h"
#include "analysis/prediction_error/bootstrap.h"
#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {
namespace {

constexpr double kJitterPenalty = 3.0;
// Most effects show in a few strokes only, whose scatter says the less of an interval: Student's t of six
// over normal.
constexpr double kFewStrokes = 1.25;
// An extension that was found in another log may be off by a hundredth of its amplitude.
constexpr double kOffStated = 1e-4;
// Of the drop in unseen blocks, over the root of its sum of squares: more than one block carries it.
constexpr double kConsistent = 1.2;
// Waves of one kind that are two, by order or Hz.
constexpr double kOrdersApart = 0.9;
// No score of a machine.
constexpr double kFarOut = -1e6;
// Of the drop.
constexpr double kStillThere = 0.6;
// Scores that are alike, of the best. Where friction is of another law, what is wrong with the model takes
// part in the difference, and constant torque and asymmetry differ at reversals only, which do not count.
constexpr double kAlike = 0.03, kAlikeByAnotherLaw = 0.1;
// An element in presliding is a neighbour's name for another law, and leaves more than a right name does.
constexpr double kLeftByAnotherLaw = 0.05;
constexpr double kNoChance = 100.0, kNotOneEvent = 1.5;
constexpr double kNoDoubt = 1000.0;  // of a score

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
    Gate beside;  // what may be left of the accepted
    const double by_extras = std::max(0.0, problem_.ExplainedByExtras(base_.point));
    bool first = true;
    // What could be found was stated for all kinds, with so many causes in the model.
    std::size_t stated_beside = std::numeric_limits<std::size_t>::max();
    std::vector<std::string> tried;  // in this round, and refuted
    int further_orders = 0;
    for (int round = 0;; ++round) {
      if (round >= options_.most_effects) {
        stopped_ = true;
        break;
      }
      Say("candidates", 0.2 + 0.25 * round);
      const std::vector<Scored> scored = Screen(current);
      const Gate gate = GateOf(current, scored, beside, by_extras);
      const Gate sought = options_.evidence ? WithoutMargins(gate) : gate;
      const Jitter jitter = TestJitter(problem_, current);
      if (first) {
        KeepFirst(scored, out);
        out.candidates.push_back(
            {"sample_jitter", jitter.drop - kJitterPenalty, std::numeric_limits<double>::quiet_NaN(), false});
        out.gate = Threshold(problem_, gate);
        first = false;
      }
      const bool jitter_there = !jitter_known && jitter.drop - kJitterPenalty > Threshold(problem_, gate);
      Say("rivals", 0.3 + 0.25 * round);
      std::vector<Rival> rivals = RivalsThatMayHold(current, scored, sought, tried);
      // A cause that is there hides the others; once it is in the model they would be seen by less.
      if (stated_beside != places_.size()) {
        const std::vector<std::string> only = ThoseWithoutDoubt(rivals);
        if (only.empty()) stated_beside = places_.size();
        KeepDetectable(problem_, current, scored, jitter, gate, only, out);
      }
      if (rivals.empty()) {
        if (jitter_there) AcceptJitter(jitter, out);
        break;
      }
      // Noise as the best candidate leaves it.
      problem_.LearnNoise(rivals[0].fit.point);
      Say("rivals under the noise that is left", 0.35 + 0.25 * round);
      FitAgain(problem_, current, rivals);
      if (rivals[0].no_fault && rivals[0].score > Asked(rivals[0], gate)) {
        // No cause of a deviation, but there; unless the model has it, others stand for it.
        current = std::move(rivals[0].fit);
        tried.clear();
        --round;
        continue;
      }
      std::erase_if(rivals, [](const Rival& r) { return r.no_fault; });
      if (rivals.empty() || rivals[0].given_up) {
        if (jitter_there) AcceptJitter(jitter, out);
        break;
      }
      if (options_.evidence) TellEvidence(current, scored, rivals, gate);
      // The best, or the next that holds where the best does not.
      double tested = 0.0;
      bool found = false;
      for (std::size_t i = 0; i < rivals.size() && !found; ++i) {
        if (rivals[i].given_up) continue;
        if (i > 0 && rivals[i].score < 0.3 * rivals[0].score && !InBase(problem_, rivals[i].effect().kind))
          continue;
        const double score = TestedScore(problem_, current, rivals[i]);
        if (i == 0) tested = score;
        rivals[i].refused = !Holds(current, rivals[i], score, gate);
        if (rivals[i].refused) continue;
        found = true;
        tested = score;
        const std::size_t chosen = SurerNumber(current, rivals, i, gate, tested);
        if (chosen == 0) continue;
        std::rotate(rivals.begin(), rivals.begin() + static_cast<std::ptrdiff_t>(chosen),
                    rivals.begin() + static_cast<std::ptrdiff_t>(chosen) + 1);
        rivals[0].fit = FitOn(problem_, std::move(rivals[0].fit), {.most_steps = 4, .most_refreshes = 2});
        rivals[0].score = DropOf(problem_, current, rivals[0].fit) - Penalty(rivals[0].effect());
      }
      const Rival& best = rivals[0];
      if (jitter_there) {
        // A mean effect that the variance was about leaves none behind.
        const Jitter left = TestJitter(problem_, best.fit);
        if (left.drop > 0.6 * jitter.drop && (!found || left.drop > tested)) {
          AcceptJitter(left, out);
          jitter_known = true;
          tried.clear();
          if (!found) break;
          continue;
        }
      }
      if (!found) {
        // What the score test likes best may come to nothing; the others had no turn yet.
        if (!MorePromised(problem_, scored, sought, tried)) break;
        problem_.LearnNoise(current.point);
        Rewhiten(problem_, current);
        --round;
        continue;
      }
      tried.clear();
      // A further order of what is known takes no other cause's place.
      if (Known(best.effect().kind, out) && further_orders++ < options_.most_effects) --round;
      Accept(current, rivals, gate, out);
      explained_ += best.score;
      if (best.effect().kind == "presliding_hysteresis") in_presliding_ = best.score;
      beside.left += UnlikeShare(best.effect().kind) * best.score;
      beside.left_of_kind[best.effect().kind] += LikeShare(best.effect().kind) * best.score;
      current = best.fit;
      if (Outside(best.effect().kind)) break;
    }
    // Beside all that is in the model now, a shape from outside the catalogue among it.
    if (stated_beside != places_.size()) {
      const std::vector<Scored> scored = Screen(current);
      KeepDetectable(problem_, current, scored, TestJitter(problem_, current),
                     GateOf(current, scored, beside, by_extras), {}, out);
    }
    Finish(std::move(current), out);
    return out;
  }

 private:
  static bool Known(const std::string& kind, const Diagnosis& out) {
    return std::any_of(out.causes.begin(), out.causes.end(), [&](const Cause& c) { return c.kind == kind; });
  }

  void Say(std::string_view what, double done) const {
    if (options_.progress) options_.progress(what, done);
  }

  void FitBase() {
    Point start;
    for (const BaseTerm& t : problem_.terms_) start.base.push_back(t.start);
    problem_.LearnOutliers(start);
    problem_.LearnNoise(start);
    const Extent ahead = problem_.excerpt_.empty() ? Extent::kWhole : Extent::kExcerpt;
    base_ = FitPoint(problem_, start,
                     {.most_steps = 4, .most_refreshes = 2, .close_enough = 3.0, .covariance = false}, ahead);
    problem_.LearnNoise(base_.point);
    const FitEffort effort{.most_steps = 12, .most_refreshes = 4, .close_enough = 0.1};
    if (ahead == Extent::kExcerpt) {
      base_ = FitPoint(problem_, FitPoint(problem_, base_.point, kToTheValley, ahead).point, effort);
    } else {
      Rewhiten(problem_, base_);
      base_ = FitOn(problem_, std::move(base_), effort);
    }
    // A resonance may have been taken for another one.
    FitFromStated(problem_, base_, effort);
    problem_.LearnSignals(base_.point);
    catalogue_ = CatalogueEffects(problem_);
  }

  /// `beside`: what may be left of the accepted causes.
  Gate GateOf(const Fit& current, std::span<const Scored> scored, const Gate& beside,
              double by_extras) const {
    Gate gate = SignFlips(scored, options_.false_alarm_rate, options_.seed, kOffStated * by_extras);
    gate.accepted = static_cast<int>(places_.size());
    gate.left = beside.left + (OfAnotherLaw(problem_, current) ? kLeftByAnotherLaw * in_presliding_ : 0.0);
    gate.left_of_kind = beside.left_of_kind;
    return gate;
  }

  /// Where one of them will be in the model next time around: their kinds; what could be found of the others
  /// is not asked before. Else none.
  static std::vector<std::string> ThoseWithoutDoubt(const std::vector<Rival>& rivals) {
    std::vector<std::string> out;
    if (rivals.empty() || rivals[0].no_fault || rivals[0].score < kNoDoubt) return out;
    for (const Rival& r : rivals) out.push_back(r.effect().kind);
    return out;
  }

  std::vector<Scored> Screen(const Fit& fit) const {
    std::vector<SharedEffect> effects = catalogue_;
    for (SharedEffect& e : ScanWaves(problem_, fit)) effects.push_back(std::move(e));
    // Numbers of a law of friction that does not hold are no cause when they are not as stated, and where
    // friction is not what the law says is no matter of time.
    const bool another_law = OfAnotherLaw(problem_, fit);
    std::erase_if(effects, [&](const SharedEffect& e) {
      if (another_law && (e->kind == "stribeck" || e->kind == kFrictionOfTime)) return true;
      return std::any_of(fit.point.effects.begin(), fit.point.effects.end(), [&](const SharedEffect& f) {
        // A wave may have further orders.
        const bool another = e->wave && f->wave && std::fabs(e->order - f->order) > kOrdersApart;
        return f->kind == e->kind && !another;
      });
    });
    std::vector<Scored> scored = ScoreEffects(problem_, fit, std::move(effects));
    std::stable_sort(scored.begin(), scored.end(), [](const Scored& a, const Scored& b) {
      return a.drop - Penalty(*a.effect) > b.drop - Penalty(*b.effect);
    });
    return scored;
  }

  /// Those that are promised most; where all of them come to nothing in the fit, the next ones.
  std::vector<Rival> RivalsThatMayHold(const Fit& current, const std::vector<Scored>& scored,
                                       const Gate& gate, std::vector<std::string>& tried) const {
    for (;;) {
      std::vector<Rival> rivals = FitRivals(problem_, current, scored, gate, tried);
      if (rivals.empty() || MayHold(problem_, rivals, gate)) return rivals;
      if (!MorePromised(problem_, scored, gate, tried)) return {};
    }
  }

  void KeepFirst(const std::vector<Scored>& scored, Diagnosis& out) const {
    for (const Scored& s : scored) {
      const bool known = std::any_of(out.candidates.begin(), out.candidates.end(),
                                     [&](const Candidate& c) { return c.kind == s.effect->kind; });
      if (!known)
        out.candidates.push_back({s.effect->kind, s.score, std::numeric_limits<double>::quiet_NaN(), false});
    }
  }

  void TellEvidence(const Fit& current, const std::vector<Scored>& scored, const std::vector<Rival>& rivals,
                    const Gate& gate) const {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    std::vector<std::string> told;
    for (const Scored& s : scored) {
      const std::string& kind = s.effect->kind;
      if (std::find(told.begin(), told.end(), kind) != told.end()) continue;
      told.push_back(kind);
      Evidence e;
      e.accepted = gate.accepted;
      e.explained = explained_;
      e.in_base = InBase(problem_, kind);
      e.kind = kind;
      e.screened = s.drop;
      e.penalty = Penalty(*s.effect);
      e.excess = s.excess;
      e.refitted = e.tested = e.unseen = kNone;
      e.flips = gate.calibrated;
      e.asked = Threshold(problem_, gate, *s.effect, ShowingOf(problem_, s));
      for (const Rival& r : rivals) {
        if (r.effect().kind != kind || r.score < kFarOut || r.given_up) continue;
        e.penalty = Penalty(r.effect());
        e.refitted = r.score + e.penalty;
        e.asked = Asked(r, gate);
        e.tested = TestedScore(problem_, current, r);
        e.unseen = Consistency(problem_, current, r.fit, true);
      }
      options_.evidence(e);
    }
  }

  double Asked(const Rival& r, const Gate& gate) const {
    // Nothing is left of what nobody has found yet.
    const Showing showing = gate.accepted > 0 ? ShowingOf(problem_, r.fit) : Showing{};
    return Threshold(problem_, gate, r.effect(), showing);
  }

  /// Whether what speaks for an effect goes on doing so when another one is in the model: these two do not
  /// explain the same. Of what a test for small sizes says something about.
  bool StandsBeside(const Fit& other, const Rival& r) const {
    const SharedEffect& effect = r.fit.point.effects.back();
    if (!effect->signals && !InBase(problem_, effect->kind)) return false;
    return ScoreEffects(problem_, other, {effect})[0].drop > kStillThere * (r.score + Penalty(*effect));
  }

  bool Holds(const Fit& current, const Rival& r, double tested, const Gate& gate) const {
    // From outside the catalogue only what is beyond doubt.
    const double least = Asked(r, gate);
    if (tested <= (Outside(r.effect().kind) ? least + 25.0 : least)) return false;
    // What a base parameter does already shows in the priors.
    if (InBase(problem_, r.effect().kind)) return true;
    // A further effect that does harm in the half of the log that it was not fitted on is none.
    Cause cause;
    std::vector<BlockGain> blocks;
    if (gate.accepted > 0) {
      HeldOutGain(problem_, current, r.fit, r.effect().kind == "pitch_error", cause, blocks);
      if (cause.heldout_gain_high < 0.0) return false;
    }
    if (Consistency(problem_, current, r.fit, true) > kConsistent) return true;
    // Left out, the only stroke that shows a base parameter may take it far. Where chance is out of the
    // question, it is enough that the drop does not come from one event.
    return tested > kNoChance && Consistency(problem_, current, r.fit, false) > kNotOneEvent;
  }

  /// The rival itself, or a number of the base behind it that the log says more about, where that is not for
  /// the same reason: a score is worth what its scatter from block to block leaves of it.
  std::size_t SurerNumber(const Fit& current, const std::vector<Rival>& rivals, std::size_t holds,
                          const Gate& gate, double& tested) const {
    std::size_t surest = holds;
    for (std::size_t i = holds + 1; i < rivals.size(); ++i) {
      if (!InBase(problem_, rivals[i].effect().kind)) continue;
      const double score = TestedScore(problem_, current, rivals[i]);
      if (score <= tested || !Holds(current, rivals[i], score, gate) ||
          !StandsBeside(rivals[holds].fit, rivals[i]))
        continue;
      surest = i;
      tested = score;
    }
    return surest;
  }

  void Accept(const Fit& current, const std::vector<Rival>& rivals, const Gate& gate, Diagnosis& out) {
    const Rival& best = rivals[0];
    Cause cause;
    cause.kind = best.effect().kind;
    cause.log_evidence_gain = 0.5 * best.score;
    const double alike = OfAnotherLaw(problem_, current) ? kAlikeByAnotherLaw : kAlike;
    for (const Rival& r : rivals) {
      const std::string& kind = r.effect().kind;
      for (Candidate& c : out.candidates)
        if (c.kind == kind && std::isnan(c.refitted)) {
          c.refitted = r.score;
          c.accepted = &r == &best;
        }
      // What would not have been accepted alone explains too little to be the cause.
      if (&r != &best && !r.refused && !r.given_up && !Outside(kind) && r.score > Asked(r, gate) &&
          r.score > best.score - std::max(12.0, alike * best.score) && !StandsBeside(best.fit, r) &&
          !StandsBeside(r.fit, best))
        cause.indistinguishable_from.push_back(kind);
    }
    const Experiment experiment = DecidingExperiment(problem_, cause.kind, cause.indistinguishable_from);
    cause.deciding_experiment = experiment.text;
    cause.deciding_program = experiment.program;
    scatter_.push_back(ExcessOfLast(problem_, best.fit) * kFewStrokes * kFewStrokes);
    std::vector<BlockGain> blocks;
    HeldOutGain(problem_, current, best.fit, cause.kind == "pitch_error", cause, blocks);
    if (out.causes.empty()) out.blocks = blocks;
    out.causes.push_back(std::move(cause));
    places_.push_back(best.fit.point.effects.size() - 1);
  }

  void AcceptJitter(const Jitter& jitter, Diagnosis& out) const {
    Cause cause;
    cause.kind = "sample_jitter";
    cause.log_evidence_gain = 0.5 * (jitter.drop - kJitterPenalty);
    cause.parameters["rms_us"] = {1e6 * jitter.rms_s,
                                  1e6 * std::max(0.0, jitter.rms_s - 1.96 * jitter.sigma_s),
                                  1e6 * (jitter.rms_s + 1.96 * jitter.sigma_s)};
    WidenIntervals(problem_, base_.point, cause);
    cause.unit = problem_.log_.linear ? "N" : "Nm";
    cause.deciding_experiment = DecidingExperiment(problem_, cause.kind, {}).text;
    for (Candidate& c : out.candidates)
      if (c.kind == cause.kind) c.accepted = true;
    out.causes.push_back(std::move(cause));
  }

  /// Intervals of all that was accepted, from the fit of all of it.
  void Bootstrap(Fit fit, Diagnosis& out) const {
    const Eigen::MatrixXd draws =
        StrokeBootstrap(problem_, fit, options_.bootstrap_runs, options_.seed,
                        [&](double done) { Say("refits with strokes at random", done); });
    const Eigen::MatrixXd about = draws.colwise() - draws.rowwise().mean();
    fit.covariance = about * about.transpose() / static_cast<double>(draws.cols() - 1);
    std::size_t index = 0;
    for (Cause& cause : out.causes) {
      if (cause.kind == "sample_jitter") continue;  // not in the fit
      DescribeEffect(problem_, fit, places_[index++], draws, cause);
      WidenIntervals(problem_, fit.point, cause);
    }
    out.bootstrap_runs = options_.bootstrap_runs;
  }

  /// What was accepted first was fitted before the rest was known, and only well enough to be judged.
  Fit Together(Fit accepted) const {
    const FitEffort effort{.most_steps = 12, .most_refreshes = 4};
    Fit fit = FitOn(problem_, std::move(accepted), effort);
    FitFromStated(problem_, fit, effort);
    return fit;
  }

  /// Sizes of all that was accepted. The residual's own scatter from block to block widens the intervals
  /// where it is more than white noise's.
  void Describe(const Fit& fit, Diagnosis& out) const {
    std::size_t index = 0;
    for (Cause& cause : out.causes) {
      if (cause.kind == "sample_jitter") continue;  // not in the fit
      Fit scattered = fit;
      scattered.covariance *= scatter_[index];
      DescribeEffect(problem_, scattered, places_[index++], cause);
      WidenIntervals(problem_, fit.point, cause);
    }
  }

  void Finish(Fit current, Diagnosis& out) {
    if (!current.point.effects.empty()) {
      current = Together(std::move(current));
      if (options_.bootstrap_runs > 0)
        Bootstrap(current, out);
      else
        Describe(current, out);
    }
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
    const std::vector<Leftover> left = FindLeftovers(problem_, current, options_.false_alarm_rate);
    if (options_.evidence) TellLeftovers(left);
    Conclude(problem_, left, out);
    if (stopped_ && out.verdict == Verdict::kUnexplained)
      out.notes.push_back("No more than " + std::to_string(options_.most_effects) +
                          " causes were looked for: several known ones together may be behind it.");
    Say("done", 1.0);
  }

  /// The best of each margin.
  void TellLeftovers(const std::vector<Leftover>& left) const {
    for (const std::string_view margin : kLeftovers) {
      const auto best =
          std::find_if(left.begin(), left.end(), [&](const Leftover& l) { return l.margin == margin; });
      if (best == left.end()) continue;
      Evidence e;
      e.accepted = static_cast<int>(places_.size());
      e.explained = explained_;
      e.kind = margin;
      e.screened = best->drop;
      e.penalty = best->bins;
      e.refitted = e.tested = best->score;
      e.unseen = std::sqrt(best->score);
      e.flips = -2.0 * std::log(kCalibratedRate);
      e.asked = best->asked;
      options_.evidence(e);
    }
  }

  const DiagnoseOptions& options_;
  Problem problem_;
  Fit base_;
  std::vector<SharedEffect> catalogue_;
  std::vector<std::size_t> places_;  ///< of the accepted causes in the fit, jitter left out
  double explained_ = 0.0;           ///< drop by what is accepted
  bool stopped_ = false;             ///< no further cause was looked for
  double in_presliding_ = 0.0;       ///< by an element in presliding
  std::vector<double> scatter_;      ///< of their residuals from block to block, over white noise's
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
