#include "tools/hidden/run_case.h"

#include <ctime>
#include <stdexcept>

#include "tools/diagnosis/diagnose.h"
#include "tools/hidden/draw_setting.h"
#include "tools/hidden/hide_effect.h"
#include "tools/hidden/record_case.h"
#include "tools/hidden/size_effect.h"

namespace contour::hidden {
namespace {

double ThreadTime_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Of a kind's parameters the one that stands for its size, in the units of Hidden::size.
bool SizeFrom(const std::map<std::string, double>& smallest, double factor, const Setting& setting,
              Hidden& hidden) {
  const auto truth = TruthOf(hidden, setting);
  for (const auto& [name, value] : smallest) {
    if (truth.count(name) == 0 || name == "order_per_rev" || name == "frequency_Hz" || name == "vs_rad_s")
      continue;
    if (hidden.kind == "compliance") {
      hidden.size = factor / value;  // softer is larger
    } else if (hidden.kind == "torque_constant") {
      // Stated as a change of the ratio, or as the ratio itself.
      const double change = value > 0.5 ? value - 1.0 : value;
      hidden.size = (hidden.size < 0.0 ? -factor : factor) * std::abs(change);
    } else if (hidden.kind == "stribeck") {
      hidden.size = factor * (value > 1.0 ? value - 1.0 : value);
    } else {
      hidden.size = (hidden.size < 0.0 ? -factor : factor) * std::abs(value);
    }
    return std::abs(hidden.size) > 0.0;
  }
  return false;
}

constexpr double kBeyondDetectable = 1.5;

}  // namespace

const char* Name(Question::Type type) {
  switch (type) {
    case Question::Type::kClean:
      return "clean";
    case Question::Type::kEffect:
      return "effect";
    case Question::Type::kPair:
      return "pair";
    case Question::Type::kDetectable:
      break;
  }
  return "detectable";
}

diagnosis::Diagnosis OurDiagnoser(const diagnosis::AxisLog& log, const diagnosis::StatedAxis& stated,
                                  const Question& question) {
  diagnosis::DiagnoseOptions options;
  options.false_alarm_rate = question.false_alarm_rate;
  options.bootstrap_runs = question.bootstrap_runs;
  return diagnosis::Diagnose(log, stated, options);
}

Exam MakeExam(const Question& q, const std::filesystem::path& directory) {
  Exam exam;
  exam.question = q;
  std::string needs = q.kinds.empty() ? std::string() : q.kinds.front();
  exam.setting = DrawSetting(q.seed, needs, q.misfit);
  // The strength is that on a machine without misfit.
  Setting plain = exam.setting;
  plain.misfit = Misfit::kNone;
  plain.truth.lag_ms = q.misfit == Misfit::kDelayAndLag ? plain.stated.lag_ms : plain.truth.lag_ms;
  for (std::size_t i = 0; i < q.kinds.size(); ++i) {
    Hidden hidden = DrawEffect(q.seed + i, q.kinds[i], exam.setting);
    if (q.type == Question::Type::kDetectable) {
      const Recorded clean = Record(exam.setting, {}, directory);
      const diagnosis::Diagnosis answer = OurDiagnoser(clean.log, clean.stated, q);
      const auto at = answer.smallest_detectable.find(hidden.kind);
      if (at == answer.smallest_detectable.end() ||
          !SizeFrom(at->second, kBeyondDetectable, exam.setting, hidden))
        throw std::runtime_error("no smallest_detectable is stated");
      if (std::abs(hidden.size) > LargestSize(hidden, exam.setting))
        throw std::runtime_error("smallest_detectable is beyond all reason");
    } else {
      const auto sized = SizeEffect(plain, hidden, q.strength, directory);
      if (!sized) throw std::runtime_error("the effect does not get that strong on this machine");
      hidden = *sized;
    }
    exam.hidden.push_back(hidden);
  }
  exam.recorded = Record(exam.setting, exam.hidden, directory);
  return exam;
}

Outcome Ask(const Question& question, const Diagnoser& diagnoser, const std::filesystem::path& directory) {
  Outcome outcome;
  outcome.question = question;
  try {
    const Exam exam = MakeExam(question, directory);
    outcome.hidden = exam.hidden;
    outcome.log_s = static_cast<double>(exam.recorded.log.size()) * exam.recorded.log.period_s;
    const double begin_s = ThreadTime_s();
    outcome.answer = diagnoser(exam.recorded.log, exam.recorded.stated, question);
    outcome.diagnose_s = ThreadTime_s() - begin_s;
    outcome.judged = Judge(outcome.answer, exam.hidden, exam.setting);
    outcome.both = exam.hidden.size() == 2 && BothFound(outcome.answer, exam.hidden);
    outcome.answer.traces = {};
    outcome.usable = true;
  } catch (const std::runtime_error& e) {
    outcome.why_not = e.what();
  }
  return outcome;
}

}  // namespace contour::hidden
