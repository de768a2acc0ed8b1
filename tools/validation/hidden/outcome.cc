#include "tools/validation/hidden/outcome.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tools/validation/hidden/record_case.h"

namespace contour::hidden {
namespace {

constexpr const char* kHeader =
    "case,type,hidden,strength,seed,misfit,rate,usable,size,order,second,verdict,answer,right,both,itself,"
    "extra,"
    "inside,outside,gain,gate,diagnose_s,log_s";
constexpr std::array kVerdicts = {std::pair{diagnosis::Verdict::kCauseFound, "cause_found"},
                                  std::pair{diagnosis::Verdict::kAmbiguous, "ambiguous"},
                                  std::pair{diagnosis::Verdict::kNothingFound, "nothing_found"},
                                  std::pair{diagnosis::Verdict::kUnexplained, "unexplained"},
                                  std::pair{diagnosis::Verdict::kInsufficientData, "insufficient_data"}};

double ThreadTime_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::string WithoutCommas(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::vector<std::string> Split(const std::string& line, char at) {
  std::vector<std::string> fields;
  std::stringstream stream(line);
  for (std::string field; std::getline(stream, field, at);) fields.push_back(field);
  return fields;
}

template <class Enum, std::size_t n>
Enum FromName(const std::string& name, const std::array<Enum, n>& all) {
  for (const Enum one : all)
    if (name == Name(one)) return one;
  throw std::runtime_error("results.csv: there is no '" + name + "'");
}

Outcome FromFields(const std::vector<std::string>& f) {
  Outcome o;
  Question& q = o.known.question;
  q.type = FromName(f[1], std::array{Question::Type::kClean, Question::Type::kEffect, Question::Type::kPair,
                                     Question::Type::kDetectable});
  q.kinds = Split(f[2], '+');
  q.strength = FromName(f[3], std::array{Strength::kClear, Strength::kModerate, Strength::kBarely});
  q.seed = std::stoull(f[4]);
  q.misfit = FromName(f[5], std::array{Misfit::kNone, Misfit::kMaxwellSlip, Misfit::kTimingError,
                                       Misfit::kNoiseLevel, Misfit::kDelayAndLag});
  if (f[0].find("_short_") != std::string::npos) q.length = Length::kShort;
  o.false_alarm_rate = std::stod(f[6]);
  o.known.usable = f[7] == "1";
  if (!q.kinds.empty()) {
    Hidden h;
    h.kind = q.kinds.front();
    h.size = std::stod(f[8]);
    h.order = std::stod(f[9]);
    h.second = std::stod(f[10]);
    o.known.hidden.push_back(h);
  }
  for (const auto& [verdict, name] : kVerdicts)
    if (f[11] == name) o.verdict = verdict;
  o.judged.answer = f[12];
  o.judged.right = f[13] == "1";
  o.judged.both = f[14] == "1";
  o.judged.itself = f[15] == "1";
  o.judged.extra = std::stoi(f[16]);
  o.judged.inside = f[17] == "1";
  (o.known.usable ? o.judged.outside : o.known.why_not) = f[18];
  o.judged.gain = std::stod(f[19]);
  o.threshold = std::stod(f[20]);
  o.diagnose_s = std::stod(f[21]);
  o.log_s = std::stod(f[22]);
  o.named = o.verdict == diagnosis::Verdict::kCauseFound || o.verdict == diagnosis::Verdict::kAmbiguous;
  return o;
}

}  // namespace

Outcome AskCase(const std::filesystem::path& directory, const Diagnoser& diagnoser, double rate) {
  Outcome outcome;
  outcome.known = ReadTruth(directory);
  outcome.false_alarm_rate = rate;
  if (!outcome.known.usable) return outcome;
  const Recorded recorded = ReadRecorded(directory);
  outcome.log_s = static_cast<double>(recorded.log.size()) * recorded.log.period_s;
  const double begin_s = ThreadTime_s();
  const diagnosis::Diagnosis answer = diagnoser(recorded.log, recorded.stated, rate);
  outcome.diagnose_s = ThreadTime_s() - begin_s;
  outcome.judged = Judge(answer, outcome.known.hidden, outcome.known.question.misfit);
  outcome.verdict = answer.verdict;
  outcome.named = !answer.causes.empty();
  outcome.threshold = answer.threshold;
  return outcome;
}

void AppendCsv(const std::filesystem::path& file, const Outcome& o) {
  const bool fresh = !std::filesystem::exists(file);
  const Question& q = o.known.question;
  const Hidden h = o.known.hidden.empty() ? Hidden{} : o.known.hidden.front();
  std::string verdict;
  for (const auto& [value, name] : kVerdicts)
    if (value == o.verdict) verdict = name;
  std::ostringstream line;
  line << CaseName(q) << ',' << Name(q.type) << ',' << KindsText(q) << ',' << Name(q.strength) << ','
       << q.seed << ',' << Name(q.misfit) << ',' << o.false_alarm_rate << ',' << o.known.usable << ','
       << h.size << ',' << h.order << ',' << h.second << ',' << verdict << ',' << o.judged.answer << ','
       << o.judged.right << ',' << o.judged.both << ',' << o.judged.itself << ',' << o.judged.extra << ','
       << o.judged.inside << ',' << WithoutCommas(o.known.usable ? o.judged.outside : o.known.why_not) << ','
       << o.judged.gain << ',' << o.threshold << ',' << o.diagnose_s << ',' << o.log_s << '\n';
  std::ofstream out(file, std::ios::app);
  if (fresh) out << kHeader << '\n';
  out << line.str() << std::flush;
  if (!out) throw std::runtime_error("cannot write " + file.string());
}

void AppendSizes(const std::filesystem::path& file, const Outcome& o) {
  const bool fresh = !std::filesystem::exists(file);
  std::ofstream out(file, std::ios::app);
  if (fresh) out << "case,kind,evidence,parameter,truth,value,low,high,smallest_detectable\n";
  out.precision(9);
  for (const ToldSize& s : o.judged.sizes)
    out << CaseName(o.known.question) << ',' << o.known.hidden.front().kind << ',' << o.judged.evidence << ','
        << s.name << ',' << s.truth << ',' << s.told.value << ',' << s.told.low << ',' << s.told.high << ','
        << s.smallest << '\n';
  if (!out) throw std::runtime_error("cannot write " + file.string());
}

std::vector<Outcome> ReadCsv(const std::filesystem::path& file) {
  std::vector<Outcome> outcomes;
  std::ifstream in(file);
  std::string line;
  if (!std::getline(in, line)) return outcomes;
  if (line != kHeader) throw std::runtime_error(file.string() + ": its header is another one");
  const std::size_t columns = Split(line, ',').size();
  while (std::getline(in, line)) {
    const std::vector<std::string> fields = Split(line, ',');
    if (fields.size() != columns) throw std::runtime_error(file.string() + ": a line is cut short: " + line);
    try {
      outcomes.push_back(FromFields(fields));
    } catch (const std::logic_error&) {
      throw std::runtime_error(file.string() + ": not a number in: " + line);
    }
  }
  return outcomes;
}

}  // namespace contour::hidden
