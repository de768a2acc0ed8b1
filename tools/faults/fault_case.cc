#include "tools/faults/fault_case.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "tools/plant_emulator/random.h"

namespace contour::faults {
namespace {

/// Three significant digits, so that a feed can be given again exactly.
double Rounded(double feed_mm_s) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", feed_mm_s);
  return std::strtod(text, nullptr);
}

std::uint64_t Fnv(std::string_view text) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL;
  return hash;
}

/// The names asked for, by what they are names of.
class Filter {
 public:
  Filter(const std::vector<std::string>& only, const std::vector<PlannedAxis>& axes) {
    for (const std::string& name : only) {
      bool known = false;
      for (const FaultName& f : kFaults)
        if (f.name == name) faults_.push_back(f.fault), known = true;
      for (const Phase p : kPhases)
        if (Name(p) == name) phases_.push_back(p), known = true;
      DriveMode mode;
      if (FromName(name, mode)) modes_.push_back(mode), known = true;
      for (const PlannedAxis& a : axes)
        if (a.name == name) axes_.push_back(name), known = true;
      if (!known)
        throw std::invalid_argument("--only: found '" + name + "', expected a fault, phase, mode or axis");
    }
  }
  template <class T>
  static bool Takes(const std::vector<T>& some, const T& one) {
    return some.empty() || std::find(some.begin(), some.end(), one) != some.end();
  }
  [[nodiscard]] bool Takes(Fault f, Phase p, DriveMode m) const {
    return Takes(faults_, f) && Takes(phases_, p) && Takes(modes_, m);
  }
  [[nodiscard]] bool Plans(Fault f) const { return IsPlanned(f) || !faults_.empty(); }
  [[nodiscard]] bool TakesAxis(const std::string& name) const { return Takes(axes_, name); }

 private:
  std::vector<Fault> faults_;
  std::vector<Phase> phases_;
  std::vector<DriveMode> modes_;
  std::vector<std::string> axes_;
};

struct Combination {
  Fault fault;
  Phase phase;
  DriveMode mode;
  std::size_t band;
};

}  // namespace

std::string Key(const FaultCase& c) {
  return std::string(Name(c.fault)) + "," + std::string(Name(c.phase)) + "," + std::string(Name(c.mode)) +
         "," + c.axis_name;
}

std::uint64_t SeedOf(const FaultCase& c, std::uint64_t campaign_seed) {
  char feed[32];
  std::snprintf(feed, sizeof feed, "%.3g", c.feed_mm_s);
  return Fnv(Key(c) + "," + feed) ^ (campaign_seed * 0x9E3779B97F4A7C15ULL);
}

std::size_t BandOf(double feed_mm_s, double highest_mm_s) {
  const double share = std::log(feed_mm_s / kLowestFeed_mm_s) / std::log(highest_mm_s / kLowestFeed_mm_s);
  const double band = std::floor(share * static_cast<double>(kFeedBands));
  return static_cast<std::size_t>(std::clamp(band, 0.0, static_cast<double>(kFeedBands - 1)));
}

std::vector<FaultCase> Plan(const PlanRequest& request, const std::vector<PlannedAxis>& axes) {
  const Filter filter(request.only, axes);
  std::vector<Combination> all;
  for (const FaultName& f : kFaults)
    for (const Phase p : kPhases)
      for (const DriveMode m : {DriveMode::kCst, DriveMode::kCsp})
        for (std::size_t band = 0; band < (Moves(p) ? kFeedBands : 1); ++band)
          if (filter.Plans(f.fault) && filter.Takes(f.fault, p, m)) all.push_back({f.fault, p, m, band});
  std::vector<std::size_t> candidates;
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (filter.TakesAxis(axes[a].name)) candidates.push_back(a);
  if (all.empty() || candidates.empty()) throw std::invalid_argument("--only: nothing is left");

  plant::Random random(request.seed, 7);
  const auto draw = [&](std::size_t n) {
    return std::min(n - 1, static_cast<std::size_t>(random.Uniform() * static_cast<double>(n)));
  };
  std::vector<FaultCase> cases;
  for (std::size_t i = 0; i < request.runs; ++i) {
    if (i % all.size() == 0)
      for (std::size_t k = all.size(); k > 1; --k) std::swap(all[k - 1], all[draw(k)]);
    const Combination& c = all[i % all.size()];
    FaultCase one;
    one.fault = c.fault;
    one.phase = c.phase;
    one.mode = c.mode;
    one.axis = candidates[draw(candidates.size())];
    one.axis_name = axes[one.axis].name;
    const double highest = axes[one.axis].velocity_mm_s;
    const double within = random.Uniform();
    const double share = Moves(c.phase) ? (static_cast<double>(c.band) + within) / kFeedBands : within;
    const double ratio = highest / kLowestFeed_mm_s;
    one.feed_mm_s = std::clamp(Rounded(kLowestFeed_mm_s * std::pow(ratio, share)), kLowestFeed_mm_s, highest);
    if (request.feed_mm_s > 0.0) one.feed_mm_s = Rounded(request.feed_mm_s);
    if (static_cast<int>(i % static_cast<std::size_t>(request.shards)) == request.shard) cases.push_back(one);
  }
  return cases;
}

}  // namespace contour::faults
