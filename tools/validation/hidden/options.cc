#include "tools/validation/hidden/options.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <thread>

#include "core/exit_status.h"
#include "tools/validation/hidden/hide_effect.h"
#include "tools/validation/hidden/specimens.h"

namespace contour::hidden {
namespace {

constexpr const char* kUsage =
    R"(usage: contour_hidden [OPTION]...
Hides effects in the emulated machine, records logs over the bus, diagnoses them, and counts how often the answer is right.

  --record DIR         only record: a directory for each case, with the truth next to the log
  --judge DIR          only diagnose what is recorded there; goes on where an earlier run ended
  (neither)            both, and the logs are not kept

What to record (cases that are there already are not recorded again):
  --kinds A,B,...      effects to hide (all of the catalogue); "outside": those outside the catalogue
  --strengths A,...    of clear, moderate, barely (all)
  --seeds N            machines per kind and strength (4); 0: none
  --first-seed N       (1)
  --clean N            machines without any effect (0)
  --pairs N            machines with two clear effects (0)
  --detectable N       machines per kind with an effect of 1.5 times smallest_detectable (0)
  --misfit NAME        none, maxwell_slip, timing_30us, noise_level, delay_and_lag, all (none)
  --short              a program of half the length
  --compact            logs as tables, which take a tenth of the room

How to judge:
  --only A,B,...       only cases whose names begin so: clean, clear_cogging, ...
  --rate R             false-alarm rate (0.05)
  --strict-rate R      clean machines that raise an alarm are asked again at this rate
  --bootstrap N        refits with every stroke at random, for the intervals (0)
  --evidence FILE      what every kind scored in every log and round, appended to a table
  --fit-above-chance   candidates that exceed chance are fitted even below the model-error allowance (slower)
  --sizes FILE         true sizes and what is told of them, appended to a table

  --threads N          (number of processors)
  --out DIR            results.csv and results.md go there (with --judge: next to the cases)
  --keep DIR           without --record and --judge: keeps the cases there
  --verbose            one line for each case
  --help
)";

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

int Number(const std::string& option, const std::string& text) {
  char* end = nullptr;
  const long n = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || n < 0 || n > 1000000000)
    Wrong(option + ": found '" + text + "', expected a number");
  return static_cast<int>(n);
}

double Rate(const std::string& option, const std::string& text) {
  char* end = nullptr;
  const double rate = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(rate > 0.0 && rate < 1.0))
    Wrong(option + ": found '" + text + "', expected a number between 0 and 1");
  return rate;
}

std::vector<std::string> KindsOf(const std::string& list) {
  std::vector<std::string> kinds;
  const std::vector<std::string> all = CatalogueKinds();
  const auto& outside = OutsideKinds();
  for (const std::string& k : Split(list)) {
    if (k == "outside") {
      kinds.insert(kinds.end(), outside.begin(), outside.end());
      continue;
    }
    if (std::find(all.begin(), all.end(), k) == all.end() &&
        std::find(outside.begin(), outside.end(), k) == outside.end())
      Wrong("--kinds: there is no kind '" + k + "'");
    kinds.push_back(k);
  }
  return kinds;
}

std::vector<Strength> StrengthsOf(const std::string& list) {
  std::vector<Strength> strengths;
  for (const std::string& s : Split(list)) {
    const std::size_t before = strengths.size();
    for (const Strength one : {Strength::kClear, Strength::kModerate, Strength::kBarely})
      if (s == Name(one)) strengths.push_back(one);
    if (strengths.size() == before) Wrong("--strengths: found '" + s + "', expected clear, moderate, barely");
  }
  return strengths;
}

std::vector<Misfit> MisfitsOf(const std::string& name) {
  const std::vector<Misfit> misfits = {Misfit::kMaxwellSlip, Misfit::kTimingError, Misfit::kNoiseLevel,
                                       Misfit::kDelayAndLag};
  if (name == "all") return misfits;
  if (name == Name(Misfit::kNone)) return {Misfit::kNone};
  for (const Misfit m : misfits)
    if (name == Name(m)) return {m};
  Wrong("--misfit: found '" + name + "'");
}

/// Options that take a value. False: there is no such option.
bool Take(const std::string& option, const std::string& value, Options& o) {
  Plan& plan = o.plan;
  int Plan::*const counts[] = {&Plan::seeds, &Plan::clean, &Plan::pairs, &Plan::detectable};
  const char* const count_names[] = {"--seeds", "--clean", "--pairs", "--detectable"};
  for (std::size_t i = 0; i < std::size(counts); ++i)
    if (option == count_names[i]) {
      plan.*counts[i] = Number(option, value);
      return true;
    }
  std::string Options::*const texts[] = {&Options::record, &Options::judge,    &Options::keep,
                                         &Options::out,    &Options::evidence, &Options::sizes};
  const char* const text_names[] = {"--record", "--judge", "--keep", "--out", "--evidence", "--sizes"};
  for (std::size_t i = 0; i < std::size(texts); ++i)
    if (option == text_names[i]) {
      o.*texts[i] = value;
      return true;
    }
  if (option == "--kinds") {
    plan.kinds = KindsOf(value);
  } else if (option == "--strengths") {
    plan.strengths = StrengthsOf(value);
  } else if (option == "--first-seed") {
    plan.first_seed = static_cast<std::uint64_t>(Number(option, value));
  } else if (option == "--misfit") {
    plan.misfits = MisfitsOf(value);
  } else if (option == "--only") {
    o.only = Split(value);
  } else if (option == "--rate") {
    o.rate = Rate(option, value);
  } else if (option == "--strict-rate") {
    o.strict_rate = Rate(option, value);
  } else if (option == "--bootstrap") {
    o.bootstrap = Number(option, value);
  } else if (option == "--threads") {
    o.threads = static_cast<unsigned>(std::max(1, Number(option, value)));
  } else {
    return false;
  }
  return true;
}

}  // namespace

Options ParseOptions(int argc, char** argv) {
  Options o;
  o.plan.kinds = CatalogueKinds();
  o.threads = std::max(1U, std::thread::hardware_concurrency());
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--help") {
      std::fputs(kUsage, stdout);
      std::exit(0);
    } else if (option == "--verbose") {
      o.verbose = true;
    } else if (option == "--fit-above-chance") {
      o.fit_above_chance = true;
    } else if (option == "--compact") {
      o.compact = true;
    } else if (option == "--short") {
      o.plan.length = Length::kShort;
    } else if (i + 1 >= argc) {
      Wrong(option + ": unknown, or its value is missing");
    } else if (!Take(option, argv[++i], o)) {
      Wrong("unknown option " + option);
    }
  }
  if (!o.record.empty() && !o.judge.empty()) Wrong("--record and --judge: one of them");
  if (o.strict_rate >= o.rate) Wrong("--strict-rate: must be smaller than --rate");
  return o;
}

}  // namespace contour::hidden
