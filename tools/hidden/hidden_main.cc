// contour_hidden: hides effects in the emulated machine and asks diagnosis what is wrong with it.

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "core/exit_status.h"
#include "tools/hidden/hide_effect.h"
#include "tools/hidden/result_table.h"
#include "tools/hidden/run_case.h"

namespace contour::hidden {
namespace {

constexpr const char* kUsage =
    R"(usage: contour_hidden [OPTION]...
Hides effects in the emulated machine, records logs over the bus, diagnoses them, and counts how often the answer is right.

  --kinds A,B,...      effects to hide (all of the catalogue); "outside": those outside the catalogue
  --strengths A,...    of clear, moderate, barely (all)
  --seeds N            machines per kind and strength (4); 0: none
  --first-seed N       (1)
  --clean N            machines without any effect (0)
  --pairs N            machines with two clear effects (0)
  --detectable N       machines per kind with an effect of 1.5 times smallest_detectable (0)
  --misfit NAME        none, maxwell_slip, timing_30us, noise_level, delay_and_lag, all (none)
  --rate R             false-alarm rate (0.05)
  --bootstrap N        logs simulated to calibrate the gate (0)
  --threads N          (number of processors)
  --out DIR            results.csv and results.md go there
  --verbose            one line for each case, and its candidates
  --keep DIR           keeps the files of the last case there: log.lcm, machine.yaml, model.yaml
  --help
)";

struct Options {
  std::vector<std::string> kinds;
  std::vector<Strength> strengths = {Strength::kClear, Strength::kModerate, Strength::kBarely};
  int seeds = 4, clean = 0, pairs = 0, detectable = 0, bootstrap = 0;
  std::uint64_t first_seed = 1;
  std::vector<Misfit> misfits = {Misfit::kNone};
  double rate = 0.05;
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  std::string out, keep;
  bool verbose = false;
};

[[noreturn]] void Wrong(const std::string& what) {
  std::fprintf(stderr, "contour_hidden: %s (--help says more)\n", what.c_str());
  std::exit(kExitBadUsage);
}

std::vector<std::string> Split(const std::string& list) {
  std::vector<std::string> parts;
  std::stringstream stream(list);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

long Number(const std::string& option, const std::string& text) {
  char* end = nullptr;
  const long n = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || n < 0) Wrong(option + ": found '" + text + "', expected a number");
  return n;
}

std::vector<std::string> Kinds(const std::string& list) {
  std::vector<std::string> kinds;
  for (const std::string& k : Split(list)) {
    if (k == "outside") {
      kinds.insert(kinds.end(), OutsideKinds().begin(), OutsideKinds().end());
      continue;
    }
    const auto& all = diagnosis::kKinds;
    const auto& outside = OutsideKinds();
    if (std::find(all.begin(), all.end(), k) == all.end() &&
        std::find(outside.begin(), outside.end(), k) == outside.end())
      Wrong("--kinds: there is no kind '" + k + "'");
    kinds.push_back(k);
  }
  return kinds;
}

std::vector<Strength> Strengths(const std::string& list) {
  std::vector<Strength> strengths;
  for (const std::string& s : Split(list)) {
    bool found = false;
    for (const Strength one : {Strength::kClear, Strength::kModerate, Strength::kBarely})
      if (s == Name(one)) {
        strengths.push_back(one);
        found = true;
      }
    if (!found) Wrong("--strengths: found '" + s + "', expected clear, moderate, barely");
  }
  return strengths;
}

std::vector<Misfit> Misfits(const std::string& name) {
  const std::vector<Misfit> wrong = {Misfit::kMaxwellSlip, Misfit::kTimingError, Misfit::kNoiseLevel,
                                     Misfit::kDelayAndLag};
  if (name == "all") return wrong;
  if (name == Name(Misfit::kNone)) return {Misfit::kNone};
  for (const Misfit m : wrong)
    if (name == Name(m)) return {m};
  Wrong("--misfit: found '" + name + "'");
}

Options Parse(int argc, char** argv) {
  Options o;
  o.kinds.assign(diagnosis::kKinds.begin(), diagnosis::kKinds.end());
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--help") {
      std::fputs(kUsage, stdout);
      std::exit(0);
    }
    if (option == "--verbose") {
      o.verbose = true;
      continue;
    }
    if (i + 1 >= argc) Wrong(option + ": unknown, or its value is missing");
    const std::string value = argv[++i];
    if (option == "--kinds") {
      o.kinds = Kinds(value);
    } else if (option == "--strengths") {
      o.strengths = Strengths(value);
    } else if (option == "--seeds") {
      o.seeds = static_cast<int>(Number(option, value));
    } else if (option == "--first-seed") {
      o.first_seed = static_cast<std::uint64_t>(Number(option, value));
    } else if (option == "--clean") {
      o.clean = static_cast<int>(Number(option, value));
    } else if (option == "--pairs") {
      o.pairs = static_cast<int>(Number(option, value));
    } else if (option == "--detectable") {
      o.detectable = static_cast<int>(Number(option, value));
    } else if (option == "--bootstrap") {
      o.bootstrap = static_cast<int>(Number(option, value));
    } else if (option == "--threads") {
      o.threads = std::max(1U, static_cast<unsigned>(Number(option, value)));
    } else if (option == "--misfit") {
      o.misfits = Misfits(value);
    } else if (option == "--rate") {
      o.rate = std::strtod(value.c_str(), nullptr);
      if (!(o.rate > 0.0 && o.rate < 1.0)) Wrong("--rate: expected a number between 0 and 1");
    } else if (option == "--out") {
      o.out = value;
    } else if (option == "--keep") {
      o.keep = value;
    } else {
      Wrong("unknown option " + option);
    }
  }
  return o;
}

