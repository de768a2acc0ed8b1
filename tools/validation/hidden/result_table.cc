#include "tools/validation/hidden/result_table.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "analysis/text/format_text.h"
#include "tools/validation/hidden/specimens.h"

namespace contour::hidden {
namespace {

struct Count {
  int right = 0, all = 0;
  void Take(bool good) {
    right += good;
    ++all;
  }
};

std::string Text(const Count& c) {
  return c.all == 0 ? "-" : std::to_string(c.right) + " / " + std::to_string(c.all);
}

double Percent(const Count& c) { return c.all == 0 ? 0.0 : 100.0 * c.right / c.all; }

bool IsOutside(const Outcome& o) {
  return !o.known.question.kinds.empty() && OutsideCatalogue(o.known.question.kinds.front());
}

/// Right answers of one type of question by kind and strength.
void AddKinds(std::string& text, const std::vector<Outcome>& outcomes, Misfit misfit) {
  std::map<std::string, std::map<Strength, Count>> counts;
  std::map<Strength, Count> sums;
  Count inside, gained, alone;
  for (const Outcome& o : outcomes) {
    if (o.known.question.type != Question::Type::kEffect || !o.known.usable ||
        o.known.question.misfit != misfit || IsOutside(o))
      continue;
    counts[KindsText(o.known.question)][o.known.question.strength].Take(o.judged.right);
    if (Undecidable(o)) continue;
    sums[o.known.question.strength].Take(o.judged.right);
    alone.Take(o.judged.extra == 0);
    if (!o.judged.right || !o.judged.itself) continue;
    inside.Take(o.judged.inside);
    gained.Take(o.judged.gain > 0.0);
  }
  if (counts.empty()) return;
  text += FormatText(
      "\n### Right cause first, or in a set of two that is%s%s\n\n| effect | clear | moderate | barely |\n",
      misfit == Misfit::kNone ? "" : "; plant: ", misfit == Misfit::kNone ? "" : Name(misfit));
  text += "|---|---|---|---|\n";
  for (auto& [kind, by] : counts)
    text += FormatText("| %s | %s | %s | %s |\n", kind.c_str(), Text(by[Strength::kClear]).c_str(),
                       Text(by[Strength::kModerate]).c_str(), Text(by[Strength::kBarely]).c_str());
  text += "| **all, without the undecidable** |";
  for (const Strength s : {Strength::kClear, Strength::kModerate, Strength::kBarely}) {
    if (sums[s].all == 0)
      text += " - |";
    else
      text += FormatText(" %.1f %% |", Percent(sums[s]));
  }
  text += "\n\n";
  text += FormatText("Truth inside the stated 95 %% interval: %s (%.1f %%); held-out gain above zero: %s; ",
                     Text(inside).c_str(), Percent(inside), Text(gained).c_str());
  text += FormatText("no second cause invented: %s.\n", Text(alone).c_str());
}

/// False alarms by plant and stated rate. Machines that keep silent at a rate are not asked at a stricter
/// one: they count as silent there.
void AddClean(std::string& text, const std::vector<Outcome>& outcomes) {
  std::map<Misfit, std::map<double, int>> alarms;
  std::map<Misfit, std::set<std::uint64_t>> machines;
  for (const Outcome& o : outcomes) {
    const Question& q = o.known.question;
    if (q.type != Question::Type::kClean || !o.known.usable) continue;
    alarms[q.misfit][o.false_alarm_rate] += !o.judged.right;
    machines[q.misfit].insert(q.seed);
  }
  if (alarms.empty()) return;
  text += "\n### Machines without an effect\n\n| plant | stated rate | false alarms | |\n|---|---|---|---|\n";
  for (const auto& [misfit, by_rate] : alarms)
    for (const auto& [rate, count] : by_rate) {
      const Count c{count, static_cast<int>(machines[misfit].size())};
      text += FormatText("| %s | %g %% | %s | %.1f %% |\n", Name(misfit), 100.0 * rate, Text(c).c_str(),
                         Percent(c));
    }
}

void AddOthers(std::string& text, const std::vector<Outcome>& outcomes) {
  Count both, detectable, unexplained, not_misnamed;
  for (const Outcome& o : outcomes) {
    if (!o.known.usable) continue;
    if (o.known.question.type == Question::Type::kPair) both.Take(o.judged.both);
    if (o.known.question.type == Question::Type::kDetectable) detectable.Take(o.judged.right);
    if (o.known.question.type == Question::Type::kEffect && IsOutside(o) &&
        o.known.question.strength == Strength::kClear) {
      unexplained.Take(o.verdict == diagnosis::Verdict::kUnexplained);
      not_misnamed.Take(!o.named);
    }
  }
  if (both.all + detectable.all + unexplained.all == 0) return;
  text += "\n### Others\n\n| question | right | |\n|---|---|---|\n";
  const auto row = [&](const char* what, const Count& c) {
    if (c.all > 0) text += FormatText("| %s | %s | %.1f %% |\n", what, Text(c).c_str(), Percent(c));
  };
  row("two clear effects: both found", both);
  row("effect of 1.5 times smallest_detectable: found", detectable);
  row("clear effect outside the catalogue: unexplained", unexplained);
  row("clear effect outside the catalogue: no wrong name", not_misnamed);
}

void AddTimes(std::string& text, const std::vector<Outcome>& outcomes) {
  double sum_s = 0.0, log_s = 0.0, longest = 0.0;
  int n = 0;
  int unusable = 0;
  for (const Outcome& o : outcomes) {
    unusable += !o.known.usable;
    if (!o.known.usable || o.log_s <= 0.0) continue;
    ++n;
    sum_s += o.diagnose_s;
    log_s += o.log_s;
    longest = std::max(longest, o.diagnose_s);
  }
  if (n == 0) return;
  text +=
      FormatText("\n%d logs of %.0f s on average; processor time of a diagnosis %.2f s per 100 s of log, ", n,
                 log_s / n, 100.0 * sum_s / log_s);
  text += FormatText(
      "longest %.2f s. %d cases drawn could not be used (the effect does not get that strong there, ",
      longest, unusable);
  text += "or the machine stops).\n";
}

void AddFailures(std::string& text, const std::vector<Outcome>& outcomes) {
  std::string list;
  for (const Outcome& o : outcomes) {
    if (!o.known.usable || Undecidable(o)) continue;
    const bool wrong = o.known.question.type == Question::Type::kPair ? !o.judged.both : !o.judged.right;
    if (!wrong && o.judged.extra == 0) continue;
    list += FormatText("| %s | %s | %s | %llu | %s | %s | %s |\n", Name(o.known.question.type),
                       KindsText(o.known.question).c_str(), Name(o.known.question.strength),
                       static_cast<unsigned long long>(o.known.question.seed), Name(o.known.question.misfit),
                       o.judged.answer.c_str(), wrong ? "wrong" : "invented a second");
  }
  if (list.empty()) return;
  text += "\n### Where it went wrong\n\n| type | hidden | strength | seed | plant | answer | |\n";
  text += "|---|---|---|---|---|---|---|\n" + list;
}

}  // namespace

bool Undecidable(const Outcome& o) {
  if (o.known.question.type != Question::Type::kEffect || o.known.hidden.empty()) return false;
  const diagnosis::Specimen* specimen = SpecimenOf(o.known.question.kinds.front());
  if (specimen == nullptr || specimen->undecidable == nullptr) return false;
  return (*specimen->undecidable)(DrawnOf(o.known.hidden.front()),
                                  o.known.question.strength == Strength::kBarely);
}

std::string ResultTable(const std::vector<Outcome>& outcomes, const std::string& command) {
  std::string text = "`" + command + "`\n";
  for (const Misfit m :
       {Misfit::kNone, Misfit::kMaxwellSlip, Misfit::kTimingError, Misfit::kNoiseLevel, Misfit::kDelayAndLag})
    AddKinds(text, outcomes, m);
  AddClean(text, outcomes);
  AddOthers(text, outcomes);
  AddTimes(text, outcomes);
  AddFailures(text, outcomes);
  return text;
}

}  // namespace contour::hidden
