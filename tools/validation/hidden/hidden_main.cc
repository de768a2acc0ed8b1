// contour_hidden: hides effects in the emulated machine and asks diagnosis what is wrong with it.

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <fstream>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "analysis/diagnosis/diagnose.h"
#include "analysis/parallel/parallel_for.h"
#include "analysis/prediction_error/keep_memory.h"
#include "analysis/text/format_text.h"
#include "core/exit_status.h"
#include "tools/validation/hidden/options.h"
#include "tools/validation/hidden/outcome.h"
#include "tools/validation/hidden/recorded_case.h"
#include "tools/validation/hidden/result_table.h"

namespace contour::hidden {
namespace {

using Path = std::filesystem::path;

/// Does work(i) for each i below `count` on so many threads, with progress on a terminal.
void OnThreads(unsigned threads, std::size_t count, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> finished{0};
  const bool terminal = isatty(2) != 0;
  ParallelFor(count, static_cast<int>(threads), [&](std::size_t i) {
    work(i);
    const std::size_t n = ++finished;
    if (terminal) std::fprintf(stderr, "\r%zu of %zu", n, count);
  });
  if (terminal) std::fprintf(stderr, "\n");
}

void PrintRecorded(const KnownCase& known) {
  std::printf("%-40s", CaseName(known.question).c_str());
  if (!known.usable) std::printf(" not usable: %s", known.why_not.c_str());
  for (const Hidden& h : known.hidden)
    for (const auto& [name, value] : h.truth) std::printf(" %s %.4g", name.c_str(), value);
  std::printf("\n");
  std::fflush(stdout);
}

void PrintJudged(const Outcome& o) {
  std::printf("%-40s", CaseName(o.known.question).c_str());
  if (!o.known.usable) {
    std::printf(" not usable: %s\n", o.known.why_not.c_str());
    return;
  }
  const bool pair = o.known.question.type == Question::Type::kPair;
  std::printf(" %s %s", (pair ? o.judged.both : o.judged.right) ? "right" : "WRONG", o.judged.answer.c_str());
  if (o.judged.itself) std::printf("  gain %.3f %s", o.judged.gain, o.judged.inside ? "inside" : "OUTSIDE ");
  std::printf("%s  gate %.1f  %.2f s for %.0f s\n", o.judged.outside.c_str(), o.threshold, o.diagnose_s,
              o.log_s);
  std::fflush(stdout);
}

/// Our own, which also writes what every kind scored where that is wanted.
Diagnoser Ours(const Options& o, const std::string& name) {
  return [&o, name](const diagnosis::AxisLog& log, const diagnosis::StatedAxis& stated, double rate) {
    diagnosis::DiagnoseOptions options;
    options.false_alarm_rate = rate;
    options.bootstrap_runs = o.bootstrap;
    options.fit_above_chance = o.fit_above_chance;
    std::string table;
    if (!o.evidence.empty())
      options.evidence = [&](const diagnosis::Evidence& e) {
        table += FormatText("%s,%zu,%g,%d,%.3f,%d,%s,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f\n", name.c_str(),
                            log.size(), rate, e.accepted, e.explained, e.in_base ? 1 : 0, e.kind.c_str(),
                            e.screened, e.penalty, e.overdispersion, e.refitted, e.tested, e.unseen, e.flips,
                            e.asked);
      };
    const diagnosis::Diagnosis answer = diagnosis::Diagnose(log, stated, options);
    if (!table.empty()) std::ofstream(o.evidence, std::ios::app) << table;
    return answer;
  };
}

void RecordAll(const Options& o) {
  std::vector<Question> left;
  for (const Question& q : Questions(o.plan))
    if (!IsRecorded(Path(o.record) / CaseName(q))) left.push_back(q);
  std::mutex mutex;
  OnThreads(o.threads, left.size(), [&](std::size_t i) {
    const Path directory = Path(o.record) / CaseName(left[i]);
    std::filesystem::create_directories(directory);
    const KnownCase known = RecordCase(left[i], directory, o.compact);
    const std::lock_guard lock(mutex);
    if (o.verbose) PrintRecorded(known);
  });
}

/// Names of the recorded cases that are to be judged.
std::vector<std::string> CasesIn(const Options& o) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(o.judge)) {
    const std::string name = entry.path().filename().string();
    const bool wanted = o.only.empty() || std::any_of(o.only.begin(), o.only.end(), [&](const auto& begin) {
                          return name.compare(0, begin.size(), begin) == 0;
                        });
    if (wanted && IsRecorded(entry.path())) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

class Judgement {
 public:
  Judgement(const Options& o, const Path& out) : options_(o), csv_(out / "results.csv") {
    std::filesystem::create_directories(out);
    outcomes_ = ReadCsv(csv_);
    for (const Outcome& one : outcomes_) done_.insert({CaseName(one.known.question), one.false_alarm_rate});
  }

  /// One case, unless it is done. Called on several threads.
  void Ask(const Path& directory) {
    if (!AskAt(directory, options_.rate) || options_.strict_rate <= 0.0) return;
    AskAt(directory, options_.strict_rate);
  }

  [[nodiscard]] const std::vector<Outcome>& outcomes() const { return outcomes_; }

 private:
  /// True when a clean machine raised an alarm.
  bool AskAt(const Path& directory, double rate) {
    const std::string name = directory.filename().string();
    {
      const std::lock_guard lock(mutex_);
      if (done_.count({name, rate}) > 0)
        return std::any_of(outcomes_.begin(), outcomes_.end(), [&](const Outcome& o) {
          return o.false_alarm_rate == rate && CaseName(o.known.question) == name && FalseAlarm(o);
        });
    }
    const Outcome outcome = AskCase(directory, Ours(options_, name), rate);
    const std::lock_guard lock(mutex_);
    outcomes_.push_back(outcome);
    AppendCsv(csv_, outcome);
    if (!options_.sizes.empty()) AppendSizes(options_.sizes, outcome);
    if (options_.verbose) PrintJudged(outcome);
    return FalseAlarm(outcome);
  }

  static bool FalseAlarm(const Outcome& o) {
    return o.known.usable && o.known.question.type == Question::Type::kClean && !o.judged.right;
  }

  const Options& options_;
  Path csv_;
  std::mutex mutex_;
  std::vector<Outcome> outcomes_;
  std::set<std::pair<std::string, double>> done_;
};

void PrintTable(const Judgement& judgement, const Path& out, int argc, char** argv) {
  std::string command = "contour_hidden";
  for (int i = 1; i < argc; ++i) command += std::string(" ") + argv[i];
  const std::string table = ResultTable(judgement.outcomes(), command);
  std::fputs(table.c_str(), stdout);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("\nLargest memory of this process: %ld MB.\n", usage.ru_maxrss / 1024);
  std::ofstream file(out / "results.md");
  file << table;
  if (!file) throw std::runtime_error("cannot write results.md");
}

void JudgeAll(const Options& o, int argc, char** argv) {
  const Path out = o.out.empty() ? o.judge : o.out;
  Judgement judgement(o, out);
  const std::vector<std::string> names = CasesIn(o);
  OnThreads(o.threads, names.size(), [&](std::size_t i) { judgement.Ask(Path(o.judge) / names[i]); });
  PrintTable(judgement, out, argc, argv);
}

/// Records and judges case by case.
void DoBoth(const Options& o, int argc, char** argv) {
  const Path temporary =
      std::filesystem::temp_directory_path() / ("contour_hidden." + std::to_string(getpid()));
  const Path root = o.keep.empty() ? temporary : Path(o.keep);
  const Path out = o.out.empty() ? temporary : Path(o.out);
  const std::vector<Question> questions = Questions(o.plan);
  Judgement judgement(o, out);
  OnThreads(o.threads, questions.size(), [&](std::size_t i) {
    const Path directory = root / CaseName(questions[i]);
    std::filesystem::create_directories(directory);
    if (!IsRecorded(directory)) RecordCase(questions[i], directory, false);
    judgement.Ask(directory);
    if (o.keep.empty()) std::filesystem::remove_all(directory);
  });
  PrintTable(judgement, out, argc, argv);
  std::filesystem::remove_all(temporary);
}

}  // namespace
}  // namespace contour::hidden

int main(int argc, char** argv) {
  contour::diagnosis::KeepMemory();
  using namespace contour::hidden;
  try {
    const Options options = ParseOptions(argc, argv);
    if (!options.record.empty()) {
      RecordAll(options);
    } else if (!options.judge.empty()) {
      JudgeAll(options, argc, argv);
    } else {
      DoBoth(options, argc, argv);
    }
    return contour::kExitDone;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "contour_hidden: %s\n", e.what());
    return contour::kExitFailed;
  }
}
