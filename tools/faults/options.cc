#include "tools/faults/options.h"

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <thread>

#include "core/exit_status.h"
#include "core/version.h"
#include "tools/faults/supervisor.h"

namespace contour::faults {
namespace {

constexpr const char* kUsage =
    R"(usage: contour_faults [OPTION]...
Breaks the emulated machine in every phase of its life, at many feeds and in both modes, in virtual time, and checks by the
emulator's truth that nothing goes further than `contour check` says, that the reason is right, that `reset` helps when the fault
is gone, and that nothing enables itself.

  --config FILE        machine to break (config/xy_emulated.yaml)
  --runs N             (3000)
  --seed N             (1)
  --mode MODE          cst or csp alone
  --only A,B,...       only these faults, phases, modes and axes, by their names
  --feed MM_S          only at this feed
  --shard I/N          every Nth run, from the Ith on (I from 0)
  --without NAME       switches one supervisor off: the campaign must then fail. Without --only and --feed it
                       runs the fault that shows what this supervisor is good for
  --supervisors        does that for each of them, with it and without it, and prints a table
  --threads N          (number of processors)
  --out DIR            table.md, table.csv, runs.csv and failures.txt go there
  --list               names the faults, phases and supervisors
  --verbose            one line for each run
  --help, --version

Ends with 0 when every invariant held, 1 when one did not, 2 for bad usage or configuration.
)";

[[noreturn]] void Wrong(const std::string& what) {
  std::fprintf(stderr, "contour_faults: %s (--help says more)\n", what.c_str());
  std::exit(kExitBadUsage);
}

std::vector<std::string> Split(const std::string& list) {
  std::vector<std::string> parts;
  std::stringstream stream(list);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

unsigned long long Number(const std::string& option, const std::string& text, unsigned long long least) {
  char* end = nullptr;
  const unsigned long long n = std::strtoull(text.c_str(), &end, 10);
  if (text.empty() || text[0] == '-' || *end != '\0' || n < least || n > 1'000'000'000ULL)
    Wrong(option + ": found '" + text + "', expected a number from " + std::to_string(least) + " on");
  return n;
}

double Feed(const std::string& text) {
  char* end = nullptr;
  const double feed = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(feed >= kLowestFeed_mm_s && feed < 1e5))
    Wrong("--feed: found '" + text + "', expected mm/s, at least 0.01");
  return feed;
}

void Shard(const std::string& text, PlanRequest& plan) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) Wrong("--shard: found '" + text + "', expected I/N");
  plan.shard = static_cast<int>(Number("--shard", text.substr(0, slash), 0));
  plan.shards = static_cast<int>(Number("--shard", text.substr(slash + 1), 1));
  if (plan.shard >= plan.shards) Wrong("--shard: found '" + text + "', expected I below N");
}

/// Options that take a value. False: there is no such option.
bool Take(const std::string& option, const std::string& value, Options& o) {
  if (option == "--config") {
    o.config = value;
  } else if (option == "--runs") {
    o.plan.runs = Number(option, value, 1);
  } else if (option == "--seed") {
    o.plan.seed = Number(option, value, 0);
  } else if (option == "--mode") {
    if (value != "cst" && value != "csp") Wrong("--mode: found '" + value + "', expected cst or csp");
    o.plan.only.push_back(value);
  } else if (option == "--only") {
    for (const std::string& name : Split(value)) o.plan.only.push_back(name);
  } else if (option == "--feed") {
    o.plan.feed_mm_s = Feed(value);
  } else if (option == "--shard") {
    Shard(value, o.plan);
  } else if (option == "--without") {
    if (FindSupervisor(value) == nullptr)
      Wrong("--without: found '" + value + "', expected a supervisor of --list");
    o.without = value;
  } else if (option == "--threads") {
    o.threads = static_cast<unsigned>(Number(option, value, 1));
  } else if (option == "--out") {
    o.out = value;
  } else {
    return false;
  }
  return true;
}

}  // namespace

Options ParseOptions(int argc, char** argv) {
  Options o;
  o.threads = std::max(1U, std::thread::hardware_concurrency());
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--help" || option == "-h") {
      std::fputs(kUsage, stdout);
      std::exit(kExitDone);
    } else if (option == "--version") {
      std::printf("contour_faults %s\n", CONTOUR_VERSION);
      std::exit(kExitDone);
    } else if (option == "--list") {
      o.list = true;
    } else if (option == "--supervisors") {
      o.supervisors = true;
    } else if (option == "--verbose") {
      o.verbose = true;
    } else if (i + 1 >= argc) {
      Wrong("'" + option + "': an option that is not known, or its value is missing");
    } else if (!Take(option, argv[++i], o)) {
      Wrong("'" + option + "': there is no such option");
    }
  }
  return o;
}

}  // namespace contour::faults