std::vector<Question> Questions(const Options& o) {
  std::vector<Question> questions;
  const auto add = [&](Question::Type type, std::vector<std::string> kinds, Strength strength, Misfit misfit,
                       int index) {
    questions.push_back({type, std::move(kinds), strength, o.first_seed + static_cast<std::uint64_t>(index),
                         misfit, o.rate, o.bootstrap});
  };
  // Round by round, so that a run that is broken off has seen something of everything.
  for (const Misfit misfit : o.misfits) {
    for (int i = 0; i < o.seeds; ++i)
      for (const std::string& kind : o.kinds)
        for (const Strength s : o.strengths) add(Question::Type::kEffect, {kind}, s, misfit, i);
    for (int i = 0; i < o.detectable; ++i)
      for (const std::string& kind : o.kinds)
        add(Question::Type::kDetectable, {kind}, Strength::kClear, misfit, i);
    for (int i = 0; i < o.clean; ++i) add(Question::Type::kClean, {}, Strength::kClear, misfit, i);
  }
  for (int i = 0; i < o.pairs; ++i) {
    const auto n = static_cast<int>(o.kinds.size());
    const std::string& a = o.kinds[static_cast<std::size_t>((7 * i + 3) % n)];
    const std::string& b = o.kinds[static_cast<std::size_t>((11 * i + 9) % n)];
    if (a != b) add(Question::Type::kPair, {a, b}, Strength::kClear, Misfit::kNone, i);
  }
  return questions;
}

void PrintCase(const Outcome& o) {
  std::string kinds;
  for (const std::string& k : o.question.kinds) kinds += (kinds.empty() ? "" : "+") + k;
  std::printf("%-9s %-28s %-9s seed %llu %-12s", Name(o.question.type), kinds.c_str(),
              Name(o.question.strength), static_cast<unsigned long long>(o.question.seed),
              Name(o.question.misfit));
  if (!o.usable) {
    std::printf(" not usable: %s\n", o.why_not.c_str());
    return;
  }
  std::printf(" %s  answer %s", o.judged.right ? "RIGHT" : "WRONG", o.judged.answer.c_str());
  for (const Hidden& h : o.hidden) std::printf("  size %.4g order %.4g", h.size, h.order);
  if (o.judged.right && !o.hidden.empty())
    std::printf("  gain %.3f %s%s", o.judged.gain, o.judged.inside ? "inside" : "OUTSIDE ",
                o.judged.outside.c_str());
  std::printf("  gate %.1f  %.2f s for %.0f s\n", o.answer.gate, o.diagnose_s, o.log_s);
  for (const auto& c : o.answer.candidates)
    if (c.score > 0.3 * o.answer.gate || c.accepted)
      std::printf("    %-22s score %10.1f refitted %10.1f%s\n", c.kind.c_str(), c.score, c.refitted,
                  c.accepted ? "  accepted" : "");
  std::fflush(stdout);
}

int Main(int argc, char** argv) {
  const Options options = Parse(argc, argv);
  const std::vector<Question> questions = Questions(options);
  std::vector<Outcome> outcomes(questions.size());
  std::vector<std::uint8_t> done(questions.size(), 0);
  std::atomic<std::size_t> next{0};
  std::size_t finished = 0;
  std::mutex mutex;
  const bool terminal = isatty(2) != 0;
  const std::filesystem::path root = options.keep.empty() ? std::filesystem::temp_directory_path() /
                                                                ("contour_hidden." + std::to_string(getpid()))
                                                          : std::filesystem::path(options.keep);
  if (!options.out.empty()) std::filesystem::create_directories(options.out);
  const auto work = [&](unsigned number) {
    const std::filesystem::path directory = options.keep.empty() ? root / std::to_string(number) : root;
    std::filesystem::create_directories(directory);
    for (std::size_t i = next++; i < questions.size(); i = next++) {
      Outcome outcome = Ask(questions[i], OurDiagnoser, directory);
      const std::lock_guard lock(mutex);
      outcomes[i] = std::move(outcome);
      done[i] = 1;
      ++finished;
      if (options.verbose) PrintCase(outcomes[i]);
      if (terminal) std::fprintf(stderr, "\r%zu of %zu", finished, questions.size());
      if (!options.out.empty()) AppendCsv(std::filesystem::path(options.out) / "results.csv", outcomes[i]);
    }
  };
  std::vector<std::thread> threads;
  const unsigned count = options.keep.empty() ? options.threads : 1;
  for (unsigned t = 0; t < count; ++t) threads.emplace_back(work, t);
  for (std::thread& t : threads) t.join();
  if (terminal) std::fprintf(stderr, "\n");
  if (options.keep.empty()) std::filesystem::remove_all(root);
  std::string command = "contour_hidden";
  for (int i = 1; i < argc; ++i) command += std::string(" ") + argv[i];
  const std::string table = ResultTable(outcomes, command);
  std::fputs(table.c_str(), stdout);
  if (!options.out.empty()) {
    std::ofstream file(std::filesystem::path(options.out) / "results.md");
    file << table;
    if (!file) throw std::runtime_error("cannot write results.md");
  }
  return kExitDone;
}

}  // namespace
}  // namespace contour::hidden

int main(int argc, char** argv) {
  try {
    return contour::hidden::Main(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "contour_hidden: %s\n", e.what());
    return contour::kExitFailed;
  }
}
