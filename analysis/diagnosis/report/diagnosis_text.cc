#include "analysis/diagnosis/report/diagnosis_text.h"

#include <cmath>
#include <sstream>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/kind_words.h"
#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

constexpr std::size_t kWidth = 100;

/// Breaks a paragraph into lines; all but the first are indented further.
std::string Wrapped(const std::string& text, std::size_t indent) {
  std::istringstream words(text);
  std::string out(indent, ' ');
  std::size_t column = indent;
  bool first = true;
  for (std::string word; words >> word; first = false) {
    if (!first && column + 1 + word.size() > kWidth) {
      out += "\n" + std::string(indent + 2, ' ');
      column = indent + 2;
    } else if (!first) {
      out += ' ';
      ++column;
    }
    out += word;
    column += word.size();
  }
  return out + "\n";
}

std::string Percent(double share) { return RoundedText(100.0 * share) + " %"; }

/// A residual that grows is so much more, not less than less.
std::string Change(double gain) { return Percent(std::abs(gain)) + (gain < 0.0 ? " more" : " less"); }

/// The word once where both ends have the same sign.
std::string ChangeBetween(double low, double high) {
  const bool cross = low < 0.0 && high >= 0.0;
  return (cross ? Change(low) : Percent(std::abs(low))) + " to " + Change(high);
}

std::string Listed(const std::vector<std::string>& items, const char* last) {
  std::string out;
  for (std::size_t i = 0; i < items.size(); ++i)
    out += (i == 0 ? "" : i + 1 == items.size() ? std::string(" ") + last + " " : ", ") + items[i];
  return out;
}

std::string Sizes(const Cause& cause, ExtensionUnits units) {
  std::string out;
  for (const auto& [in_Nm, p] : cause.parameters) {
    const std::string name = RenamedToFile(units, in_Nm);
    out += (out.empty() ? "" : "; ") + ParameterWords(name) + " " + ValueWords(name, p.value) +
           " (95 %: " + ValueWords(name, p.low) + " to " + ValueWords(name, p.high) + ")";
  }
  return out;
}

std::string CauseText(const Cause& cause, std::size_t number, ExtensionUnits units) {
  std::string out = Wrapped(
      std::to_string(number) + ". " + (cause.part_of_it ? "Part of it: " : "") + KindWords(cause.kind), 0);
  if (!cause.parameters.empty()) out += Wrapped("Size: " + Sizes(cause, units) + ".", 3);
  out += Wrapped(
      "How sure: log evidence " + RoundedText(cause.log_evidence_gain) + " nats over the model without it.",
      3);
  if (cause.heldout_rms_before > 0.0)
    out += Wrapped("Gain on data that the fit has not seen: residual " +
                       RoundedText(cause.heldout_rms_before) + " to " + RoundedText(cause.heldout_rms_after) +
                       " " + cause.unit + ", " + Change(cause.heldout_gain) +
                       " (95 %: " + ChangeBetween(cause.heldout_gain_low, cause.heldout_gain_high) + ").",
                   3);
  if (!cause.indistinguishable_from.empty())
    out += Wrapped("This log cannot tell it from: " + Listed(cause.indistinguishable_from, "or") + ".", 3);
  if (!cause.deciding_experiment.empty())
    out += Wrapped("What would decide: " + cause.deciding_experiment, 3);
  out += Wrapped("Next: " + KindAdvice(cause.kind), 3);
  return out;
}

}  // namespace

ExtensionUnits UnitsIn(const Diagnosis& d) {
  return d.fitted && d.fitted->linear ? ExtensionUnits::kOfLinearAxis : ExtensionUnits::kOfScrew;
}

std::string VerdictText(const Diagnosis& d) {
  const std::string rate = Percent(d.false_alarm_rate);
  switch (d.verdict) {
    case Verdict::kCauseFound:
      return d.causes.size() == 1 ? "One cause was found."
                                  : std::to_string(d.causes.size()) + " causes were found.";
    case Verdict::kAmbiguous:
      return "Something was found, but this log cannot tell between several causes.";
    case Verdict::kNothingFound:
      return "Nothing was found: the model describes this log as well as its noise allows. (A log of a "
             "machine that "
             "is as stated raises an alarm in " +
             rate + " of all cases.)";
    case Verdict::kUnexplained:
      return "Something is missing from the model, and none of the " + std::to_string(AllCauses().size()) +
             " known causes fits it" +
             (d.causes.empty() ? "." : "; what is known of it stands below, as part of it.");
    case Verdict::kInsufficientData:
      break;
  }
  return "This log is not enough to tell.";
}

std::string DiagnosisText(const Diagnosis& d) {
  std::string out = Wrapped(VerdictText(d), 0);
  for (std::size_t i = 0; i < d.causes.size(); ++i) out += "\n" + CauseText(d.causes[i], i + 1, UnitsIn(d));
  if (d.bootstrap_runs > 0)
    out += "\n" + Wrapped("Intervals of the sizes: from " + std::to_string(d.bootstrap_runs) +
                              " refits with the residual of every stroke at random.",
                          0);
  const DataQuality& q = d.data_quality;
  out += "\n" +
         Wrapped("Data: " + std::to_string(q.rows) + " rows, " + std::to_string(q.missing) + " missing, " +
                     std::to_string(q.stale) + " stale, " + std::to_string(q.outliers) + " outliers.",
                 0);
  if (!d.not_excited.empty())
    out +=
        Wrapped("Not tested, because this log does not excite it: " + Listed(d.not_excited, "and") + ".", 0);
  for (const std::string& note : d.notes) out += Wrapped("Note: " + note, 0);
  return out;
}

}  // namespace contour::diagnosis
