#include "tools/validation/contest/contest_verdict.h"

#include <algorithm>
#include <limits>

namespace contour {
namespace {

// Differences below one count of the finest encoder here, 5 mm / 2^20, are none.
constexpr double kSame_um = 0.0048;
constexpr double kNearBest = 1.1;
constexpr double kTwice = 2.0;
constexpr double kFarAboveMedian = 10.0;
constexpr double kReached = 1.15;

std::vector<RivalCheck> CheckRivals(const std::vector<Heat>& heats, const std::vector<ExpectedPeak>& expected,
                                    const std::string& nominal) {
  std::vector<RivalCheck> checks;
  for (const ExpectedPeak& e : expected) {
    ControllerName controller{};
    FromName(e.controller, controller);
    std::vector<double> peaks;
    for (const Heat& h : heats) {
      const CellResult* result = h.Of(controller);
      if (h.program == e.program && h.machine == nominal && result != nullptr)
        peaks.push_back(result->peak_um);
    }
    if (peaks.empty()) continue;
    RivalCheck check{e, Median(peaks), Reached::kNo};
    if (check.peak_um <= kReached * e.peak_um) check.reached = Reached::kYes;
    if (check.peak_um * kReached < e.peak_um) check.reached = Reached::kBelow;
    checks.push_back(check);
  }
  return checks;
}

}  // namespace

const CellResult* Heat::Of(ControllerName controller) const {
  const auto at = std::find(controllers.begin(), controllers.end(), controller);
  return at == controllers.end() ? nullptr : &results[static_cast<std::size_t>(at - controllers.begin())];
}

std::vector<Heat> Heats(const std::vector<ContestCell>& cells, const std::vector<CellResult>& results) {
  std::vector<Heat> heats;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const ContestCell& c = cells[i];
    const bool same = !heats.empty() && heats.back().program == c.program_name &&
                      heats.back().machine == c.machine_name && heats.back().seed == c.seed;
    if (!same) heats.push_back({c.program_name, c.machine_name, c.seed, {}, {}});
    heats.back().controllers.push_back(c.controller);
    heats.back().results.push_back(results[i]);
  }
  return heats;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return values.size() % 2 != 0 ? *middle : 0.5 * (*std::max_element(values.begin(), middle) + *middle);
}

bool Unstable(const Heat& heat, ControllerName controller) {
  const CellResult* result = heat.Of(controller);
  if (result == nullptr) return false;
  if (result->failed() || Growing(*result)) return true;
  std::vector<double> others;
  for (std::size_t i = 0; i < heat.results.size(); ++i)
    if (heat.controllers[i] != controller) others.push_back(heat.results[i].peak_um);
  return !others.empty() && result->peak_um > kFarAboveMedian * Median(others);
}

Verdict Judge(const std::vector<Heat>& heats, const std::vector<ExpectedPeak>& expected,
              const std::string& nominal) {
  Verdict v;
  for (const Heat& heat : heats) {
    const CellResult* full = heat.Of(ControllerName::kFull);
    if (full == nullptr || heat.results.size() < 2) continue;
    ++v.heats;
    Loss loss{&heat, ControllerName::kFull, full->peak_um, std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < heat.results.size(); ++i) {
      if (heat.results[i].peak_um >= loss.best_um) continue;
      loss.best = heat.controllers[i];
      loss.best_um = heat.results[i].peak_um;
    }
    const bool near =
        !full->failed() && loss.full_um <= std::max(kNearBest * loss.best_um, loss.best_um + kSame_um);
    v.near_best += near ? 1 : 0;
    if (!near) v.losses.push_back(loss);
    if (full->failed() || loss.full_um > std::max(kTwice * loss.best_um, loss.best_um + kSame_um)) ++v.twice;
    if (!full->failed() && loss.full_um <= kNearBest * loss.best_um) ++v.strictly_near_best;
    if (full->failed() || loss.full_um > kTwice * loss.best_um) ++v.strictly_twice;
    if (Unstable(heat, ControllerName::kFull)) v.unstable.push_back(&heat);
  }
  std::stable_sort(v.losses.begin(), v.losses.end(),
                   [](const Loss& a, const Loss& b) { return a.ratio() > b.ratio(); });
  v.rivals = CheckRivals(heats, expected, nominal);
  return v;
}

}  // namespace contour
