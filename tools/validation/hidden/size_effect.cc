#include "tools/validation/hidden/size_effect.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/validation/hidden/hide_effect.h"
#include "tools/validation/hidden/record_case.h"
#include "tools/validation/hidden/residual.h"
#include "tools/validation/hidden/specimens.h"

namespace contour::hidden {
namespace {

/// Odds of the share against the rest: the effect's variance over the noise's.
double Odds(double share) { return share / (1.0 - share); }

/// Below this the difference of two variances of a log is not worth much: what is weaker is reached by the
/// local power law.
constexpr double kSmallestShareMeasured = 0.1;
constexpr double kCloseEnough = 0.12;  ///< of the odds
constexpr int kTries = 7;

}  // namespace

std::optional<Hidden> SizeEffect(const Setting& setting, Hidden effect, Strength strength,
                                 const std::filesystem::path& directory) {
  if (const diagnosis::Specimen* specimen = SpecimenOf(effect.kind);
      specimen != nullptr && *specimen->sizes) {
    effect.size = std::copysign((**specimen->sizes)[static_cast<std::size_t>(strength)], effect.size);
    return effect;
  }
  const double clean = Relevant(ResidualsOf(Simulate(setting, {}, directory), setting), effect.kind);
  const double wanted = Odds(ShareOf(strength));
  const double measured = std::max(wanted, Odds(kSmallestShareMeasured));
  const double largest = LargestSize(effect);
  double exponent = 2.0;  // the variance grows with the square of most effects
  double low = 0.0, high = largest;
  double last_size = 0.0, last_odds = 0.0;
  for (int i = 0; i < kTries; ++i) {
    double odds = 1e6;
    try {
      const auto log = Simulate(setting, {effect}, directory);
      odds = Relevant(ResidualsOf(log, setting), effect.kind) / clean - 1.0;
    } catch (const std::runtime_error&) {
      // The machine did not survive it: too much.
    }
    const double size = std::abs(effect.size);
    (odds > measured ? high : low) = size;
    if (last_odds > 1e-3 && odds > 1e-3 && odds < 1e5 && std::abs(std::log(size / last_size)) > 0.05)
      exponent = std::clamp(std::log(odds / last_odds) / std::log(size / last_size), 1.0, 6.0);
    last_size = size;
    last_odds = odds < 1e5 ? odds : 0.0;
    if (std::abs(std::log(std::max(odds, 1e-9) / measured)) < kCloseEnough) {
      effect.size *= std::pow(wanted / odds, 1.0 / exponent);
      return effect;
    }
    if (odds < measured && size >= largest) return std::nullopt;
    double next = size * std::clamp(std::pow(measured / std::max(odds, 1e-3), 1.0 / exponent), 0.1, 10.0);
    if (next <= low || next >= high) next = low > 0.0 ? std::sqrt(low * high) : 0.3 * size;
    if (high == largest && next > largest) next = largest;
    effect.size = std::copysign(next, effect.size);
  }
  // As close as it comes, if that is close at all.
  if (last_odds > 0.5 * measured && last_odds < 2.0 * measured) {
    effect.size *= std::pow(wanted / last_odds, 1.0 / exponent);
    return effect;
  }
  return std::nullopt;
}

}  // namespace contour::hidden
